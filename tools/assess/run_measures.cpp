#include "run_measures.hpp"

#include <cmath>

#include "headline.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "run_judge.hpp"

namespace railtab::assess {
namespace {

/// Series of the deck's node that governs and of the wheel with the largest values.
class SeriesFinder : public RunJudge {
 public:
  using RunJudge::RunJudge;

  void deck_series(DeckSeries& result) const {
    constexpr double same = 1e-6;  // [m]
    const MeasuredValue& governing = result.governing;
    std::optional<std::size_t> nearest;
    double least = 0.0;
    for (std::size_t i = 0; i < header_.node_names.size(); ++i) {
      if (!is_deck(header_.node_names[i])) continue;
      const double off = header_.node_names[i] == governing.where ? -1.0 : distance(i, governing);
      if (nearest && !(off < least)) continue;
      nearest = i;
      least = off;
    }
    if (!nearest) return;
    const std::size_t node = *nearest;
    result.node = header_.node_names[node];
    result.node_x = header_.node_x[node];
    if (governing.y && node < header_.node_y.size()) result.node_y = header_.node_y[node];
    result.node_governs = least < same;
    result.time = of_records([](const StepRecord& r) { return r.time; });
    if (governing.measure == "deck_displacement") {
      result.judged = of_records([&](const StepRecord& r) { return r.nodes[node].displacement[vertical]; });
      return;
    }
    result.unfiltered = of_records([&](const StepRecord& r) { return r.nodes[node].acceleration[vertical]; });
    if (samples_fast_enough(window_.deck_cut_off, step_)) {
      result.judged = low_passed(result.unfiltered, window_.deck_cut_off, step_);
    }
  }

  void wheel_series(WheelSeries& result) const {
    if (at(0).wheels.empty() || !samples_fast_enough(window_.wheel_cut_off, step_)) return;
    double largest = -1e300;
    for (std::size_t w = 0; w < header_.static_wheel_load.size(); ++w) {
      const double Q0 = header_.static_wheel_load[w];
      Series raw = of_records([&](const StepRecord& r) { return (Q0 - r.wheels[w].Q) / Q0; });
      Series smooth = low_passed(raw, window_.wheel_cut_off, step_);
      double peak = -1e300;
      for (std::size_t k = 0; k < records_; ++k) {
        if (judged(wheel_position(w, k))) peak = std::max(peak, smooth[k]);
      }
      if (!(peak > largest)) continue;
      largest = peak;
      result.wheel = report::wheel_name(w);
      result.position = of_records([&](const StepRecord& r) { return r.position + header_.wheel_x[w]; });
      result.unloading = std::move(raw);
      result.filtered_unloading = std::move(smooth);
    }
  }

 private:
  /// Of a recorded node from a place on the deck; across the track where both are known [m].
  [[nodiscard]] double distance(std::size_t node, const MeasuredValue& place) const {
    const double along = header_.node_x[node] - place.x.value_or(0.0);
    const bool across = place.y && node < header_.node_y.size();
    return std::hypot(along, across ? header_.node_y[node] - *place.y : 0.0);
  }
};

}  // namespace

RunMeasures run_measures(const RunResults& results, const RunWindow& window) {
  RunMeasures found;
  if (count_even_records(results) < 2) {
    for (const MeasureKind& kind : measure_kinds()) {
      if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) == 0) continue;
      found.missing.push_back({std::string(kind.name), AssessmentStage::contact, "the run has no records", false});
    }
    return found;
  }
  measure_decks(results, window, found);
  measure_wheels(results, window, found);
  measure_car_bodies(results, window, found);
  return found;
}

WheelSeries wheel_series(const RunResults& results, const RunWindow& window) {
  WheelSeries series;
  if (count_even_records(results) < 2) return series;
  RunMeasures unused;
  SeriesFinder(results, window, unused).wheel_series(series);
  return series;
}

DeckSeries deck_series(const RunResults& results, const RunWindow& window, const MeasuredValue& governing) {
  DeckSeries series;
  series.governing = governing;
  series.envelope = report::deck_envelope(
      results, governing.measure == "deck_displacement" ? "displacement" : "filtered_acceleration");
  if (count_even_records(results) < 2) return series;
  RunMeasures unused;
  SeriesFinder(results, window, unused).deck_series(series);
  return series;
}

}  // namespace railtab::assess
