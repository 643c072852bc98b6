#include "railtab/runtime/measures/running_safety.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace railtab {

double nadal_limit(double flange_angle, double friction) noexcept {
  const double t = std::tan(flange_angle);
  return (t - friction) / (1.0 + friction * t);
}

double weinstock_ratio(double Y_left, double Q_left, double Y_right, double Q_right) noexcept {
  assert(Q_left > 0.0 && Q_right > 0.0);
  return std::abs(Y_left / Q_left) + std::abs(Y_right / Q_right);
}

void Unloading::add(double time, double Q, double Q0) noexcept {
  const double value = (Q0 - Q) / Q0;
  if (value > largest_) {
    largest_ = value;
    time_ = time;
  }
  const bool above = value > limit_, was_above = any_ && last_ > limit_;
  const auto crossing = [&] { return last_time_ + (time - last_time_) * (limit_ - last_) / (value - last_); };
  if (above && !was_above) since_ = any_ ? crossing() : time;
  if (was_above) {
    const double lasting = (above ? time : crossing()) - since_;
    if (lasting > longest_) {
      longest_ = lasting;
      begin_ = since_;
    }
  }
  any_ = true;
  last_ = value;
  last_time_ = time;
}

}  // namespace railtab
