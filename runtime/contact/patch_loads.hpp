#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/hertz.hpp"

namespace railtab {

/// What carries the normal load of one patch.
struct PatchLoad {
  HertzContact hertz{};
  double elastic_force = 0.0;  ///< normal force without damping [N]
  /// Where the force acts and creepage is taken: the pair at the centre of the overlap, which is the deepest pair where
  /// curvatures are constant. Its penetration is the depth there.
  ContactPatch contact{};
};
/// The loads of the patches of one wheel, in their order; as ContactPatches, without heap allocation and without zeros
/// where there is no patch.
class PatchLoads {
 public:
  PatchLoads() noexcept : PatchLoads(0) {}
  explicit PatchLoads(int count) noexcept : count_(count) {}
  PatchLoads(const PatchLoads& other) noexcept : count_(other.count_) {
    std::copy_n(other.begin(), count_, load_.begin());
  }
  PatchLoads& operator=(const PatchLoads& other) noexcept {
    if (this != &other) std::copy_n(other.begin(), other.count_, load_.begin());
    count_ = other.count_;
    return *this;
  }
  ~PatchLoads() = default;

  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(count_); }
  [[nodiscard]] PatchLoad& operator[](std::size_t i) noexcept { return load_[i]; }
  [[nodiscard]] const PatchLoad& operator[](std::size_t i) const noexcept { return load_[i]; }
  [[nodiscard]] PatchLoad* begin() noexcept { return load_.data(); }
  [[nodiscard]] PatchLoad* end() noexcept { return load_.data() + count_; }
  [[nodiscard]] const PatchLoad* begin() const noexcept { return load_.data(); }
  [[nodiscard]] const PatchLoad* end() const noexcept { return load_.data() + count_; }

 private:
  union {
    std::array<PatchLoad, ContactPatches::capacity> load_;  ///< the first `count_`; the others are not initialised
  };
  int count_;
};

/// Parameters of the normal contact.
struct NormalContactModel {
  ElasticMaterial material;
  double curvature_floor = 0.05;  ///< smallest B of the Hertz ellipse [1/m]; 1e-6 in the published method
};

/// Normal forces of the patches of one (right) wheel at a pose, F_n = K_h d^{3/2} (Eq. 11) made continuous in the pose:
///
/// * The ellipse follows the true overlap of the undeformed profiles, not the curvatures at the point: B is that of the
///   parabola which has the overlap's area between the deepest point and (1 - kappa) d, kappa = 0.7,
///   B = kappa d/w², w = (3/4) area/(kappa d). For constant curvatures that is (1/R_wy + 1/R_ry)/2.
/// * The force acts at the centre of that area, along the normal there.
/// * Two neighbouring patches whose interpenetrations have merged share what lies below the saddle between them:
///   F_i = K_i (d_i^{3/2} - w_i d_s^{3/2}), d_s the penetration at the saddle,
///   w_i = (d_j - d_s)/((d_i - d_s) + (d_j - d_s)). Separate patches (d_s <= 0) carry their full Hertz force; a patch
///   that ends in the saddle does so without load.
///
/// In the published method curvatures are those at the point, and patches are independent.
[[nodiscard]] PatchLoads patch_loads(const NormalContactModel& model, const ContactGeometry& geometry,
                                     const WheelsetPose& pose, const ContactPatches& patches) noexcept;

}  // namespace railtab
