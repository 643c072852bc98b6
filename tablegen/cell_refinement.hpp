#pragma once

#include <vector>

#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/intersection/outline_overlap.hpp"
#include "railtab/tablegen/leaf_branches.hpp"

namespace railtab {

/// The tree over one root cell, numbered from its own root node 0, and what its leaves hold.
struct CellTree {
  std::vector<std::uint32_t> node, leaf_branch;
  std::vector<float> trusted_lowering;
  std::vector<float> coefficient;
};

/// Makes the trees of root cells: a cell is halved until its polynomials lead where the online search leads, and until
/// its patches are the regions of the outlines' exact overlap.
/// Const, thread-safe.
class CellRefinement {
 public:
  /// @param search, options stay with the caller
  CellRefinement(const ContactSearch& search, const GeometrySweepOptions& options);

  [[nodiscard]] CellTree tree(const CellBox& root) const;

 private:
  struct Trial;
  void refine(const CellBox& box, std::size_t node, CellTree& tree) const;
  [[nodiscard]] Trial attempt(const CellBox& box, double share) const;
  void check_samples(const CellBox& box, const BoxSamples& samples, Trial& trial) const;
  void check_inside(const CellBox& box, int first, int end, Trial& trial) const;
  void check_pose(const CellBox& box, const std::array<double, 3>& local, const WheelsetPose& pose,
                  const ContactPatches& online, Trial& trial) const;
  void check_outlines(const CellBox& box, Trial& trial) const;
  [[nodiscard]] GeometryLeaf leaf_at(const CellBox& box, const std::array<double, 3>& local, const Trial& trial) const;
  [[nodiscard]] bool in_range(const CellBox& box) const;
  [[nodiscard]] double share_of_queries(const CellBox& box) const;
  [[nodiscard]] std::size_t axis_to_halve(const BoxSamples& samples, const Trial& trial) const;
  [[nodiscard]] bool axis_fixed(std::size_t axis) const noexcept {
    return axis == 1 ? !yaw_axis_ : axis == 2 && !roll_axis_;
  }

  const ContactSearch& search_;
  const GeometrySweepOptions& options_;
  OutlineOverlap outlines_;
  double radius_;
  bool yaw_axis_, roll_axis_;
};

}  // namespace railtab
