#include "wheel_band.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railtab::report {

void add_band(const RunResults& results, const std::function<double(const WheelRecord&, double)>& quantity,
              Chart& chart) {
  constexpr int pieces = 500;
  constexpr std::size_t drawn_as_lines = 4;
  const ResultHeader& header = results.header;
  if (results.steps.empty() || header.wheel_x.size() <= drawn_as_lines) return;
  const double from = results.steps.front().position + *std::min_element(header.wheel_x.begin(), header.wheel_x.end());
  const double length = results.steps.back().position - from;
  std::vector<double> low(pieces, std::numeric_limits<double>::infinity()), high(pieces, -low[0]);
  for (const StepRecord& step : results.steps) {
    for (std::size_t i = 0; i < step.wheels.size(); ++i) {
      const double value = quantity(step.wheels[i], header.static_wheel_load[i]);
      if (!std::isfinite(value)) continue;
      const double fraction = length > 0.0 ? (step.position + header.wheel_x[i] - from) / length : 0.0;
      const auto piece = static_cast<std::size_t>(std::clamp(fraction * pieces, 0.0, pieces - 1.0));
      low[piece] = std::min(low[piece], value);
      high[piece] = std::max(high[piece], value);
    }
  }
  Band band{"all wheels, smallest to largest", {}, {}, {}};
  for (std::size_t k = 0; k < pieces; ++k) {
    if (low[k] > high[k]) continue;
    band.x.push_back(from + (static_cast<double>(k) + 0.5) * length / pieces);
    band.low.push_back(low[k]);
    band.high.push_back(high[k]);
  }
  chart.bands.push_back(std::move(band));
}

}  // namespace railtab::report
