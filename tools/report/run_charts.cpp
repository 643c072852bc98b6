#include "run_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "channel_values.hpp"
#include "deck_charts.hpp"
#include "headline.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/drawing/body_names.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "wheel_band.hpp"

namespace railtab::report {
namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();
constexpr double kN = 1e-3, mm = 1e3;
constexpr const char* over_position = "position of the wheel along the track [m]";
constexpr const char* over_time = "time [s]";

std::vector<std::size_t> indices(const std::vector<std::string>& names,
                                 const std::function<bool(const std::string&)>& wanted) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (wanted(names[i])) result.push_back(i);
  }
  return result;
}

Chart chart_over(Over over, std::string title, std::string note, std::string y_label) {
  Chart chart;
  chart.title = std::move(title);
  chart.note = std::move(note);
  chart.y_label = std::move(y_label);
  chart.x_label = over == Over::time ? over_time : over_position;
  chart.over = over;
  return chart;
}

}  // namespace

RunCharts::RunCharts(std::span<const RunResults> runs, std::vector<std::string> names)
    : runs_(runs), names_(std::move(names)), Q_(runs.size()) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    store_.add_run(names_[r], values(r, [](const StepRecord& step) { return step.time; }),
                   values(r, [](const StepRecord& step) { return step.position; }));
    for (std::size_t w = 0; w < runs[r].header.wheel_x.size(); ++w) {
      Q_[r].push_back(
          store_.add(values(r, [&](const StepRecord& step) { return step.wheels[w].Q; }), detail(at_first(r, w))));
    }
  }
}

std::string RunCharts::label(std::size_t run, const std::string& name) const {
  return runs_.size() == 1 ? name : fmt::format("{}: {}", names_[run], name);
}

Detail RunCharts::detail(bool shown) const {
  constexpr std::size_t of_shown = 40000, of_others = 2000;  // a page of 60 s and 64 wheels stays below 15 MB
  return {(shown ? of_shown : of_others) / runs_.size()};
}

std::vector<double> RunCharts::values(std::size_t run, const Values& value) const {
  std::vector<double> result;
  result.reserve(runs_[run].steps.size());
  for (const StepRecord& step : runs_[run].steps) result.push_back(value(step));
  return result;
}

/// Both wheels of the first and of the last wheelset; of several runs, as many as lines can be told apart.
bool RunCharts::at_first(std::size_t run, std::size_t wheel) const {
  const std::size_t last = runs_[run].header.wheel_x.size() - 1;
  if (runs_.size() == 1) return wheel < 2 || wheel + 1 >= last;
  return wheel == 0 || (wheel == last && 2 * runs_.size() <= line_styles);
}

/// A line of the live chart, and of the static one where it is shown at first.
void RunCharts::add_line(Chart& chart, std::size_t run, LiveSeries line, const std::vector<double>& values) {
  line.run = run;
  if (line.shown && chart.series.size() < line_styles) {
    Series series{line.label, {}, {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const StepRecord& step = runs_[run].steps[i];
      series.x.push_back(chart.over == Over::time ? step.time : step.position + line.offset);
      series.y.push_back(line.factor * values[i] + line.shift);
    }
    chart.series.push_back(std::move(series));
  }
  chart.live.push_back(std::move(line));
}

void RunCharts::add_wheels(Chart& chart, const std::function<double(const WheelRecord&)>& quantity) {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const ResultHeader& header = runs_[r].header;
    for (std::size_t w = 0; w < header.wheel_x.size(); ++w) {
      const std::vector<double> all = values(r, [&](const StepRecord& step) { return quantity(step.wheels[w]); });
      LiveSeries line{.label = label(r, wheel_name(w)), .offset = header.wheel_x[w], .shown = at_first(r, w)};
      line.history = store_.add(all, detail(line.shown));
      add_line(chart, r, std::move(line), all);
    }
  }
}

/// Of every wheel factor·Q + shift, as its static load has them; Q is stored once.
void RunCharts::add_of_Q(Chart& chart, const std::function<Linear(double)>& of_load) {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const ResultHeader& header = runs_[r].header;
    for (std::size_t w = 0; w < Q_[r].size(); ++w) {
      const Linear of_Q = of_load(header.static_wheel_load[w]);
      if (!std::isfinite(of_Q.factor)) continue;
      add_line(chart, r,
               {.label = label(r, wheel_name(w)),
                .history = Q_[r][w],
                .offset = header.wheel_x[w],
                .factor = of_Q.factor,
                .shift = of_Q.shift,
                .shown = at_first(r, w)},
               values(r, [&](const StepRecord& step) { return step.wheels[w].Q; }));
    }
  }
}

std::string RunCharts::wheel_forces() {
  Chart Q =
      chart_over(Over::position, "Vertical wheel force Q", "Force of the wheel on the rail, positive down.", "Q [kN]");
  Chart Y = chart_over(Over::position, "Lateral wheel force Y",
                       "Force of the wheel on the rail, positive to the right.", "Y [kN]");
  add_of_Q(Q, [](double) { return Linear{kN, 0.0}; });
  add_wheels(Y, [](const WheelRecord& wheel) { return kN * wheel.Y; });
  Q.marks = Y.marks = bridge();
  if (runs_.size() == 1) {
    add_band(
        runs_[0], [](const WheelRecord& wheel, double) { return kN * wheel.Q; }, Q);
    add_band(
        runs_[0], [](const WheelRecord& wheel, double) { return kN * wheel.Y; }, Y);
  }
  return chart_html(Q) + chart_html(Y);
}

std::string RunCharts::quotient_mean() {
  Chart chart = chart_over(Over::position, "Derailment coefficient Y/Q, mean over 2 m",
                           "Amount of the mean of Y/Q over the last 2 m of way while the wheel is in contact: the "
                           "measure that the limit is meant for.",
                           "|Y/Q|₂ₘ [–]");
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (sparse(runs_[r])) continue;
    const ResultHeader& header = runs_[r].header;
    for (std::size_t w = 0; w < header.wheel_x.size(); ++w) {
      const std::vector<double> means = sliding_means(runs_[r], [&](const StepRecord& step) {
        return step.wheels[w].Q > 0.0 ? step.wheels[w].Y / step.wheels[w].Q : gap;
      });
      LiveSeries line{.label = label(r, wheel_name(w)), .offset = header.wheel_x[w], .shown = at_first(r, w)};
      line.history = store_.add(means, detail(line.shown));
      add_line(chart, r, std::move(line), means);
    }
  }
  chart.limits = {{0.8, "0.8 – EN 14363"}};
  chart.marks = bridge();
  return chart_html(chart);
}

/// The smallest limit of all wheelsets [EN 14363]: 10 kN + P0/3, P0 the static axle load.
std::string RunCharts::track_shift() {
  Chart chart =
      chart_over(Over::position, "Track shift force ΣY, mean over 2 m",
                 "Amount of the sum of both wheels' Y, its mean over the last 2 m of way; the limit is that of the "
                 "lightest wheelset.",
                 "|ΣY|₂ₘ [kN]");
  double lightest = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (sparse(runs_[r])) continue;
    const ResultHeader& header = runs_[r].header;
    for (std::size_t w = 0; w + 1 < header.wheel_x.size(); w += 2) {
      lightest = std::min(lightest, header.static_wheel_load[w] + header.static_wheel_load[w + 1]);
      const std::vector<double> means = sliding_means(
          runs_[r], [&](const StepRecord& step) { return kN * (step.wheels[w].Y + step.wheels[w + 1].Y); });
      LiveSeries line{.label = label(r, fmt::format("wheelset {}", w / 2 + 1)),
                      .offset = header.wheel_x[w],
                      .shown = at_first(r, w) || at_first(r, w + 1)};
      line.history = store_.add(means, detail(line.shown));
      add_line(chart, r, std::move(line), means);
    }
  }
  if (lightest < std::numeric_limits<double>::infinity()) {
    const double limit = 10.0 + kN * lightest / 3.0;
    chart.limits = {{limit, fmt::format("{:.1f} kN – EN 14363: 10 kN + P0/3", limit)}};
  }
  chart.marks = bridge();
  return chart_html(chart);
}

/// Low-passed as the limit is meant; not of records too far apart for it.
std::string RunCharts::filtered_unloading() {
  constexpr double cut_off = 20.0;  // Hz
  Chart chart = chart_over(Over::position, "Wheel unloading ΔQ/Q0, low-passed at 20 Hz",
                           "Share of the static wheel load that is missing in the force below 20 Hz, filtered without "
                           "phase; 1 is lift-off.",
                           "ΔQ/Q0 [–]");
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const ResultHeader& header = runs_[r].header;
    const std::optional<double> spacing = even_spacing(runs_[r]);
    if (!spacing || !samples_fast_enough(cut_off, *spacing)) continue;
    for (std::size_t w = 0; w < header.wheel_x.size(); ++w) {
      const double load = header.static_wheel_load[w];
      if (!(load > 0.0)) continue;
      const std::vector<double> filtered = low_passed(
          values(r, [&](const StepRecord& step) { return 1.0 - step.wheels[w].Q / load; }), cut_off, *spacing);
      LiveSeries line{.label = label(r, wheel_name(w)), .offset = header.wheel_x[w], .shown = at_first(r, w)};
      line.history = store_.add(filtered, detail(line.shown));
      add_line(chart, r, std::move(line), filtered);
    }
  }
  chart.limits = {{0.6, "0.6 – EN 14363"}};
  chart.marks = bridge();
  return chart_html(chart);
}

std::string RunCharts::unloading() {
  Chart chart = chart_over(Over::position, "Wheel unloading ΔQ/Q0, unfiltered",
                           "Share of the static wheel load that is missing; 1 is lift-off.", "ΔQ/Q0 [–]");
  add_of_Q(chart, [](double load) { return load > 0.0 ? Linear{-1.0 / load, 1.0} : Linear{gap, gap}; });
  if (runs_.size() == 1) {
    add_band(
        runs_[0], [](const WheelRecord& wheel, double load) { return load > 0.0 ? 1.0 - wheel.Q / load : gap; }, chart);
  }
  chart.marks = bridge();
  return chart_html(chart);
}

std::string RunCharts::running_safety() {
  Chart raw = chart_over(Over::position, "Derailment coefficient Y/Q, unfiltered",
                         "Amount of Y over Q while the wheel is in contact.", "|Y|/Q [–]");
  const auto quotient = [](const WheelRecord& wheel) { return wheel.Q > 0 ? std::abs(wheel.Y) / wheel.Q : gap; };
  add_wheels(raw, quotient);
  if (runs_.size() == 1)
    add_band(
        runs_[0], [&](const WheelRecord& wheel, double) { return quotient(wheel); }, raw);
  raw.marks = bridge();
  return quotient_mean() + track_shift() + filtered_unloading() + unloading() + chart_html(raw);
}

/// Of many bodies or nodes the first, the last and those that move most are shown at first.
void RunCharts::add_motions(Chart& chart, std::size_t run, const std::vector<std::size_t>& members,
                            const std::function<double(const StepRecord&, std::size_t)>& value,
                            const std::function<std::string(std::size_t)>& name) {
  const std::size_t most_shown = std::max<std::size_t>(1, 4 / runs_.size());
  std::vector<std::vector<double>> all;
  std::vector<std::pair<double, std::size_t>> order;
  for (const std::size_t i : members) {
    all.push_back(values(run, [&](const StepRecord& step) { return value(step, i); }));
    const bool end = all.size() == 1 || all.size() == members.size();
    const double first = end && most_shown > 2 ? std::numeric_limits<double>::infinity() : largest_amount(all.back());
    order.emplace_back(-first, order.size());
  }
  std::sort(order.begin(), order.end());
  std::vector<bool> shown(members.size(), false);
  for (std::size_t k = 0; k < std::min(most_shown, order.size()); ++k) shown[order[k].second] = true;
  for (std::size_t k = 0; k < members.size(); ++k) {
    LiveSeries line{.label = label(run, name(members[k])), .shown = shown[k]};
    line.history = store_.add(all[k], detail(shown[k]));
    add_line(chart, run, std::move(line), all[k]);
  }
}

std::string RunCharts::car_bodies() {
  Chart up = chart_over(Over::time, "Vertical car-body acceleration",
                        "At the centre of gravity, positive down, unfiltered.", "a_z [m/s²]");
  Chart side = chart_over(Over::time, "Lateral car-body acceleration",
                          "At the centre of gravity, positive to the right, unfiltered.", "a_y [m/s²]");
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::vector<std::string>& names = runs_[r].header.body_names;
    const std::vector<std::size_t> bodies = indices(names, is_car_body);
    for (const auto& [chart, direction] : {std::pair{&up, z_dof}, std::pair{&side, y_dof}}) {
      add_motions(
          *chart, r, bodies,
          [k = direction](const StepRecord& step, std::size_t i) { return step.bodies[i].acceleration[k]; },
          [&](std::size_t i) { return vehicle_of(names[i]); });
    }
  }
  up.marks = side.marks = passage();
  return chart_html(up) + chart_html(side);
}

std::string RunCharts::structure() {
  Chart acceleration =
      chart_over(Over::time, "Deck acceleration", "Vertical, positive down, unfiltered.", "a_z [m/s²]");
  Chart displacement = chart_over(Over::time, "Deck displacement", "Vertical, positive down.", "z [mm]");
  Chart rail = chart_over(Over::time, "Rail displacement", "Vertical, positive down.", "z [mm]");
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const ResultHeader& header = runs_[r].header;
    const std::vector<std::size_t> deck = indices(header.node_names, is_deck);
    const std::vector<std::size_t> others =
        indices(header.node_names, [](const std::string& name) { return !is_deck(name); });
    const auto name = [&](std::size_t i) {
      return fmt::format("{} (x = {:.1f} m)", header.node_names[i], header.node_x[i]);
    };
    const auto moved = [](const StepRecord& step, std::size_t i) { return mm * step.nodes[i].displacement[z_dof]; };
    add_motions(
        acceleration, r, deck, [](const StepRecord& step, std::size_t i) { return step.nodes[i].acceleration[z_dof]; },
        name);
    add_motions(displacement, r, deck, moved, name);
    add_motions(rail, r, others, moved, name);
  }
  acceleration.marks = displacement.marks = rail.marks = passage();
  return chart_html(acceleration) + chart_html(displacement) + deck_envelope() + deck_charts(runs_, names_, bridge()) +
         chart_html(rail);
}

/// Largest and smallest displacement of the deck's recorded nodes over x.
std::string RunCharts::deck_envelope() const {
  Chart chart;
  chart.title = "Deck displacement, envelope";
  chart.note = "Largest and smallest vertical displacement of every recorded node, positive down.";
  chart.x_label = "position along the track [m]";
  chart.y_label = "z [mm]";
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (has_deck_extremes(runs_[r])) continue;  // deck_charts() shows all nodes
    const ResultHeader& header = runs_[r].header;
    std::map<double, std::pair<double, double>> extremes;
    for (const std::size_t i : indices(header.node_names, is_deck)) {
      auto& [low, high] = extremes.try_emplace(header.node_x[i], 0.0, 0.0).first->second;
      for (const StepRecord& step : runs_[r].steps) {
        low = std::min(low, mm * step.nodes[i].displacement[z_dof]);
        high = std::max(high, mm * step.nodes[i].displacement[z_dof]);
      }
    }
    constexpr std::size_t fewest = 3;  // else the histories say it all
    if (extremes.size() < fewest) continue;
    Series largest{label(r, "largest"), {}, {}}, smallest{label(r, "smallest"), {}, {}};
    for (const auto& [x, extreme] : extremes) {
      smallest.x.push_back(x);
      smallest.y.push_back(extreme.first);
      largest.x.push_back(x);
      largest.y.push_back(extreme.second);
    }
    chart.series.push_back(std::move(largest));
    chart.series.push_back(std::move(smallest));
  }
  chart.marks = bridge();
  return chart_html(chart);
}

/// The bridge's spans.
std::vector<Mark> RunCharts::bridge() const {
  const ResultHeader& header = runs_[0].header;
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < header.span_from.size(); ++i) {
    marks.push_back({header.span_from[i], header.span_to[i],
                     header.span_from.size() == 1 ? "bridge" : fmt::format("{} spans", header.span_from.size())});
  }
  return marks;
}

/// When the train is on the bridge.
std::vector<Mark> RunCharts::passage() const {
  const RunResults& run = runs_[0];
  if (runs_.size() > 1 || run.header.span_from.empty() || run.header.wheel_x.empty()) return {};
  const double begin = *std::min_element(run.header.span_from.begin(), run.header.span_from.end());
  const double end = *std::max_element(run.header.span_to.begin(), run.header.span_to.end());
  const double rear = *std::min_element(run.header.wheel_x.begin(), run.header.wheel_x.end());
  double from = gap, to = gap;
  for (const StepRecord& step : run.steps) {
    if (step.position < begin || step.position + rear > end) continue;
    if (std::isnan(from)) from = step.time;
    to = step.time;
  }
  return std::isnan(from) ? std::vector<Mark>{} : std::vector<Mark>{{from, to, "train on the bridge"}};
}

}  // namespace railtab::report
