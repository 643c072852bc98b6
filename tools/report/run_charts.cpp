#include "run_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "headline.hpp"
#include "railtab/runtime/report/chart.hpp"

namespace railtab::report {
namespace {

constexpr int lateral = 1, vertical = 2;  // of MotionRecord's six
constexpr std::size_t shown_at_most = 4;  // lines that colours can tell apart
constexpr double gap = std::numeric_limits<double>::quiet_NaN();
constexpr const char* over_distance = "position of the wheel along the track [m]";
constexpr const char* over_time = "time [s]";

/// A quantity of one wheel; the second argument is its static load [N].
using WheelQuantity = std::function<double(const WheelRecord&, double)>;

/// Both wheels of the first and of the last wheelset.
std::vector<std::size_t> end_wheels(std::size_t wheels) {
  if (wheels <= 2) return wheels == 2 ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>(wheels, 0);
  return {0, 1, wheels - 2, wheels - 1};
}

Series wheel_series(const RunResults& results, std::size_t wheel, const WheelQuantity& quantity) {
  Series series{wheel_name(wheel), {}, {}};
  for (const StepRecord& step : results.steps) {
    series.x.push_back(step.position + results.header.wheel_x[wheel]);
    series.y.push_back(quantity(step.wheels[wheel], results.header.static_wheel_load[wheel]));
  }
  return series;
}

/// Smallest and largest value over all wheels that passed a piece of the track.
Band all_wheels(const RunResults& results, const WheelQuantity& quantity) {
  constexpr int pieces = 500;
  const ResultHeader& header = results.header;
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
  return band;
}

std::string wheel_chart(const RunResults& results, Chart chart, const WheelQuantity& quantity) {
  if (results.steps.empty() || results.header.wheel_x.empty()) return "";
  chart.x_label = over_distance;
  const std::vector<std::size_t> ends = end_wheels(results.header.wheel_x.size());
  for (const std::size_t wheel : ends) chart.series.push_back(wheel_series(results, wheel, quantity));
  if (results.header.wheel_x.size() > ends.size()) chart.bands.push_back(all_wheels(results, quantity));
  return chart_html(chart);
}

/// Which of a run's bodies or nodes to draw: all of up to four, else the first, the last and the two that move most.
std::vector<std::size_t> chosen(const std::vector<std::size_t>& candidates,
                                const std::function<double(std::size_t)>& peak) {
  if (candidates.size() <= shown_at_most) return candidates;
  std::vector<std::size_t> middle(candidates.begin() + 1, candidates.end() - 1);
  std::partial_sort(middle.begin(), middle.begin() + 2, middle.end(),
                    [&](std::size_t a, std::size_t b) { return peak(a) > peak(b); });
  std::vector<std::size_t> result{candidates.front(), middle[0], middle[1], candidates.back()};
  std::sort(result.begin(), result.end());
  return result;
}

using Motions = std::vector<MotionRecord> StepRecord::*;
using Derivative = double (MotionRecord::*)[6];

/// What to draw of bodies or nodes: displacement or acceleration of one direction, times a factor to the axis' unit.
struct Motion {
  Motions of;
  Derivative derivative;
  int direction;
  double factor;

  [[nodiscard]] double at(const StepRecord& step, std::size_t index) const {
    return factor * ((step.*of)[index].*derivative)[direction];
  }
};

std::string motion_chart(const RunResults& results, Chart chart, const Motion& motion,
                         const std::vector<std::size_t>& candidates,
                         const std::function<std::string(std::size_t)>& name) {
  chart.x_label = over_time;
  const auto peak = [&](std::size_t index) {
    double largest = 0.0;
    for (const StepRecord& step : results.steps) largest = std::max(largest, std::abs(motion.at(step, index)));
    return largest;
  };
  for (const std::size_t index : chosen(candidates, peak)) {
    Series series{name(index), {}, {}};
    for (const StepRecord& step : results.steps) {
      series.x.push_back(step.time);
      series.y.push_back(motion.at(step, index));
    }
    chart.series.push_back(std::move(series));
  }
  if (candidates.size() > shown_at_most) {
    chart.note += fmt::format(" Of {}, the first, the last and the two that move most.", candidates.size());
  }
  return chart_html(chart);
}

std::vector<std::size_t> indices(const std::vector<std::string>& names,
                                 const std::function<bool(const std::string&)>& wanted) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (wanted(names[i])) result.push_back(i);
  }
  return result;
}

}  // namespace

std::string wheel_force_charts(const RunResults& results) {
  constexpr double kN = 1e-3;
  Chart Q{"Vertical wheel force Q", "Force of the wheel on the rail, positive down.", "", "Q [kN]", {}, {}, {}};
  Chart Y{"Lateral wheel force Y", "Force of the wheel on the rail, positive to the right.", "", "Y [kN]", {}, {}, {}};
  return wheel_chart(results, Q, [](const WheelRecord& wheel, double) { return kN * wheel.Q; }) +
         wheel_chart(results, Y, [](const WheelRecord& wheel, double) { return kN * wheel.Y; });
}

std::string running_safety_charts(const RunResults& results) {
  Chart derailment{"Derailment coefficient Y/Q",
                   "Amount of Y over Q while the wheel is in contact, unfiltered; the limit is meant for the mean over "
                   "2 m of track.",
                   "",
                   "|Y|/Q [–]",
                   {},
                   {},
                   {{0.8, "0.8 – EN 14363"}}};
  Chart unloading{"Wheel unloading ΔQ/Q0",
                  "Share of the static wheel load that is missing, unfiltered; 1 is lift-off.",
                  "",
                  "ΔQ/Q0 [–]",
                  {},
                  {},
                  {{0.6, "0.6 – EN 14363"}}};
  return wheel_chart(results, derailment,
                     [](const WheelRecord& wheel, double) { return wheel.Q > 0 ? std::abs(wheel.Y) / wheel.Q : gap; }) +
         wheel_chart(results, unloading, [](const WheelRecord& wheel, double static_load) {
           return static_load > 0 ? 1.0 - wheel.Q / static_load : gap;
         });
}

std::string car_body_charts(const RunResults& results) {
  const auto bodies = indices(results.header.body_names, is_car_body);
  const auto name = [&](std::size_t i) { return vehicle_of(results.header.body_names[i]); };
  Chart up{"Vertical car-body acceleration",
           "At the centre of gravity, positive down, unfiltered.",
           "",
           "a_z [m/s²]",
           {},
           {},
           {}};
  Chart side{"Lateral car-body acceleration",
             "At the centre of gravity, positive to the right, unfiltered.",
             "",
             "a_y [m/s²]",
             {},
             {},
             {}};
  return motion_chart(results, up, {&StepRecord::bodies, &MotionRecord::acceleration, vertical, 1.0}, bodies, name) +
         motion_chart(results, side, {&StepRecord::bodies, &MotionRecord::acceleration, lateral, 1.0}, bodies, name);
}

std::string structure_charts(const RunResults& results) {
  constexpr double mm = 1e3;
  const std::vector<std::string>& names = results.header.node_names;
  const auto deck = indices(names, is_deck);
  const auto others = indices(names, [](const std::string& name) { return !is_deck(name); });
  const auto name = [&](std::size_t i) { return fmt::format("{} (x = {:.1f} m)", names[i], results.header.node_x[i]); };
  Chart acceleration{"Deck acceleration", "Vertical, positive down, unfiltered.", "", "a_z [m/s²]", {}, {}, {}};
  Chart displacement{"Deck displacement", "Vertical, positive down.", "", "z [mm]", {}, {}, {}};
  Chart rail{"Rail displacement", "Vertical, positive down.", "", "z [mm]", {}, {}, {}};
  const Motion moved{&StepRecord::nodes, &MotionRecord::displacement, vertical, mm};
  return motion_chart(results, acceleration, {&StepRecord::nodes, &MotionRecord::acceleration, vertical, 1.0}, deck,
                      name) +
         motion_chart(results, displacement, moved, deck, name) + motion_chart(results, rail, moved, others, name);
}

}  // namespace railtab::report
