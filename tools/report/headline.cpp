#include "headline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/drawing/body_names.hpp"

namespace railtab::report {
namespace {

void raise(Extreme& extreme, double value, double time, const std::string& where) {
  if (!extreme.found() || value > extreme.value) extreme = {value, time, where};
}

/// Behind the first wheelset; 0 where an older file does not say.
double offset(const std::vector<double>& offsets, std::size_t i) { return i < offsets.size() ? offsets[i] : 0.0; }

/// Rigid wheels have none, nor a profile.
bool has_lateral_forces(const ResultHeader& header) { return !header.wheel_y.empty(); }

/// Of all nodes and steps, where the run has followed them.
void add_deck_extremes(const ResultHeader& header, const RunSummary& summary, Headline& headline) {
  if (summary.deck.empty()) return;
  for (const auto& [name, which] : {std::pair{"acceleration", &Headline::deck_acceleration},
                                    std::pair{"displacement", &Headline::deck_displacement}}) {
    const auto places = std::ranges::find(header.deck, name, &DeckPlaces::quantity);
    if (places == header.deck.end()) continue;
    const DeckExtremes& extremes = summary.deck[static_cast<std::size_t>(places - header.deck.begin())];
    Extreme& extreme = headline.*which;
    extreme = {};
    for (std::size_t i = 0; i < places->x.size(); ++i) {
      const std::string where = fmt::format("deck, x = {:.1f} m", places->x[i]);
      raise(extreme, std::abs(extremes.smallest[i]), extremes.smallest_time[i], where);
      raise(extreme, std::abs(extremes.largest[i]), extremes.largest_time[i], where);
    }
  }
}

}  // namespace

Headline headline_of(const RunResults& results) {
  HeadlineCollector collector(results.header);
  for (const StepRecord& step : results.steps) collector.add(step);
  return collector.result(results.summary);
}

std::string uncovered_queries(const RunSummary& summary) {
  if (summary.contact_mode != "table" || 5 * summary.table_queries >= 4 * summary.contact_queries) return "";
  return fmt::format(
      "the table served {:.1f} % of the contact queries, the online search the rest; does it cover the run's roll, yaw "
      "and lateral shift (tablegen info; tablegen geometry --roll), and are measured profiles smooth enough "
      "(--smoothing)?",
      100.0 * static_cast<double>(summary.table_queries) / static_cast<double>(summary.contact_queries));
}

std::string extent_of_extremes(const ResultHeader& header, const RunSummary& summary) {
  std::string text = "the recorded steps";
  if (summary.wheel_extremes.largest_Q.found()) {
    text += has_lateral_forces(header) ? "; Q, Y/Q and unloading of all steps" : "; Q and unloading of all steps";
  }
  if (header.judged.empty()) return text;
  text += "; wheels and car bodies";
  if (header.judged[0] > -off_the_line) text += fmt::format(" from x = {:g} m", header.judged[0]);
  if (header.judged[1] < off_the_line) text += fmt::format(" to x = {:g} m", header.judged[1]);
  return text;
}

std::string wheel_name(std::size_t wheel) {
  return fmt::format("wheelset {} {}", wheel / 2 + 1, wheel % 2 == 0 ? "left" : "right");
}

std::string vehicle_of(const std::string& body_name) { return body_name.substr(0, body_name.find('/')); }

HeadlineCollector::HeadlineCollector(const ResultHeader& header) : header_(header) {
  constexpr double averaged = 2.0;  // m
  const std::size_t wheels = header.static_wheel_load.size();
  for (std::size_t i = 0; i < wheels; ++i) wheel_names_.push_back(wheel_name(i));
  for (std::size_t i = 0; i < wheels / 2; ++i) wheelset_names_.push_back(fmt::format("wheelset {}", i + 1));
  for (std::size_t i = 0; i < header.body_names.size(); ++i) {
    if (is_car_body(header.body_names[i])) car_bodies_.push_back({i, vehicle_of(header.body_names[i])});
  }
  for (std::size_t i = 0; i < header.node_names.size(); ++i) {
    if (is_deck(header.node_names[i])) deck_.push_back({i, header.node_names[i]});
  }
  quotient_.assign(wheels, TrackMean(averaged));
  shift_.assign(wheels / 2, TrackMean(averaged));
}

void HeadlineCollector::add_sliding_means(const StepRecord& step) {
  if (!has_lateral_forces(header_)) return;
  for (std::size_t i = 0; i < step.wheels.size(); ++i) {
    const WheelRecord& wheel = step.wheels[i];
    if (!is_judged(header_.judged, step.position + offset(header_.wheel_x, i))) continue;
    if (wheel.Q > 0.0) {
      const auto mean = quotient_[i].add(step.position, wheel.Y / wheel.Q);
      if (mean) raise(headline_.derailment_2m, std::abs(*mean), step.time, wheel_names_[i]);
    }
    if (i % 2 == 0) continue;
    const auto mean = shift_[i / 2].add(step.position, step.wheels[i - 1].Y + wheel.Y);
    if (mean) raise(headline_.track_shift_2m, std::abs(*mean), step.time, wheelset_names_[i / 2]);
  }
}

void HeadlineCollector::add(const StepRecord& step) {
  assert(step.bodies.size() == header_.body_names.size() && step.nodes.size() == header_.node_names.size());
  constexpr double sparse = 0.5;  // m: fewer than five records in 2 m are no mean over them
  if (!any_) first_position_ = step.position;
  if (any_ && step.position - last_position_ > sparse) sparse_ = true;
  any_ = true;
  last_position_ = step.position;
  headline_.simulated_time = step.time;
  for (std::size_t i = 0; i < step.wheels.size(); ++i) {
    const WheelRecord& wheel = step.wheels[i];
    if (!is_judged(header_.judged, step.position + offset(header_.wheel_x, i))) continue;
    recorded_.add(step.time, static_cast<int>(i), wheel.Y, wheel.Q, header_.static_wheel_load[i]);
  }
  add_sliding_means(step);
  for (const auto& [i, vehicle] : car_bodies_) {
    if (!is_judged(header_.judged, step.position + offset(header_.body_x, i))) continue;
    const MotionRecord& body = step.bodies[i];
    raise(headline_.car_body_vertical, std::abs(body.acceleration[z_dof]), step.time, vehicle);
    raise(headline_.car_body_lateral, std::abs(body.acceleration[y_dof]), step.time, vehicle);
  }
  for (const auto& [i, name] : deck_) {
    const MotionRecord& node = step.nodes[i];
    raise(headline_.deck_acceleration, std::abs(node.acceleration[z_dof]), step.time, name);
    raise(headline_.deck_displacement, std::abs(node.displacement[z_dof]), step.time, name);
  }
}

Headline HeadlineCollector::result(const RunSummary& summary) const {
  Headline result = headline_;
  const auto of_wheels = [&](WheelExtreme WheelExtremes::*which) -> Extreme {
    const WheelExtreme& of_all_steps = summary.wheel_extremes.*which;
    const WheelExtreme& extreme = of_all_steps.found() ? of_all_steps : recorded_.*which;
    if (!extreme.found()) return {};
    return {extreme.value, extreme.time, wheel_names_.at(static_cast<std::size_t>(extreme.wheel))};
  };
  result.largest_Q = of_wheels(&WheelExtremes::largest_Q);
  result.smallest_Q = of_wheels(&WheelExtremes::smallest_Q);
  if (has_lateral_forces(header_)) result.derailment = of_wheels(&WheelExtremes::derailment);
  result.unloading = of_wheels(&WheelExtremes::unloading);
  result.extent = extent_of_extremes(header_, summary);
  add_deck_extremes(header_, summary, result);
  result.distance = last_position_ - first_position_;
  if (result.car_body_lateral.value == 0.0) result.car_body_lateral = {};  // none moves laterally
  if (sparse_) result.derailment_2m = result.track_shift_2m = {};
  if (summary.contact_queries > 0) {
    result.table_share = static_cast<double>(summary.table_queries) / static_cast<double>(summary.contact_queries);
  }
  if (summary.complete && summary.message.empty() && summary.seconds_total > 0.0) {
    result.real_time_factor = result.simulated_time / summary.seconds_total;
  }
  return result;
}

}  // namespace railtab::report
