#pragma once

#include <array>
#include <limits>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// A box over (lateral = y - R0·roll [m], yaw² [rad²], roll [rad]); low = high on a fixed axis.
struct CellBox {
  std::array<double, 3> low{}, high{};

  [[nodiscard]] bool fixed(std::size_t axis) const noexcept { return low[axis] == high[axis]; }
  /// The point at fractions -1..1 of the box.
  [[nodiscard]] double at(std::size_t axis, double local) const noexcept {
    return 0.5 * (low[axis] + high[axis]) + 0.5 * local * (high[axis] - low[axis]);
  }
};

/// The result of the online search at one point of a box.
struct BoxSample {
  std::array<double, 3> local{};  ///< -1..1, 0 on a fixed axis
  std::array<int, 3> grid{};      ///< place among the samples along each axis
  WheelsetPose pose;              ///< z: of first touch; NaN where the wheel does not meet the rail
  TouchPoints touches;            ///< up to some height above first touch, in increasing s_wheel
  ContactPatches lowered;         ///< patches at the largest lowering
  std::array<int, TouchPoints::capacity> component{};  ///< branch of each touch
};

/// A point of a branch: a wheel that touches at (lateral, yaw², roll), in local coordinates; lateral may be outside
/// -1..1, for a wheel lowered at a point of the box touches at a point beside it.
struct BranchDatum {
  std::array<double, 3> local{};
  double z = 0, s_wheel = 0, s_rail = 0;
  double normal_product = 0;  ///< n_y n_z
};

/// Minima that continue each other over the samples of a box.
struct SampledBranch {
  std::vector<BranchDatum> data;
  std::vector<bool> at_sample;  ///< exists for a touching wheel at that sample
  double least_height = 0;      ///< above first touch, at any sample [m]
};

/// The online search on a grid of points of the closed box (5 along lateral, 3 along the others), corners included.
class BoxSamples {
 public:
  /// @param lowering largest lowering below first touch that queries will have [m]
  BoxSamples(const ContactSearch& search, const CellBox& box, double lowering);

  [[nodiscard]] const std::vector<BoxSample>& samples() const noexcept { return samples_; }
  /// Those that can touch at up to the largest lowering, from the inner to the outer one; the lowest where they are
  /// more than a leaf holds.
  [[nodiscard]] const std::vector<SampledBranch>& branches() const noexcept { return branches_; }
  /// The wheel meets the rail at every sample.
  [[nodiscard]] bool touches_everywhere() const noexcept { return touches_everywhere_; }

  /// Height above first touch of the lowest branch that is not in branches() for want of room; infinite as a rule [m].
  [[nodiscard]] double missing_height() const noexcept { return missing_height_; }

  /// Share of the neighbours along each axis between which a branch begins or ends.
  [[nodiscard]] std::array<double, 3> changes() const;
  /// Calls pair(a, b) for all neighbours along an axis.
  template <class Pair>
  void for_each_neighbours(std::size_t axis, const Pair& pair) const {
    for (std::size_t n = 0; n < samples_.size(); ++n) {
      if (samples_[n].grid[axis] > 0) pair(n - stride_[axis], n);
    }
  }

 private:
  void search_samples(const ContactSearch& search);
  void link_touches();
  void follow_lowered(const ContactSearch& search);
  void adopt(const std::vector<std::vector<BranchDatum>>& orphans);
  void collect();
  [[nodiscard]] BranchDatum datum(const BoxSample& sample, double y, double z, double slope, double s_wheel,
                                  double s_rail) const;

  CellBox box_;
  double lowering_;
  double radius_;
  std::array<std::size_t, 3> size_{}, stride_{};
  std::vector<BoxSample> samples_;
  std::vector<std::vector<BranchDatum>> lowered_data_;  // per component
  int components_ = 0;
  std::vector<SampledBranch> branches_;
  double missing_height_ = std::numeric_limits<double>::infinity();
  bool touches_everywhere_ = true;
};

/// Least-squares polynomials of a branch's data, as stored in a table.
[[nodiscard]] std::array<float, most_branch_terms * branch_quantities> fit_branch(const SampledBranch& branch,
                                                                                  bool yaw_axis, bool roll_axis);

}  // namespace railtab
