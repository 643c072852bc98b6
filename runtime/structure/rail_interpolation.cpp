#include <algorithm>
#include <cassert>
#include <cmath>

#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/structure/torsion_element.hpp"

namespace railtab {

bool contains(const RailLine& rail, double x) noexcept {
  return rail.x.size() >= 2 && x >= rail.x.front() && x <= rail.x.back();
}

DofIndices head_dofs(const RailLine& rail, std::size_t node) noexcept {
  DofIndices dofs = rail.dof[node];
  dofs[0] = rail.twist_rate.empty() ? held : rail.twist_rate[node];
  return dofs;
}

std::array<int, 12> element_dofs(const RailLine& rail, std::size_t node) noexcept {
  std::array<int, 12> dofs;
  for (std::size_t k = 0; k < 2; ++k) {
    const DofIndices of_node = head_dofs(rail, node + k);
    std::copy(of_node.begin(), of_node.end(), dofs.begin() + static_cast<std::ptrdiff_t>(6 * k));
  }
  return dofs;
}

bool same_element(const RailLine& a, const RailLine& b, std::size_t node) noexcept {
  return a.x[node] == b.x[node] && a.x[node + 1] == b.x[node + 1] && a.head_height == b.head_height &&
         a.stiffness == b.stiffness && a.twist_rate.empty() == b.twist_rate.empty();
}

namespace {

/// Torsion of the element after this node. @pre the rail's twist is smooth
TorsionElement torsion_of(const RailLine& rail, std::size_t e) noexcept {
  return {rail.stiffness.GJ, rail.stiffness.warping_length, rail.x[e + 1] - rail.x[e]};
}

/// Shapes of roll at s of an element of this length whose roll is linear.
TorsionShape linear_roll(double length, double s) noexcept {
  return {{1.0 - s / length, 0.0, s / length, 0.0}, {-1.0 / length, 0.0, 1.0 / length, 0.0}};
}

/// In the element after the node e.
RailInterpolation interpolation(const RailLine& rail, std::size_t e, double x, const TorsionShape& torsion) noexcept {
  const double length = rail.x[e + 1] - rail.x[e], h = rail.head_height;
  const BeamShape N = beam_shape(length, x - rail.x[e]);
  RailInterpolation rows;
  rows.dof = element_dofs(rail, e);
  for (int k = 0; k < 12; ++k) {
    rows.y[k] = N(1, k);
    rows.z[k] = N(2, k);
    rows.yaw[k] = N(5, k);
    rows.pitch[k] = N(4, k);
  }
  rows.roll = {};
  constexpr std::array<std::size_t, 4> place{3, 0, 9, 6};  // roll and twist rate of either node
  for (std::size_t i = 0; i < 4; ++i) {
    rows.roll[place[i]] = torsion.twist[static_cast<Eigen::Index>(i)];
    rows.y[place[i]] = h * rows.roll[place[i]];
    rows.yaw[place[i]] = h * torsion.rate[static_cast<Eigen::Index>(i)];  // the head's line has the rail's twist in it
  }
  const double t = (x - rail.x[e]) / length;
  rows.bend = {};
  rows.bend[2] = (12 * t - 6) / (length * length);
  rows.bend[4] = -(6 * t - 4) / length;  // pitch = -dz/dx
  rows.bend[8] = -rows.bend[2];
  rows.bend[10] = -(6 * t - 2) / length;
  return rows;
}

/// From compliances of the axis in y, z and roll to those of the head, which stands h above it.
Eigen::Matrix3d of_head(double y, double z, double roll, double h) {
  Eigen::Matrix3d C;
  C << y + h * h * roll, 0.0, h * roll,  //
      0.0, z, 0.0,                       //
      h * roll, 0.0, roll;
  return C;
}

}  // namespace

Eigen::Matrix3d element_compliance(const RailLine& rail, double x, double loaded) noexcept {
  assert(contains(rail, x) && contains(rail, loaded));
  const size_t e = interval_at(rail.x, loaded);
  const RailStiffness& of = rail.stiffness;
  if (rail.twist_rate.empty() || (x != loaded && interval_at(rail.x, x) != e)) return Eigen::Matrix3d::Zero();
  const double L = rail.x[e + 1] - rail.x[e];
  // By Maxwell's theorem the load is the one farther from the first node.
  const double s = std::min(x, loaded) - rail.x[e], a = std::max(x, loaded) - rail.x[e], b = L - a;
  const double bending = b * b * s * s * (3.0 * a * L - s * (3.0 * a + b)) / (6.0 * L * L * L);
  return of_head(bending / of.EIz, bending / of.EIy, torsion_compliance(torsion_of(rail, e), s, a), rail.head_height);
}

RailInterpolation rail_interpolation(const RailLine& rail, double x) noexcept {
  assert(contains(rail, x));
  const size_t e = interval_at(rail.x, x);
  const double s = x - rail.x[e];
  const bool linear = rail.twist_rate.empty();
  return interpolation(rail, e, x,
                       linear ? linear_roll(rail.x[e + 1] - rail.x[e], s) : torsion_shape(torsion_of(rail, e), s));
}

RailPlace rail_place(const RailLine& rail, double x) noexcept {
  assert(contains(rail, x));
  const size_t e = interval_at(rail.x, x);
  const double L = rail.x[e + 1] - rail.x[e], a = x - rail.x[e];
  if (rail.twist_rate.empty()) return {e, interpolation(rail, e, x, linear_roll(L, a)), {}};
  const RailStiffness& of = rail.stiffness;
  const double b = L - a, ab = a * b / L;
  const double bending = ab * ab * ab / 3.0, slope = ab * ab * (b - a) / L;
  const TorsionPlace torsion = torsion_place(torsion_of(rail, e), a);
  return {e,
          interpolation(rail, e, x, torsion.shape),
          {of_head(bending / of.EIz, bending / of.EIy, torsion.compliance, rail.head_height),
           of_head(slope / of.EIz, slope / of.EIy, torsion.slope, rail.head_height)}};
}

}  // namespace railtab
