#include <algorithm>
#include <cassert>
#include <cmath>

#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

bool contains(const RailLine& rail, double x) noexcept {
  return rail.x.size() >= 2 && x >= rail.x.front() && x <= rail.x.back();
}

RailInterpolation rail_interpolation(const RailLine& rail, double x) noexcept {
  assert(contains(rail, x));
  const size_t e = interval_at(rail.x, x);
  const double length = rail.x[e + 1] - rail.x[e];
  const BeamShape N = beam_shape(length, x - rail.x[e]);
  RailInterpolation rows;
  for (int k = 0; k < 12; ++k) {
    rows.dof[k] = k < 6 ? rail.dof[e][k] : rail.dof[e + 1][k - 6];
    rows.y[k] = N(1, k) + rail.head_height * N(3, k);
    rows.z[k] = N(2, k);
    rows.roll[k] = N(3, k);
    rows.yaw[k] = N(5, k);
    rows.pitch[k] = N(4, k);
  }
  const double t = (x - rail.x[e]) / length;
  rows.bend = {};
  rows.bend[2] = (12 * t - 6) / (length * length);
  rows.bend[4] = -(6 * t - 4) / length;  // pitch = -dz/dx
  rows.bend[8] = -rows.bend[2];
  rows.bend[10] = -(6 * t - 2) / length;
  // the slope of the head's line has the twist of the rail in it
  rows.yaw[3] -= rail.head_height / length;
  rows.yaw[9] += rail.head_height / length;
  return rows;
}

namespace {

/// From compliances of the axis in y, z and roll to those of the head, which stands h above it.
Eigen::Matrix3d of_head(double y, double z, double roll, double h) {
  Eigen::Matrix3d C;
  C << y + h * h * roll, 0.0, h * roll,  //
      0.0, z, 0.0,                       //
      h * roll, 0.0, roll;
  return C;
}

/// λ: a rail's warping smooths the twist at point loads and fastenings [m]. That of 60E1 is 0.15 m; with the least
/// length that does away with jumps, elements of any length agree.
constexpr double warping_length = 0.04;

/// 1 − e^(−2x/λ), of which sinh(x/λ) is ½ e^(x/λ) times as much.
double faded(double x) noexcept { return -std::expm1(-2.0 / warping_length * x); }

}  // namespace

Eigen::Matrix3d element_compliance(const RailLine& rail, double x, double loaded) noexcept {
  assert(contains(rail, x) && contains(rail, loaded));
  const size_t e = interval_at(rail.x, loaded);
  const RailStiffness& of = rail.stiffness;
  if (!(of.GJ > 0.0) || (x != loaded && interval_at(rail.x, x) != e)) return Eigen::Matrix3d::Zero();
  const double L = rail.x[e + 1] - rail.x[e];
  // By Maxwell's theorem the load is the one farther from the first node.
  const double s = std::min(x, loaded) - rail.x[e], a = std::max(x, loaded) - rail.x[e], b = L - a;
  const double bending = b * b * s * s * (3.0 * a * L - s * (3.0 * a + b)) / (6.0 * L * L * L);
  const double warping = 0.5 * warping_length * std::exp((s - a) / warping_length) * faded(s) * faded(b) / faded(L);
  return of_head(bending / of.EIz, bending / of.EIy, (s * b / L - warping) / of.GJ, rail.head_height);
}

Eigen::Matrix3d element_compliance_slope(const RailLine& rail, double x) noexcept {
  const size_t e = interval_at(rail.x, x);
  const RailStiffness& of = rail.stiffness;
  if (!(of.GJ > 0.0)) return Eigen::Matrix3d::Zero();
  const double L = rail.x[e + 1] - rail.x[e], a = x - rail.x[e], b = L - a;
  const double bending = a * a * b * b * (b - a) / (L * L * L);
  const double twist = (b - a) / L - (faded(b) - faded(a)) / faded(L);
  return of_head(bending / of.EIz, bending / of.EIy, twist / of.GJ, rail.head_height);
}

}  // namespace railtab
