#include "railtab/tablegen/cell_check.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace railtab {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A limit found at a few points holds for the whole cell only with some room below it [m].
constexpr double height_margin = 10e-6;
/// Two solutions of the touch equations nearer than this are one [m].
constexpr double same_pair = 1e-7;
/// As in the runtime: a solution further from its start is another branch's [m].
constexpr double capture_distance = 0.5e-3;
/// Near the upper end of the heights that both sides list, one may list a minimum and the other not [m].
constexpr double height_overlap = 0.1e-3;
constexpr int points_per_cell = 5;

/// Fractions of a cell: its centre, then the additive recurrence of the plastic number, which fills the unit cube
/// evenly.
std::array<double, 3> check_point(int n) {
  if (n == 0) return {0.5, 0.5, 0.5};
  constexpr std::array<double, 3> step{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  std::array<double, 3> point{};
  for (std::size_t a = 0; a < 3; ++a) point[a] = std::fmod(0.5 + step[a] * n, 1.0);
  return point;
}

/// Smallest height above the table's first touch at which table and search differ; infinity where they agree.
double disagreement(const ContactSearch& search, const GeometryTable& table, double branch_height, double y, double yaw,
                    double roll) {
  const TouchPoints truth = search.touches(y, roll, yaw, branch_height);
  const GeometryTable::Lookup lookup = table.lookup(y, yaw, roll);
  if (truth.count == 0 || lookup.count == 0) return truth.count == lookup.count ? infinity : 0.0;
  double first = infinity;
  for (int b = 0; b < lookup.count; ++b) first = std::min(first, lookup.branch[b].z_touch);

  const WheelsetPose pose{y, 0.0, roll, yaw};
  const PoseTrigonometry trigonometry(pose);
  std::array<bool, TouchPoints::capacity> found{};
  double height = infinity;
  for (int b = 0; b < lookup.count; ++b) {
    const BranchValue& branch = lookup.branch[b];
    const RefinedTouch refined = refine_touch(search.pair(), pose, trigonometry, branch.s_wheel, branch.s_rail);
    bool matched = false;
    if (refined.status == PairStatus::converged &&
        std::abs(refined.touch.s_wheel - branch.s_wheel) <= capture_distance) {
      for (int t = 0; t < truth.count; ++t) {
        if (std::abs(truth.touch[t].s_wheel - refined.touch.s_wheel) > same_pair || found[t]) continue;
        found[t] = matched = true;
      }
    }
    if (!matched && branch.z_touch - first < branch_height - height_overlap) {
      height = std::min(height, branch.z_touch - first);
    }
  }
  for (int t = 0; t < truth.count; ++t) {
    if (!found[t]) height = std::min(height, truth.touch[t].z_touch - first);
  }
  return height;
}

}  // namespace

int limit_wrong_cells(const ContactSearch& search, double branch_height, GeometryTableData& data) {
  const GeometryTable table(data);
  const int lateral_cells = static_cast<int>(data.lateral.size()) - 1;
  const int yaw_cells = std::max(1, static_cast<int>(data.yaw_squared.size()) - 1);
  const int cells = static_cast<int>(data.trusted_lowering.size());
  const auto inside = [](const std::vector<double>& nodes, int i, double fraction) {
    if (nodes.size() == 1) return nodes.front();
    const auto left = static_cast<std::size_t>(i);
    return nodes[left] + fraction * (nodes[left + 1] - nodes[left]);
  };
  std::atomic<int> reduced = 0;
#pragma omp parallel for schedule(dynamic, 64)
  for (int c = 0; c < cells; ++c) {
    double limit = infinity;
    for (int n = 0; n < points_per_cell; ++n) {
      const std::array<double, 3> fraction = check_point(n);
      const double roll = inside(data.roll, c / (lateral_cells * yaw_cells), fraction[2]);
      const double yaw = std::sqrt(inside(data.yaw_squared, c / lateral_cells % yaw_cells, fraction[1]));
      const double y = inside(data.lateral, c % lateral_cells, fraction[0]) + data.nominal_radius * roll;
      limit = std::min(limit, disagreement(search, table, branch_height, y, yaw, roll));
    }
    limit = std::max(0.0, limit - height_margin);
    double& trusted = data.trusted_lowering[static_cast<std::size_t>(c)];
    if (limit < trusted) {
      trusted = limit;
      ++reduced;
    }
  }
  return reduced;
}

}  // namespace railtab
