#include "railtab/tablegen/branch_tracking.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace railtab {

namespace {

/// Difference of the arc lengths that two lateral neighbours predict half-way [m], wheel and rail together.
double lateral_mismatch(const BranchPoint& left, const BranchPoint& right, double h) noexcept {
  return std::abs(left.s_wheel + 0.5 * h * left.s_wheel_dy - right.s_wheel + 0.5 * h * right.s_wheel_dy) +
         std::abs(left.s_rail + 0.5 * h * left.s_rail_dy - right.s_rail + 0.5 * h * right.s_rail_dy);
}

/// Across yaw² or roll the derivative is not known: what remains is nearness, seen against how fast the contact runs.
double transverse_mismatch(const BranchPoint& a, const BranchPoint& b) noexcept {
  return std::abs(a.s_wheel - b.s_wheel) + std::abs(a.s_rail - b.s_rail);
}

/// How far the branch may move sideways from one yaw or roll node to the next [m]. The measured drift of S1002 on 60E1
/// over 30 mrad of yaw is below 0.2 mm; a wrong match is a neighbouring minimum, millimetres away.
constexpr double transverse_drift = 0.2e-3;
constexpr double transverse_base = 1.5e-3;

bool transverse_neighbours_agree(const BranchPoint& a, const BranchPoint& b) noexcept {
  const double speed = std::abs(a.s_wheel_dy) + std::abs(b.s_wheel_dy) + std::abs(a.s_rail_dy) + std::abs(b.s_rail_dy);
  return transverse_mismatch(a, b) <= transverse_base + 0.5 * transverse_drift * speed;
}

struct Link {
  int a, b;  ///< points
  double mismatch;
};

/// All points of the grid in one list, and the links that are possible between neighbours.
struct LinkSearch {
  const GeometryGrid& grid;
  std::span<const std::vector<BranchPoint>> nodes;
  std::vector<int> first_point;  ///< per node, and the total at the end

  void add_links(std::size_t a, std::size_t b, bool lateral, double h, std::vector<Link>& links) const {
    for (std::size_t p = 0; p < nodes[a].size(); ++p) {
      for (std::size_t q = 0; q < nodes[b].size(); ++q) {
        const BranchPoint& u = nodes[a][p];
        const BranchPoint& v = nodes[b][q];
        if (lateral ? !lateral_neighbours_agree(u, v, h) : !transverse_neighbours_agree(u, v)) continue;
        links.push_back({first_point[a] + static_cast<int>(p), first_point[b] + static_cast<int>(q),
                         lateral ? lateral_mismatch(u, v, h) : transverse_mismatch(u, v)});
      }
    }
  }

  /// Links along one axis (0 lateral, 1 yaw², 2 roll), best match first.
  [[nodiscard]] std::vector<Link> along(int axis) const {
    std::vector<Link> links;
    std::array<int, 3> n = grid.nodes();
    n[static_cast<std::size_t>(axis)] -= 1;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const std::size_t next = grid.node(i + (axis == 0), j + (axis == 1), k + (axis == 2));
          const double h =
              axis == 0 ? grid.lateral[static_cast<std::size_t>(i) + 1] - grid.lateral[static_cast<std::size_t>(i)]
                        : 0.0;
          add_links(grid.node(i, j, k), next, axis == 0, h, links);
        }
    std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.mismatch < b.mismatch; });
    return links;
  }
};

/// Sets of points with at most one point per node.
class BranchSets {
 public:
  BranchSets(std::vector<int> node_of_point, const std::vector<int>& first_point)
      : node_(std::move(node_of_point)), first_point_(first_point), parent_(node_.size()), members_(node_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t p = 0; p < node_.size(); ++p) members_[p] = {static_cast<int>(p)};
  }

  int find(int p) {
    while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
    return p;
  }

  /// Unites the sets of two points unless both have a point at some node.
  void unite(int a, int b) {
    int large = find(a);
    int small = find(b);
    if (large == small) return;
    if (members_[large].size() < members_[small].size()) std::swap(large, small);
    for (int p : members_[small]) {
      const int n = node_[p];
      for (int q = first_point_[n]; q < first_point_[n + 1]; ++q) {
        if (find(q) == large) return;
      }
    }
    members_[large].insert(members_[large].end(), members_[small].begin(), members_[small].end());
    members_[small].clear();
    parent_[small] = large;
  }

  [[nodiscard]] const std::vector<std::vector<int>>& members() const noexcept { return members_; }
  [[nodiscard]] int node(int p) const noexcept { return node_[p]; }

 private:
  std::vector<int> node_;
  const std::vector<int>& first_point_;
  std::vector<int> parent_;
  std::vector<std::vector<int>> members_;  // of a root; empty elsewhere
};

GeometryBranch make_branch(const GeometryGrid& grid, std::span<const std::vector<BranchPoint>> nodes,
                           const std::vector<int>& first_point, const BranchSets& sets,
                           const std::vector<int>& members) {
  const std::array<int, 3> n = grid.nodes();
  const auto place = [&](int node) {
    return std::array<int, 3>{node % n[0], node / n[0] % n[1], node / (n[0] * n[1])};
  };
  GeometryBranch branch;
  std::array<int, 3> last{-1, -1, -1};
  branch.first = n;
  for (int p : members) {
    const std::array<int, 3> at = place(sets.node(p));
    for (std::size_t a = 0; a < 3; ++a) {
      branch.first[a] = std::min(branch.first[a], at[a]);
      last[a] = std::max(last[a], at[a]);
    }
  }
  std::size_t total = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    branch.size[a] = last[a] - branch.first[a] + 1;
    total *= static_cast<std::size_t>(branch.size[a]);
  }
  for (std::vector<double>* column :
       {&branch.z_touch, &branch.z_touch_dy, &branch.s_wheel, &branch.s_wheel_dy, &branch.s_rail, &branch.s_rail_dy}) {
    column->assign(total, std::numeric_limits<double>::quiet_NaN());
  }
  for (int p : members) {
    const int node = sets.node(p);
    const std::array<int, 3> at = place(node);
    const std::size_t m = static_cast<std::size_t>(
        ((at[2] - branch.first[2]) * branch.size[1] + at[1] - branch.first[1]) * branch.size[0] + at[0] -
        branch.first[0]);
    const BranchPoint& point = nodes[static_cast<std::size_t>(node)][static_cast<std::size_t>(p - first_point[node])];
    branch.z_touch[m] = point.z_touch;
    branch.z_touch_dy[m] = point.z_touch_dy;
    branch.s_wheel[m] = point.s_wheel;
    branch.s_wheel_dy[m] = point.s_wheel_dy;
    branch.s_rail[m] = point.s_rail;
    branch.s_rail_dy[m] = point.s_rail_dy;
  }
  return branch;
}

}  // namespace

bool lateral_neighbours_agree(const BranchPoint& left, const BranchPoint& right, double h) noexcept {
  // A slope jump from one to the other anywhere between them shifts the half-way prediction by less than this.
  const double speed =
      std::abs(left.s_wheel_dy) + std::abs(right.s_wheel_dy) + std::abs(left.s_rail_dy) + std::abs(right.s_rail_dy);
  constexpr double slack = 20e-6;  // curvature of s(y) within a cell of 0.1 mm
  if (!(lateral_mismatch(left, right, h) <= slack + 0.5 * h * speed)) return false;
  // Mean-value theorem; the slack covers a slope that is not monotone between the nodes.
  const double rise = right.z_touch - left.z_touch;
  const double low = h * std::min(left.z_touch_dy, right.z_touch_dy);
  const double high = h * std::max(left.z_touch_dy, right.z_touch_dy);
  constexpr double height_slack = 1e-7;
  return rise >= low - height_slack && rise <= high + height_slack;
}

std::vector<GeometryBranch> track_branches(const GeometryGrid& grid, std::span<const std::vector<BranchPoint>> nodes) {
  const std::array<int, 3> n = grid.nodes();
  assert(nodes.size() ==
         static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]));
  std::vector<int> first_point(nodes.size() + 1, 0);
  std::vector<int> node_of_point;
  for (std::size_t m = 0; m < nodes.size(); ++m) {
    node_of_point.insert(node_of_point.end(), nodes[m].size(), static_cast<int>(m));
    first_point[m + 1] = static_cast<int>(node_of_point.size());
  }
  const LinkSearch search{grid, nodes, first_point};
  BranchSets sets(std::move(node_of_point), first_point);
  // Lateral links first: with exact derivatives they are the surest; the others then join whole curves.
  for (int axis = 0; axis < 3; ++axis) {
    if (n[static_cast<std::size_t>(axis)] < 2) continue;
    for (const Link& link : search.along(axis)) sets.unite(link.a, link.b);
  }

  std::vector<GeometryBranch> branches;
  for (const std::vector<int>& members : sets.members()) {
    if (!members.empty()) branches.push_back(make_branch(grid, nodes, first_point, sets, members));
  }
  return branches;
}

}  // namespace railtab
