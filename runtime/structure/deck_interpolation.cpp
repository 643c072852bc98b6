#include "railtab/runtime/structure/deck_interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/structure/matrix_assembly.hpp"

namespace railtab {
namespace {

struct SurfaceNode {
  Eigen::Vector2d place;
  DofSum down;
};
using Shares = std::vector<std::pair<const SurfaceNode*, double>>;

/// The shortest line between two nodes that goes through p; empty: none.
Shares line_through(const std::vector<const SurfaceNode*>& near, const Eigen::Vector2d& p) {
  constexpr double beside = 1e-6;  // [m]
  Shares best;
  double shortest = INFINITY;
  for (std::size_t a = 0; a < near.size(); ++a) {
    for (std::size_t b = a + 1; b < near.size(); ++b) {
      const Eigen::Vector2d along = near[b]->place - near[a]->place, to = p - near[a]->place;
      const double length = along.norm();
      if (!(length < shortest) || length < beside) continue;
      const double t = along.dot(to) / (length * length);
      if (t < -beside / length || t > 1.0 + beside / length || (to - t * along).norm() > beside) continue;
      shortest = length;
      best = {{near[a], 1.0 - t}, {near[b], t}};
    }
  }
  return best;
}

/// The triangle of least circumference around p; empty: none.
Shares triangle_around(const std::vector<const SurfaceNode*>& near, const Eigen::Vector2d& p) {
  constexpr double rounding = 1e-9, flat = 1e-3;  // of the square of its circumference
  Shares best;
  double least = INFINITY;
  const auto area = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); };
  for (std::size_t a = 0; a < near.size(); ++a) {
    for (std::size_t b = a + 1; b < near.size(); ++b) {
      for (std::size_t c = b + 1; c < near.size(); ++c) {
        const Eigen::Vector2d &A = near[a]->place, &B = near[b]->place, &C = near[c]->place;
        const double round = (B - A).norm() + (C - B).norm() + (A - C).norm(), whole = area(B - A, C - A);
        if (!(round < least) || std::abs(whole) < flat * round * round) continue;
        const double at_a = area(B - p, C - p) / whole, at_b = area(C - p, A - p) / whole, at_c = 1.0 - at_a - at_b;
        if (std::min({at_a, at_b, at_c}) < -rounding) continue;
        least = round;
        best = {{near[a], at_a}, {near[b], at_b}, {near[c], at_c}};
      }
    }
  }
  return best;
}

}  // namespace

DofSum node_motion(const FeNode& node, std::size_t k) {
  DofSum sum;
  const std::vector<int>& rows = node.rows[k];
  const auto equal = 1.0 / static_cast<double>(rows.size());
  constexpr std::size_t with_middle = 3;  // of a shell's thickness, over which the displacement is a parabola
  constexpr double outer = 1.0 / 6.0, middle = 4.0 / 6.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sum.emplace_back(rows[i], rows.size() != with_middle ? equal : i == 1 ? middle : outer);
  }
  const bool may_stand = k == y_dof || k == z_dof;
  if (rows.empty() && may_stand && node.support[k - y_dof] != held) {
    sum.emplace_back(support_dof(node.support[k - y_dof]), 1.0);
  }
  return sum;
}

SurfaceMotion surface_motion(const FeStructure& structure, const std::vector<int>& deck) {
  std::vector<SurfaceNode> nodes;
  for (const int number : deck) {
    const FeNode& node = structure.nodes.at(number);
    nodes.push_back({node.position.head<2>(), node_motion(node, z_dof)});
  }
  return [nodes = std::move(nodes)](double x, double y) -> std::optional<DofSum> {
    constexpr std::size_t most = 14;
    const Eigen::Vector2d p(x, y);
    std::vector<const SurfaceNode*> near;
    for (const SurfaceNode& node : nodes) near.push_back(&node);
    const auto count = static_cast<std::ptrdiff_t>(std::min(most, near.size()));
    std::partial_sort(near.begin(), near.begin() + count, near.end(), [&](const SurfaceNode* a, const SurfaceNode* b) {
      return (a->place - p).squaredNorm() < (b->place - p).squaredNorm();
    });
    near.resize(static_cast<std::size_t>(count));
    Shares shares = line_through(near, p);
    if (shares.empty()) shares = triangle_around(near, p);
    if (shares.empty()) return std::nullopt;
    DofSum sum;
    for (const auto& [node, share] : shares) add_sum(node->down, share, sum);
    return sum;
  };
}

SurfaceSlopes surface_slopes(const SurfaceMotion& motion, double x, double y) {
  constexpr double half_width = 0.75;  // [m]
  const auto slope = [&](double dx, double dy) -> std::optional<DofSum> {
    std::array<double, 2> at{-1.0, 1.0};
    std::array<std::optional<DofSum>, 2> ends{motion(x - dx, y - dy), motion(x + dx, y + dy)};
    for (std::size_t side = 0; side < 2; ++side) {
      if (ends[side]) continue;
      at[side] = 0.0;
      ends[side] = motion(x, y);
    }
    if (!ends[0] || !ends[1] || at[0] == at[1]) return std::nullopt;
    DofSum sum;
    add_sum(*ends[1], 1.0 / ((at[1] - at[0]) * half_width), sum);
    add_sum(*ends[0], -1.0 / ((at[1] - at[0]) * half_width), sum);
    return sum;
  };
  SurfaceSlopes slopes{slope(0.0, half_width), slope(half_width, 0.0)};
  if (slopes.pitch) {
    for (auto& [dof, value] : *slopes.pitch) value = -value;
  }
  return slopes;
}

}  // namespace railtab
