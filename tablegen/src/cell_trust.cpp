#include "railtab/tablegen/cell_trust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace railtab {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// What straight lines between nodes 0.1 mm apart leave out at a branch radius of 10 mm, ten times over [m].
constexpr double height_margin = 5e-6;
/// Cells to the side of a branch's end that are looked at; 0.1 mm each, against a lateral shift of half the lowering.
constexpr int reach = 40;

struct Node {
  int i, j, k;
};

/// The lowest branch at a corner of a cell, of those that are complete in the cell: where the table sees the wheel
/// touch first, and the slope there.
struct FirstTouch {
  double z = infinity;
  double z_dy = 0.0;
};

std::optional<BranchPoint> point_at(const GeometryBranch& b, const Node& node) {
  const int i = node.i - b.first[0], j = node.j - b.first[1], k = node.k - b.first[2];
  if (i < 0 || j < 0 || k < 0 || i >= b.size[0] || j >= b.size[1] || k >= b.size[2]) return std::nullopt;
  const auto n = static_cast<std::size_t>((k * b.size[1] + j) * b.size[0] + i);
  if (std::isnan(b.z_touch[n])) return std::nullopt;
  return BranchPoint{b.z_touch[n], b.z_touch_dy[n], b.s_wheel[n], b.s_wheel_dy[n], b.s_rail[n], b.s_rail_dy[n]};
}

/// Whether the branch exists at all corners of a cell, as a look-up needs it.
bool complete(const GeometryGrid& grid, const GeometryBranch& b, const Node& cell) {
  const std::array<int, 3> n = grid.nodes();
  for (int k = cell.k; k <= std::min(cell.k + 1, n[2] - 1); ++k)
    for (int j = cell.j; j <= std::min(cell.j + 1, n[1] - 1); ++j)
      for (int i = cell.i; i <= cell.i + 1; ++i) {
        if (!point_at(b, {i, j, k})) return false;
      }
  return true;
}

class TrustSweep {
 public:
  TrustSweep(const GeometryGrid& grid, const std::vector<GeometryBranch>& branches) : grid_(grid), branches_(branches) {
    const std::array<int, 3> c = grid.cells();
    trust_.assign(static_cast<std::size_t>(c[0]) * static_cast<std::size_t>(c[1]) * static_cast<std::size_t>(c[2]),
                  infinity);
  }

  void add(const GeometryBranch& b) {
    const std::array<int, 3> cells = grid_.cells();
    const auto low = [&](std::size_t a) { return std::max(0, b.first[a] - 1); };
    const auto high = [&](std::size_t a) { return std::min(cells[a], b.first[a] + b.size[a]); };
    for (int k = low(2); k < high(2); ++k)
      for (int j = low(1); j < high(1); ++j)
        for (int i = low(0); i < high(0); ++i) add_cell(b, {i, j, k});
  }

  [[nodiscard]] std::vector<double> take() { return std::move(trust_); }

 private:
  /// Limits the cells around a cell in which the branch is incomplete or not smooth.
  void add_cell(const GeometryBranch& b, const Node& cell) {
    const std::array<int, 3> n = grid_.nodes();
    const double h = width(cell.i);
    bool whole = true;
    bool somewhere = false;
    for (int k = cell.k; k <= std::min(cell.k + 1, n[2] - 1); ++k)
      for (int j = cell.j; j <= std::min(cell.j + 1, n[1] - 1); ++j) {
        const std::optional<BranchPoint> left = point_at(b, {cell.i, j, k});
        const std::optional<BranchPoint> right = point_at(b, {cell.i + 1, j, k});
        whole = whole && left && right && lateral_neighbours_agree(*left, *right, h);
        somewhere = somewhere || left || right;
      }
    if (whole || !somewhere) return;
    for (int k = cell.k; k <= std::min(cell.k + 1, n[2] - 1); ++k)
      for (int j = cell.j; j <= std::min(cell.j + 1, n[1] - 1); ++j)
        for (int i = cell.i; i <= cell.i + 1; ++i) {
          if (const std::optional<BranchPoint> point = point_at(b, {i, j, k})) limit(*point, {i, j, k}, cell);
        }
  }

  /// Limits the cell and those that the normal at `point` (a corner of it) leads to.
  void limit(const BranchPoint& point, const Node& corner, const Node& cell) {
    lower(cell, height(point, corner, cell, cell.i));
    const double cosine = 1.0 / std::hypot(1.0, point.z_touch_dy);
    const double sine = -point.z_touch_dy * cosine;  // lateral part of the normal into the rail
    if (sine == 0.0) return;
    const int direction = sine > 0 ? 1 : -1;
    for (int m = 1; m <= reach; ++m) {
      const int i = cell.i + m * direction;
      if (i < 0 || i >= grid_.cells()[0]) return;
      const double distance = direction > 0 ? lateral(i) - lateral(cell.i + 1) : lateral(cell.i) - lateral(i + 1);
      // Height of the normal above the branch's tangent at that distance to the side.
      lower({i, cell.j, cell.k}, height(point, corner, cell, i) + distance / (std::abs(sine) * cosine));
    }
  }

  [[nodiscard]] FirstTouch first_touch(const Node& cell, const Node& corner) const {
    FirstTouch first;
    for (const GeometryBranch& b : branches_) {
      if (!complete(grid_, b, cell)) continue;
      const std::optional<BranchPoint> point = point_at(b, corner);
      if (point->z_touch < first.z) first = {point->z_touch, point->z_touch_dy};
    }
    return first;
  }

  /// Smallest height of the branch's tangent at `point` above first touch, over lateral cell i in the corner's row.
  [[nodiscard]] double height(const BranchPoint& point, const Node& corner, const Node& cell, int i) const {
    const FirstTouch left = first_touch({i, cell.j, cell.k}, {i, corner.j, corner.k});
    const FirstTouch right = first_touch({i, cell.j, cell.k}, {i + 1, corner.j, corner.k});
    if (std::isinf(left.z) || std::isinf(right.z)) return -infinity;
    const auto tangent = [&](double y) { return point.z_touch + point.z_touch_dy * (y - lateral(corner.i)); };
    double result = std::min(tangent(lateral(i)) - left.z, tangent(lateral(i + 1)) - right.z);
    // Where another branch takes over inside the cell, first touch peaks at the crossing.
    const double h = width(i);
    const double bend = left.z_dy - right.z_dy;
    const double crossing = bend > 0 ? (right.z - right.z_dy * h - left.z) / bend : -1.0;
    if (crossing > 0 && crossing < h) {
      result = std::min(result, tangent(lateral(i) + crossing) - (left.z + left.z_dy * crossing));
    }
    return result;
  }

  void lower(const Node& cell, double height) {
    const std::array<int, 3> c = grid_.cells();
    double& trust = trust_[static_cast<std::size_t>((cell.k * c[1] + cell.j) * c[0] + cell.i)];
    trust = std::min(trust, std::max(0.0, height - height_margin));
  }

  [[nodiscard]] double lateral(int i) const { return grid_.lateral[static_cast<std::size_t>(i)]; }
  [[nodiscard]] double width(int i) const { return lateral(i + 1) - lateral(i); }

  const GeometryGrid& grid_;
  const std::vector<GeometryBranch>& branches_;
  std::vector<double> trust_;
};

}  // namespace

std::vector<double> trusted_lowering(const GeometryGrid& grid, const std::vector<GeometryBranch>& branches) {
  TrustSweep sweep(grid, branches);
  for (const GeometryBranch& branch : branches) sweep.add(branch);
  return sweep.take();
}

}  // namespace railtab
