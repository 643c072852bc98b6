#include <cmath>
#include <utility>

#include "railtab/runtime/contact/contact_search.hpp"

namespace railtab {

namespace {

// Height of the right wheel's first touch above the left wheel's, with its derivative by roll. Falls with roll: rolling
// to the right lowers the right wheel. At a change of the touching branch the derivative jumps, the difference does
// not.
struct HeightDifference {
  double value, droll, z;
};

HeightDifference height_difference(const ContactSearch& search, double y, double roll, double yaw) noexcept {
  const TouchPoint right = search.first_touch(y, roll, yaw);
  const TouchPoint left = search.first_touch(-y, -roll, -yaw);
  return {right.z_touch - left.z_touch, right.z_touch_droll + left.z_touch_droll, right.z_touch};
}

}  // namespace

RigidPosition rigid_position(const ContactSearch& search, double y, double yaw) noexcept {
  constexpr int most_steps = 60;
  constexpr double largest_roll = 0.1;  // [rad]
  constexpr double tolerance = 1e-13;   // [rad], and of the height difference [m]
  double below = -largest_roll;         // difference positive
  double above = largest_roll;          // difference negative
  double roll = 0.0;
  RigidPosition result;
  for (int i = 0; i < most_steps; ++i) {
    const HeightDifference f = height_difference(search, y, roll, yaw);
    if (!std::isfinite(f.value)) return result;
    result.roll = roll;
    result.z = f.z;
    if (std::abs(f.value) < tolerance || above - below < tolerance) {
      result.converged = true;
      return result;
    }
    (f.value > 0.0 ? below : above) = roll;
    const double newton = roll - f.value / f.droll;
    // Newton stays in the bracket, or the bracket is halved.
    roll = newton > below && newton < above ? newton : 0.5 * (below + above);
  }
  return result;
}

}  // namespace railtab
