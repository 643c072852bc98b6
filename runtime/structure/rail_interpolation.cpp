#include <cassert>

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

}  // namespace railtab
