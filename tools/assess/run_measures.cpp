#include "run_measures.hpp"

#include "headline.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "run_judge.hpp"

namespace railtab::assess {
namespace {

/// Series of the deck's node and of the wheel with the largest values.
class SeriesFinder : public RunJudge {
 public:
  using RunJudge::RunJudge;

  void deck_series(RunSeries& result) const {
    if (!samples_fast_enough(window_.deck_cut_off, step_)) return;
    double largest = -1.0;
    for (std::size_t i = 0; i < header_.node_names.size(); ++i) {
      if (!is_deck(header_.node_names[i])) continue;
      Series raw = of_records([&](const StepRecord& r) { return r.nodes[i].acceleration[vertical]; });
      Series smooth = low_passed(raw, window_.deck_cut_off, step_);
      double peak = 0.0;
      for (const double a : smooth) peak = std::max(peak, std::abs(a));
      if (!(peak > largest)) continue;
      largest = peak;
      result.node = header_.node_names[i];
      result.time = of_records([](const StepRecord& r) { return r.time; });
      result.acceleration = std::move(raw);
      result.filtered_acceleration = std::move(smooth);
    }
  }

  void wheel_series(RunSeries& result) const {
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

RunSeries run_series(const RunResults& results, const RunWindow& window) {
  RunSeries series;
  if (count_even_records(results) < 2) return series;
  RunMeasures unused;
  const SeriesFinder finder(results, window, unused);
  finder.deck_series(series);
  finder.wheel_series(series);
  return series;
}

}  // namespace railtab::assess
