#include "assessment_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "over_speed.hpp"
#include "railtab/runtime/report/chart.hpp"

namespace railtab::assess {
namespace {

using Quantity = DeckPeak PassagePeaks::*;

report::Series curve(const std::string& label, const TrainResponse& response, Quantity quantity, double factor) {
  report::Series series{label, {}, {}};
  for (const PassagePeaks& p : response.passages) {
    series.x.push_back(3.6 * p.speed);
    series.y.push_back(factor * (p.*quantity).value);
  }
  return series;
}

/// Between the speeds computed along the straight line, 0 beyond them.
double value_at(const TrainResponse& response, Quantity quantity, double speed) {
  const std::vector<PassagePeaks>& passages = response.passages;
  const auto above = std::ranges::lower_bound(passages, speed, {}, &PassagePeaks::speed);
  if (above == passages.end()) return 0.0;
  const double value = ((*above).*quantity).value;
  if (above->speed == speed) return value;
  if (above == passages.begin()) return 0.0;
  const PassagePeaks& below = *(above - 1);
  const double share = (speed - below.speed) / (above->speed - below.speed);
  return (1.0 - share) * (below.*quantity).value + share * value;
}

/// From zero to the largest value of all trains.
report::Band all_trains(const DeckAssessment& deck, Quantity quantity, double factor) {
  std::set<double> speeds;
  for (const TrainResponse& response : deck.responses) {
    for (const PassagePeaks& p : response.passages) speeds.insert(p.speed);
  }
  report::Band band{"all trains", {}, std::vector<double>(speeds.size(), 0.0), {}};
  for (const double speed : speeds) {
    double most = 0.0;
    for (const TrainResponse& response : deck.responses) most = std::max(most, value_at(response, quantity, speed));
    band.x.push_back(3.6 * speed);
    band.high.push_back(factor * most);
  }
  return band;
}

double largest(const TrainResponse& response, Quantity quantity) {
  double value = 0.0;
  for (const PassagePeaks& p : response.passages) value = std::max(value, (p.*quantity).value);
  return value;
}

/// The three trains with the largest values, the last of the list (the scene's own train) always among them.
std::vector<const TrainResponse*> shown_trains(const DeckAssessment& deck, Quantity quantity) {
  std::vector<const TrainResponse*> list;
  for (const TrainResponse& response : deck.responses) {
    if (!response.passages.empty()) list.push_back(&response);
  }
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto* a, const auto* b) { return largest(*a, quantity) > largest(*b, quantity); });
  constexpr std::size_t most = 4;
  if (list.size() <= most) return list;
  const std::size_t own = deck.trains.size() - 1;
  const bool own_there = std::any_of(list.begin(), list.begin() + most, [&](const auto* r) { return r->train == own; });
  const auto own_at = std::find_if(list.begin(), list.end(), [&](const auto* r) { return r->train == own; });
  if (!own_there && own_at != list.end()) std::iter_swap(list.begin() + most - 1, own_at);
  list.resize(most);
  return list;
}

std::string deck_curves(const Assessment& assessment, const DeckAssessment& deck) {
  struct Shown {
    const PassageMeasure* measure;
    const char *title, *label;
    double factor;
  };
  std::string html;
  for (const auto& [measure, title, label, factor] : {Shown{&passage_measures[0], "largest acceleration", "m/s²", 1.0},
                                                      Shown{&passage_measures[1], "largest displacement", "mm", 1e3}}) {
    report::Chart chart;
    chart.title = fmt::format("{}: {} over the speed of moving loads", deck.deck.name, title);
    chart.note =
        "Anywhere on the deck, each train by itself: the largest of all trains as an area, those with the largest "
        "values and the scene's own train as lines.";
    const std::vector<MeasuredValue> largest = largest_of_passages(deck, *measure);
    const auto most = std::ranges::max_element(largest, {}, &MeasuredValue::value);
    if (most != largest.end()) {
      chart.note += fmt::format(" Largest of all: {}, {}.",
                                amount_in_words(most->value, find_measure(most->measure)->unit), place_in_words(*most));
    }
    chart.x_label = "speed [km/h]";
    chart.y_label = label;
    if (deck.responses.size() > 1) chart.bands.push_back(all_trains(deck, measure->peak, factor));
    for (const TrainResponse* response : shown_trains(deck, measure->peak)) {
      chart.series.push_back(curve(deck.trains[response->train].name, *response, measure->peak, factor));
    }
    for (const Verdict& v : assessment.verdicts) {
      if (v.at && v.stage == AssessmentStage::moving_load && v.clause->measure == measure->measure) {
        chart.limits.push_back({factor * v.limit, fmt::format("{}, {}", v.clause->edition, v.clause->clause)});
      }
    }
    html += chart_html(chart);
  }
  return html;
}

/// Limits that a measure of runs is judged by.
std::vector<report::Limit> limits_of_runs(const Assessment& assessment, std::string_view measure, double factor) {
  std::vector<report::Limit> limits;
  for (const Verdict& v : assessment.verdicts) {
    if (!v.at || v.stage != AssessmentStage::contact || v.clause->measure != measure) continue;
    limits.push_back({factor * v.limit, fmt::format("{}, {}", v.clause->edition, v.clause->clause)});
  }
  return limits;
}

std::string wheel_chart(const Assessment& assessment) {
  const WheelSeries& s = assessment.wheel;
  report::Chart chart;
  chart.title = fmt::format("Unloading ΔQ/Q0 of {}, run {}", s.wheel, assessment.wheel_run);
  chart.note =
      "Over the wheel's own position; 1 is lift-off. What stands before the place where judging begins does not count.";
  chart.x_label = "x [m]";
  chart.y_label = "ΔQ/Q0";
  chart.series = {{"unfiltered", s.position, s.unloading},
                  {fmt::format("low-pass {:g} Hz", assessment.window.wheel_cut_off), s.position, s.filtered_unloading}};
  chart.limits = limits_of_runs(assessment, "wheel_unloading", 1.0);
  return chart_html(chart);
}

/// An amount has its limit above and below zero.
std::vector<report::Limit> both_sides(std::vector<report::Limit> limits) {
  for (std::size_t i = 0, count = limits.size(); i < count; ++i) limits.push_back({-limits[i].value, ""});
  return limits;
}

/// How a deck's measure is drawn.
struct DeckDrawing {
  std::string quantity, judged;  ///< "acceleration" and how that is judged
  std::string_view label, unit;
  double factor;
};

DeckDrawing drawing_of(const Assessment& assessment, const DeckSeries& s) {
  if (s.governing.measure == "deck_displacement") return {"displacement", "displacement", "z [mm]", "m", 1e3};
  return {"acceleration", fmt::format("low-pass {:.4g} Hz", assessment.window.deck_cut_off), "a_z [m/s²]", "m/s2", 1.0};
}

std::vector<double> times(double factor, std::vector<double> values) {
  for (double& value : values) value *= factor;
  return values;
}

std::string governing_in_words(const DeckSeries& s, const DeckDrawing& drawing) {
  return fmt::format("{} at t = {:.3f} s", amount_in_words(s.governing.value, drawing.unit),
                     s.governing.time.value_or(0.0));
}

/// The extremes along the deck, and which node governs.
std::string envelope_chart(const Assessment& assessment, const DeckSeries& s) {
  if (s.envelope.x.empty() || !s.governing.x) return "";
  const DeckDrawing drawing = drawing_of(assessment, s);
  const double x = *s.governing.x;
  const auto at = std::ranges::find(s.envelope.x, x) - s.envelope.x.begin();
  const std::vector<double> smallest = times(drawing.factor, s.envelope.smallest),
                            largest = times(drawing.factor, s.envelope.largest);
  report::Chart chart;
  chart.title = fmt::format("Vertical {} along the deck, run {}", drawing.quantity, s.governing.run);
  chart.note =
      fmt::format("Largest and smallest of all nodes and steps{}, positive down. The node that governs: {}, {}.",
                  drawing.judged == drawing.quantity ? "" : ", " + drawing.judged, position_in_words(x, s.governing.y),
                  governing_in_words(s, drawing));
  chart.x_label = "x [m]";
  chart.y_label = drawing.label;
  chart.series = {{"largest", s.envelope.x, largest}, {"smallest", s.envelope.x, smallest}};
  if (at < static_cast<std::ptrdiff_t>(s.envelope.x.size())) {
    const auto i = static_cast<std::size_t>(at);
    chart.series.push_back(
        {"node that governs, " + position_in_words(x, s.governing.y), {x, x}, {smallest[i], largest[i]}});
  }
  chart.limits = both_sides(limits_of_runs(assessment, s.governing.measure, drawing.factor));
  return chart_html(chart);
}

/// The history of the node that governs, or of the recorded node nearest to it.
std::string node_chart(const Assessment& assessment, const DeckSeries& s) {
  if (s.node.empty()) return "";
  const DeckDrawing drawing = drawing_of(assessment, s);
  double most = 0.0;
  for (const double value : s.judged) most = std::max(most, std::abs(value));
  report::Chart chart;
  chart.title = fmt::format("Vertical {} of {} ({}), run {}", drawing.quantity, s.node,
                            position_in_words(s.node_x, s.node_y), s.governing.run);
  chart.note = s.node_governs
                   ? fmt::format("The node that governs, {}; positive down.", governing_in_words(s, drawing))
                   : fmt::format(
                         "The recorded node nearest to the one that governs ({}, {}), whose history is not "
                         "recorded; this one reaches {}. Positive down.",
                         position_in_words(s.governing.x.value_or(0.0), s.governing.y), governing_in_words(s, drawing),
                         s.judged.empty() ? "an unknown value" : amount_in_words(most, drawing.unit));
  chart.x_label = "time [s]";
  chart.y_label = drawing.label;
  if (!s.unfiltered.empty()) chart.series.push_back({"unfiltered", s.time, s.unfiltered});
  if (!s.judged.empty()) chart.series.push_back({drawing.judged, s.time, times(drawing.factor, s.judged)});
  chart.limits = both_sides(limits_of_runs(assessment, s.governing.measure, drawing.factor));
  return chart_html(chart);
}

}  // namespace

std::string resonance_charts(const Assessment& assessment) {
  std::string html;
  for (const DeckAssessment& deck : assessment.decks) {
    if (!deck.responses.empty()) html += deck_curves(assessment, deck);
  }
  return html;
}

std::string run_charts(const Assessment& assessment) {
  std::string html = assessment.wheel.wheel.empty() ? "" : wheel_chart(assessment);
  for (const DeckSeries& s : assessment.deck_series) {
    html += envelope_chart(assessment, s) + node_chart(assessment, s);
  }
  return html;
}

}  // namespace railtab::assess
