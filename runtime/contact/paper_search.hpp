#pragma once

#include <vector>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// What Eq. 9 takes the least distance of a rail point to.
enum class PaperDistance {
  points,   ///< the wheel's points, as printed
  outline,  ///< the lines between them too: the pair moves with the wheel instead of jumping from point to point
};

/// The contact search of Montenegro & Calcada (2023), kept as a reference to compare with: wheel split into tread and
/// flange at the point of maximum curvature, convex search (Eqs. 1-4) accepted where the wheel's own curvature is
/// convex (Eq. 2), otherwise the overlap of n discretised points per profile (Eqs. 5-10). At most two patches.
///
/// Where the paper is silent: a straight wheel counts as convex, for its pair is unique; the convex search starts at
/// the point of least vertical gap, and a zone whose least gap stands at the split has no contact of its own. Yaw
/// enters through the silhouette, as in ContactSearch.
class PaperSearch {
 public:
  static constexpr int most_points = 4096;

  /// @param points n per profile, at uniform arc length. @throws InputError where not in [10, most_points]
  explicit PaperSearch(WheelRailPair pair, int points = 1000, PaperDistance distance = PaperDistance::points);
  [[nodiscard]] const WheelRailPair& pair() const noexcept { return pair_; }

  /// Patches with positive penetration. Between points, d of a discretised pair (Eq. 10) exceeds the common-normal
  /// distance by up to their spacing and does not fall below half of it, however little the bodies overlap; to the
  /// outline it is off by the lines' sag, spacing² times curvature over 8, and continuous in the pose. Const,
  /// allocation-free, thread-safe.
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const noexcept;

  /// Arc length on the wheel at which flange (before) and tread (behind) are split [m].
  [[nodiscard]] double split() const noexcept { return wheel_[split_].s; }

 private:
  struct WheelSample {
    double s, axial, radius, slope;
  };
  struct RailSample {
    double s, y, z;
  };
  struct Outline;
  struct OverlapPoints;
  struct WheelPair {
    double s, distance2;  // arc length on the wheel, squared distance to the rail point
  };
  struct Zone {
    int first, last;
  };

  void place(const WheelsetPose& pose, const PoseTrigonometry& trig, Outline& outline) const noexcept;
  void add_contact(const WheelsetPose& pose, const PoseTrigonometry& trig, const Outline& wheel, Zone zone,
                   ContactPatches& patches) const noexcept;
  void add_overlap(const WheelsetPose& pose, const PoseTrigonometry& trig, const Outline& wheel, Zone zone,
                   ContactPatches& patches) const noexcept;

  [[nodiscard]] WheelPair nearest_point(const OverlapPoints& points, const RailSample& rail) const noexcept;
  [[nodiscard]] WheelPair nearest_on_outline(const Outline& wheel, Zone zone, std::size_t w,
                                             const RailSample& rail) const noexcept;

  WheelRailPair pair_;
  PaperDistance distance_;
  std::vector<WheelSample> wheel_;  // in increasing y
  std::vector<RailSample> rail_;    // in increasing y
  std::size_t split_ = 0;           // index in wheel_, the last point of the flange
};

}  // namespace railtab
