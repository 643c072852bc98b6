#include "railtab/tablegen/search_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/branch_tracking.hpp"

namespace railtab {

namespace {

struct Stretch {
  double low, high;
};

/// Room on both sides of what nodes and samples show, for the drift of an end between yaw and roll nodes [m].
constexpr double margin = 1.4e-3;
/// Largest continuation of a branch beyond its last node [m].
constexpr double largest_continuation = 6e-3;
constexpr int samples_per_cell = 32;
/// Shares of the searched lowering at which a sample is held against the online search.
constexpr std::array<double, 4> sample_heights{1e-4, 0.2, 0.6, 1.0};

struct Cell {
  int i, j, k;
};

/// The whole of a table's nodes by their place in the grid.
class BranchNodes {
 public:
  explicit BranchNodes(const GeometryTableData& table) : table_(table) {
    grid_ = {table.lateral, table.yaw_squared, table.roll};
  }

  [[nodiscard]] Cell cell(int number) const {
    const std::array<int, 3> c = grid_.cells();
    return {number % c[0], number / c[0] % c[1], number / (c[0] * c[1])};
  }

  /// What the ends of branches in and around a cell may hide.
  [[nodiscard]] std::vector<Stretch> stretches(const Cell& cell, double lowering) const {
    std::vector<Stretch> result;
    const std::array<int, 3> n = grid_.nodes();
    for (const GeometryBranch& b : table_.branches) {
      if (!near(b, cell)) continue;
      for (int k = cell.k; k <= std::min(cell.k + 1, n[2] - 1); ++k)
        for (int j = cell.j; j <= std::min(cell.j + 1, n[1] - 1); ++j) add_row(b, {cell.i, j, k}, lowering, result);
      if (!complete(b, cell)) add_corners(b, cell, result);
    }
    return result;
  }

  [[nodiscard]] const GeometryGrid& grid() const noexcept { return grid_; }

 private:
  static constexpr int reach = 12;  // cells to the side that are looked at

  [[nodiscard]] static bool near(const GeometryBranch& b, const Cell& cell) {
    return b.first[0] <= cell.i + 1 + reach && b.first[0] + b.size[0] >= cell.i - reach && b.first[1] <= cell.j + 1 &&
           b.first[1] + b.size[1] >= cell.j && b.first[2] <= cell.k + 1 && b.first[2] + b.size[2] >= cell.k;
  }

  [[nodiscard]] static std::optional<BranchPoint> point_at(const GeometryBranch& b, int i, int j, int k) {
    i -= b.first[0];
    j -= b.first[1];
    k -= b.first[2];
    if (i < 0 || j < 0 || k < 0 || i >= b.size[0] || j >= b.size[1] || k >= b.size[2]) return std::nullopt;
    const auto n = static_cast<std::size_t>((k * b.size[1] + j) * b.size[0] + i);
    if (std::isnan(b.z_touch[n])) return std::nullopt;
    return BranchPoint{b.z_touch[n], b.z_touch_dy[n], b.s_wheel[n], b.s_wheel_dy[n], b.s_rail[n], b.s_rail_dy[n]};
  }

  template <typename Action>
  void for_corners(const GeometryBranch& b, const Cell& cell, const Action& action) const {
    const std::array<int, 3> n = grid_.nodes();
    for (int k = cell.k; k <= std::min(cell.k + 1, n[2] - 1); ++k)
      for (int j = cell.j; j <= std::min(cell.j + 1, n[1] - 1); ++j)
        for (int i = cell.i; i <= cell.i + 1; ++i) action(point_at(b, i, j, k));
  }

  [[nodiscard]] bool complete(const GeometryBranch& b, const Cell& cell) const {
    bool all = true;
    for_corners(b, cell, [&](const std::optional<BranchPoint>& p) { all = all && p; });
    return all;
  }

  void add_corners(const GeometryBranch& b, const Cell& cell, std::vector<Stretch>& result) const {
    Stretch hull{1.0, -1.0};
    for_corners(b, cell, [&](const std::optional<BranchPoint>& p) {
      if (!p) return;
      hull = hull.low > hull.high ? Stretch{p->s_wheel, p->s_wheel}
                                  : Stretch{std::min(hull.low, p->s_wheel), std::max(hull.high, p->s_wheel)};
    });
    if (hull.low <= hull.high) result.push_back(hull);
  }

  /// The breaks of a branch along a row of the grid: where it ends, or its neighbours do not agree.
  void add_row(const GeometryBranch& b, const Cell& row, double lowering, std::vector<Stretch>& result) const {
    const int last = grid_.nodes()[0] - 1;
    for (int i = std::max(0, row.i - reach); i < std::min(last, row.i + 1 + reach); ++i) {
      const std::optional<BranchPoint> left = point_at(b, i, row.j, row.k);
      const std::optional<BranchPoint> right = point_at(b, i + 1, row.j, row.k);
      if (!left && !right) continue;
      if (left && right) {
        if (lateral_neighbours_agree(*left, *right, lateral(i + 1) - lateral(i)) ||
            !(felt(*left, i, row, lowering) || felt(*right, i + 1, row, lowering))) {
          continue;
        }
        result.push_back({std::min(left->s_wheel, right->s_wheel), std::max(left->s_wheel, right->s_wheel)});
      } else if (left && felt(*left, i, row, lowering)) {
        result.push_back(continued(*left, lateral(i + 1) - lateral(i)));
      } else if (right && felt(*right, i + 1, row, lowering)) {
        result.push_back(continued(*right, lateral(i) - lateral(i + 1)));
      }
    }
  }

  /// Whether the normal at a node leads, within `lowering`, to within a cell's width of the cell: y* = y - d·n_y.
  [[nodiscard]] bool felt(const BranchPoint& p, int node, const Cell& cell, double lowering) const {
    const double distance = std::max({0.0, lateral(cell.i) - lateral(node), lateral(node) - lateral(cell.i + 1)});
    const double shift = lowering * std::abs(p.z_touch_dy) / (1.0 + p.z_touch_dy * p.z_touch_dy);
    return distance <= shift + 1.001 * (lateral(cell.i + 1) - lateral(cell.i));
  }

  /// From a branch's last node to its end, which is less than `step` to the side. Towards a fold s runs like a square
  /// root: at most twice the tangent's way.
  [[nodiscard]] static Stretch continued(const BranchPoint& end, double step) {
    const double way = std::min(2.0 * std::abs(step * end.s_wheel_dy), largest_continuation);
    const double other = end.s_wheel + (step * end.s_wheel_dy > 0 ? way : -way);
    return {std::min(end.s_wheel, other), std::max(end.s_wheel, other)};
  }

  [[nodiscard]] double lateral(int i) const { return grid_.lateral[static_cast<std::size_t>(i)]; }

  const GeometryTableData& table_;
  GeometryGrid grid_;
};

/// Stretches in increasing order, those in touch joined.
std::vector<Stretch> joined(std::vector<Stretch> stretches) {
  std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) { return a.low < b.low; });
  std::vector<Stretch> result;
  for (const Stretch& s : stretches) {
    if (result.empty() || s.low > result.back().high) {
      result.push_back(s);
    } else {
      result.back().high = std::max(result.back().high, s.high);
    }
  }
  return result;
}

bool holds(const std::vector<Stretch>& stretches, double s) {
  return std::any_of(stretches.begin(), stretches.end(),
                     [&](const Stretch& stretch) { return s >= stretch.low && s <= stretch.high; });
}

/// The additive recurrence of the plastic number in a cell of the grid.
WheelsetPose sample_pose(const GeometryTableData& table, const Cell& cell, int n) {
  constexpr std::array<double, 3> step{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const auto inside = [&](const std::vector<double>& nodes, int left, std::size_t axis) {
    if (nodes.size() == 1) return nodes.front();
    const auto i = static_cast<std::size_t>(left);
    return nodes[i] + std::fmod(0.5 + step[axis] * n, 1.0) * (nodes[i + 1] - nodes[i]);
  };
  const double roll = inside(table.roll, cell.k, 2);
  return {inside(table.lateral, cell.i, 0) + table.nominal_radius * roll, 0.0, roll,
          std::sqrt(inside(table.yaw_squared, cell.j, 1))};
}

/// Adds a stretch for every pair of the online search that neither a branch's start nor a stretch leads to.
void add_missed(const TableContact& contact, const Cell& cell, double lowering, std::vector<Stretch>& stretches) {
  for (int n = 0; n < samples_per_cell; ++n) {
    WheelsetPose pose = sample_pose(contact.table().data(), cell, n);
    const PoseTrigonometry trigonometry(pose);
    const GeometryTable::Lookup lookup = contact.table().lookup(pose.y, pose.yaw, pose.roll);
    double first_touch = lookup.branch[0].z_touch;
    for (int b = 1; b < lookup.count; ++b) first_touch = std::min(first_touch, lookup.branch[b].z_touch);
    for (const double share : sample_heights) {
      pose.z = first_touch + share * lowering;
      ContactPatches known;
      const bool complete = contact.add_branch_patches(lookup, pose, trigonometry, 0.0, known);
      for (const ContactPatch& patch : contact.search().patches(pose)) {
        const bool found = complete && std::any_of(known.begin(), known.end(), [&](const ContactPatch& p) {
                             return std::abs(p.s_wheel - patch.s_wheel) < 1e-6;
                           });
        if (found || holds(stretches, patch.s_wheel)) continue;
        stretches.push_back({patch.s_wheel - margin, patch.s_wheel + margin});
      }
    }
  }
}

}  // namespace

void set_search_windows(double searched_lowering, GeometryTableData& data) {
  data.searched_lowering = searched_lowering;
  const TableContact contact{GeometryTable(data)};
  const BranchNodes nodes(data);
  const int cells = static_cast<int>(data.trusted_lowering.size());
  std::vector<std::vector<Stretch>> found(data.trusted_lowering.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (int c = 0; c < cells; ++c) {
    if (data.trusted_lowering[static_cast<std::size_t>(c)] >= searched_lowering) continue;
    const Cell cell = nodes.cell(c);
    const WheelsetPose middle = sample_pose(data, cell, 0);
    if (contact.table().lookup(middle.y, middle.yaw, middle.roll).count == 0) continue;
    std::vector<Stretch> stretches = nodes.stretches(cell, searched_lowering);
    for (Stretch& s : stretches) s = {s.low - margin, s.high + margin};
    add_missed(contact, cell, searched_lowering, stretches);
    found[static_cast<std::size_t>(c)] = joined(std::move(stretches));
  }
  for (int c = 0; c < cells; ++c) {
    for (const Stretch& s : found[static_cast<std::size_t>(c)]) data.windows.push_back({c, s.low, s.high});
  }
}

}  // namespace railtab
