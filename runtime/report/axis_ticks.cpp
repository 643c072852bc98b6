#include "railtab/runtime/report/axis_ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace railtab::report {
namespace {

/// The round number nearest above span/count.
double round_step(double span, int count) {
  const double raw = span / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power * (1.0 + 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

std::vector<Tick> ticks_between(double low, double high, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  std::vector<Tick> ticks;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last; ++k) {
    const double value = k == 0.0 ? 0.0 : k * step;  // never "-0"
    std::string label = fmt::format("{:.{}f}", value, decimals);
    if (label.front() == '-') label.replace(0, 1, "−");
    ticks.push_back({value, std::move(label)});
  }
  return ticks;
}

/// Equal ends (a constant quantity) still need an axis of some length.
void widen(double& low, double& high) {
  const double least = std::max(1e-9, 1e-9 * std::max(std::abs(low), std::abs(high)));
  if (high - low >= least) return;
  const double margin = low == 0.0 ? 1.0 : 0.05 * std::abs(low);
  low -= margin;
  high += margin;
}

}  // namespace

Axis rounded_axis(double low, double high, int count) {
  widen(low, high);
  const double step = round_step(high - low, count);
  const double from = std::floor(low / step + 1e-9) * step, to = std::ceil(high / step - 1e-9) * step;
  return {from, to, ticks_between(from, to, step)};
}

Axis tight_axis(double low, double high, int count) {
  widen(low, high);
  return {low, high, ticks_between(low, high, round_step(high - low, count))};
}

}  // namespace railtab::report
