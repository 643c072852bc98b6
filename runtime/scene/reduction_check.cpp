#include "railtab/runtime/scene/reduction_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/measures/dynamic_difference.hpp"
#include "railtab/runtime/scene/timed_model.hpp"

namespace railtab {

namespace {

struct Difference {
  double max = 0.0, square = 0.0;
  long count = 0;
  void add(double value) {
    max = std::max(max, std::abs(value));
    square += value * value;
    ++count;
  }
  [[nodiscard]] double rms() const { return count > 0 ? std::sqrt(square / static_cast<double>(count)) : 0.0; }
};

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

double rms_of_dynamic(const std::vector<std::vector<float>>& reduced, const std::vector<std::vector<float>>& whole) {
  const DynamicDifference of = dynamic_difference(whole, reduced);
  return ratio(std::sqrt(of.square), std::sqrt(of.dynamic_square));
}

ComparedHistory history_of(const SceneParameters& scene, const TimedModel& timed, double duration) {
  SceneParameters stretch = scene;
  stretch.integration.duration = duration;
  stretch.output = {};
  ComparedHistory history;
  std::vector<std::size_t> deck;
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) {
    history.static_load = header.static_wheel_load;
    for (std::size_t n = 0; n < header.node_names.size(); ++n) {
      if (is_deck(header.node_names[n])) deck.push_back(n);
    }
  };
  observer.record = [&](const StepRecord& record) {
    std::vector<float>& force = history.force.emplace_back();
    std::vector<float>& lateral = history.lateral.emplace_back();
    for (const WheelRecord& wheel : record.wheels) {
      force.push_back(static_cast<float>(wheel.Q));
      lateral.push_back(static_cast<float>(wheel.Y));
    }
    std::vector<float>& acceleration = history.deck.emplace_back();
    for (std::size_t n : deck) acceleration.push_back(static_cast<float>(record.nodes[n].acceleration[2]));
  };
  std::clock_t begin = std::clock();
  observer.ready = [&] { begin = std::clock(); };
  history.summary = timed.counted(run_scene(stretch, timed.model(), observer));
  history.seconds_steps = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!history.summary.complete) {
    throw ComputationError(fmt::format("comparison with reduction \"{}\": {}", reduction_name(scene.reduction.kind),
                                       history.summary.message));
  }
  return history;
}

}  // namespace

ComparedHistory compared_history(const SceneParameters& scene, double duration) {
  SceneParameters stretch = scene;
  stretch.integration.duration = duration;
  return history_of(scene, TimedModel(stretch), duration);
}

ReductionError compare(const ComparedHistory& reduced, const ComparedHistory& whole) {
  ReductionError error;
  error.reduced = reduced.summary;
  error.whole = whole.summary;
  Difference force, deck;
  double dynamic = 0.0, largest_load = 0.0, largest_acceleration = 0.0, peak = 0.0, peak_reduced = 0.0,
         peak_acceleration = 0.0;
  for (std::size_t step = 0; step < std::min(whole.force.size(), reduced.force.size()); ++step) {
    for (std::size_t w = 0; w < whole.static_load.size(); ++w) {
      const double Q = whole.force[step][w], other = reduced.force[step][w];
      force.add(other - Q);
      dynamic = std::max(dynamic, std::abs(Q - whole.static_load[w]));
      largest_load = std::max(largest_load, whole.static_load[w]);
      peak = std::max(peak, Q);
      peak_reduced = std::max(peak_reduced, other);
    }
    for (std::size_t n = 0; n < whole.deck[step].size(); ++n) {
      const double a = whole.deck[step][n], other = reduced.deck[step][n];
      deck.add(other - a);
      largest_acceleration = std::max(largest_acceleration, std::abs(a));
      peak_acceleration = std::max(peak_acceleration, std::abs(other));
    }
  }
  error.dynamic_force = dynamic;
  error.deck_acceleration = largest_acceleration;
  error.force_max = ratio(force.max, dynamic);
  error.force_rms = ratio(force.rms(), dynamic);
  error.force_static = ratio(force.max, largest_load);
  error.deck_max = ratio(deck.max, largest_acceleration);
  error.deck_rms = ratio(deck.rms(), largest_acceleration);
  error.rms_Q = rms_of_dynamic(reduced.force, whole.force);
  error.rms_Y = rms_of_dynamic(reduced.lateral, whole.lateral);
  error.rms_deck = rms_of_dynamic(reduced.deck, whole.deck);
  error.peak_force = ratio(std::abs(peak_reduced - peak), peak);
  error.peak_deck = ratio(std::abs(peak_acceleration - largest_acceleration), largest_acceleration);
  return error;
}

ReductionError check_reduction(const SceneParameters& scene, double duration) {
  SceneParameters none = scene;
  none.reduction.kind = Reduction::none;
  ComparedHistory whole;
  {
    const TimedModel timed(none);  // gone before the reduced one comes
    if (const double all = run_duration(scene, timed.model()); duration > all) {
      throw input_error("time to compare", fmt::format("{} s", duration),
                        fmt::format("at most {:.6g} s, the scene's duration", all));
    }
    whole = history_of(none, timed, duration);
  }
  ReductionError error = compare(compared_history(scene, duration), whole);
  error.duration = duration;
  return error;
}

}  // namespace railtab
