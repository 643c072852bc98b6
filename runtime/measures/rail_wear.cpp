#include "railtab/runtime/measures/rail_wear.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

double& RailWear::energy_at(long metre) {
  if (energy_.empty()) first_ = metre;
  if (metre < first_) {
    energy_.insert(energy_.begin(), static_cast<std::size_t>(first_ - metre), 0.0);
    first_ = metre;
  }
  const auto at = static_cast<std::size_t>(metre - first_);
  if (at >= energy_.size()) energy_.resize(at + 1, 0.0);
  return energy_[at];
}

void RailWear::add(double from, double value_from, double to, double value_to) {
  if (!(to > from)) return;
  const double slope = (value_to - value_from) / (to - from);
  const auto value = [&](double x) { return value_from + slope * (x - from); };
  for (double begin = from; begin < to;) {
    const double metre = std::floor(begin), end = std::min(to, metre + 1.0);
    energy_at(static_cast<long>(metre)) += 0.5 * (value(begin) + value(end)) * (end - begin);
    begin = end;
  }
}

std::optional<RailWear::Metre> RailWear::largest() const {
  if (energy_.empty()) return std::nullopt;
  const auto at = std::max_element(energy_.begin(), energy_.end());
  return Metre{static_cast<double>(first_ + (at - energy_.begin())), *at};
}

}  // namespace railtab
