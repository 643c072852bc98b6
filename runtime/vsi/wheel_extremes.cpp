#include <cmath>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

void WheelExtremes::add(double time, int wheel, double Y, double Q, double static_load) noexcept {
  const auto raise = [&](WheelExtreme& extreme, double value) {
    if (!extreme.found() || value > extreme.value) extreme = {value, time, wheel};
  };
  raise(largest_Q, Q);
  if (!smallest_Q.found() || Q < smallest_Q.value) smallest_Q = {Q, time, wheel};
  if (Q > 0.0) raise(derailment, std::abs(Y) / Q);
  if (static_load > 0.0) raise(unloading, 1.0 - Q / static_load);
}

}  // namespace railtab
