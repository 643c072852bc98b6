#include "railtab/runtime/measures/track_mean.hpp"

namespace railtab {

std::optional<double> TrackMean::add(double position, double value) {
  double integral = 0.0;
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    integral = last.integral + 0.5 * (last.value + value) * (position - last.position);
  }
  samples_.push_back({position, value, integral});
  const double from = position - length_;
  if (samples_.front().position > from) return std::nullopt;
  while (samples_.size() > 2 && samples_[1].position <= from) samples_.pop_front();
  const Sample &a = samples_[0], &b = samples_[1];
  const double part = from - a.position, slope = (b.value - a.value) / (b.position - a.position);
  const double before = a.integral + part * (a.value + 0.5 * slope * part);
  return (integral - before) / length_;
}

}  // namespace railtab
