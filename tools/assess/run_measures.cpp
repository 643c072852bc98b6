#include "run_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "headline.hpp"
#include "railtab/runtime/measures/comfort.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/measures/running_safety.hpp"
#include "railtab/runtime/measures/section_percentiles.hpp"
#include "railtab/runtime/measures/track_mean.hpp"
#include "railtab/runtime/measures/weighting.hpp"

namespace railtab::assess {
namespace {

using Series = std::vector<double>;
constexpr int longitudinal = 0, lateral = 1, vertical = 2;  // of MotionRecord's six

/// The steepest place of a wheel profile between the flange tip and the field side, against the horizontal [rad], over
/// chords of a millimetre at least.
double flange_angle(const ResultHeader& header) {
  constexpr double chord = 1e-3;  // [m]
  const std::vector<double>&y = header.wheel_y, &z = header.wheel_z;
  const auto tip = std::max_element(z.begin(), z.end()) - z.begin();  // z down: the lowest point
  const double y_tip = y[static_cast<std::size_t>(tip)];
  double steepest = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (y[i] < y_tip) continue;
    std::size_t j = i + 1;
    while (j < y.size() && std::hypot(y[j] - y[i], z[j] - z[i]) < chord) ++j;
    if (j == y.size() || y[j] < y_tip) continue;
    steepest = std::max(steepest, std::atan2(std::abs(z[j] - z[i]), std::abs(y[j] - y[i])));
  }
  return steepest;
}

/// Measures that the envelope of a deck has, by quantity; the first three also its recorded nodes.
struct EnvelopeMeasure {
  std::string_view quantity, name;
};
constexpr std::array envelope_measures{EnvelopeMeasure{"filtered_acceleration", "deck_acceleration"},
                                       EnvelopeMeasure{"acceleration", "deck_acceleration_unfiltered"},
                                       EnvelopeMeasure{"displacement", "deck_displacement"},
                                       EnvelopeMeasure{"twist", "deck_twist"},
                                       EnvelopeMeasure{"end_rotation", "deck_end_rotation"},
                                       EnvelopeMeasure{"horizontal_rotation", "horizontal_rotation"},
                                       EnvelopeMeasure{"joint_step", "deck_joint_step"},
                                       EnvelopeMeasure{"joint_gap", "deck_joint_gap"}};
const std::vector<std::string> of_envelope{"deck_twist", "deck_end_rotation", "horizontal_rotation", "deck_joint_step",
                                           "deck_joint_gap"};

/// "x = 12.00 m, y = 2.20 m"; without y where all places have one.
std::string place_on_deck(const DeckPlaces& places, std::size_t i) {
  const bool one_line = std::ranges::all_of(places.y, [&](double y) { return y == places.y.front(); });
  return one_line ? fmt::format("x = {:.2f} m", places.x[i])
                  : fmt::format("x = {:.2f} m, y = {:.2f} m", places.x[i], places.y[i]);
}

/// Records at even times: the last step is recorded whatever the distance.
std::size_t even_records(const RunResults& results) {
  const std::vector<StepRecord>& steps = results.steps;
  if (steps.size() < 3) return steps.size();
  const double step = steps[1].time - steps[0].time, last = steps.back().time - steps[steps.size() - 2].time;
  return std::abs(last - step) > 1e-6 * step ? steps.size() - 1 : steps.size();
}

constexpr double averaged = 2.0, five_feet = 1.524;  // [m]
constexpr double car_body_cut_off = 6.0;             // [Hz]

/// Measures of car bodies, and why a run has none of them.
struct BodyMeasure {
  std::string_view name, otherwise;
};
constexpr std::string_view too_short = "no car body is judged for as long as 5 s";
constexpr std::array body_measures{
    BodyMeasure{"car_body_vertical", "no car body is judged"},
    BodyMeasure{"car_body_lateral", "no car body is judged"},
    BodyMeasure{"car_body_vertical_6hz", "no car body is judged, or records are too far apart"},
    BodyMeasure{"car_body_lateral_6hz", "no car body is judged, or records are too far apart"},
    BodyMeasure{"comfort_vertical", too_short},
    BodyMeasure{"comfort_lateral", too_short},
    BodyMeasure{"comfort_longitudinal", "car bodies have no longitudinal acceleration, or none for as long as 5 s"},
    BodyMeasure{"mean_comfort", "no car body is judged for as long as 5 minutes, 60 windows of 5 s"},
    BodyMeasure{"running_rms_vertical", "no car body is judged for as long as 1 s"},
    BodyMeasure{"running_rms_lateral", "no car body is judged for as long as 1 s, or none moves laterally"},
    BodyMeasure{"vibration_dose_vertical", "no car body is judged"},
    BodyMeasure{"vibration_dose_lateral", "no car body is judged"},
    BodyMeasure{"sperling_vertical", too_short},
    BodyMeasure{"sperling_lateral", too_short}};

class RunJudge {
 public:
  RunJudge(const RunResults& results, const RunWindow& window)
      : results_(results), header_(results.header), window_(window), records_(even_records(results)) {
    if (records_ >= 2) step_ = results.steps[1].time - results.steps[0].time;
  }

  RunMeasures measures() {
    if (records_ < 2) {
      miss_all("the run has no records");
      return std::move(found_);
    }
    deck();
    wheels();
    bodies();
    return std::move(found_);
  }

  RunSeries series() {
    RunSeries result;
    if (records_ < 2) return result;
    deck_series(result);
    wheel_series(result);
    return result;
  }

 private:
  void miss(const std::vector<std::string>& measures, const std::string& reason) {
    for (const std::string& measure : measures) {
      found_.missing.push_back({measure, AssessmentStage::contact, reason, false});
    }
  }
  void miss_all(const std::string& reason) {
    for (const MeasureKind& kind : measure_kinds()) {
      if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) > 0) {
        miss({std::string(kind.name)}, reason);
      }
    }
  }

  /// Keeps the largest amount of a measure; `group` tells values with limits of their own.
  void raise(const std::string& measure, double value, std::optional<double> time, const std::string& where,
             double group = 0.0) {
    const double amount = std::abs(value);
    MeasuredValue& best = best_[{measure, group}];
    if (!best.measure.empty() && !(amount > best.value)) return;
    best.measure = measure;
    best.stage = AssessmentStage::contact;
    best.value = amount;
    best.time = time;
    best.where = where;
    best.speed = header_.speed;
    best.quantities["axle_load"] = 2.0 * group;
    best.quantities["static_wheel_load"] = group;
    best.quantities["nadal_limit"] = nadal_;
    best.quantities["weinstock_limit"] = nadal_ + window_.friction;
    best.quantities["fra_limit"] = fra_;
  }
  /// The largest percentile of a quantity in any of its sections.
  void raise_sections(const std::string& measure, const SectionPercentiles& of, const std::string& name,
                      double group = 0.0) {
    for (const SectionRange& section : of.sections()) {
      raise(measure, section.extreme(), std::nullopt,
            fmt::format("{}, x = {:.4g} to {:.4g} m", name, section.from, section.to), group);
    }
  }
  [[nodiscard]] SectionPercentiles sections() const {
    return {window_.begin, window_.section_length, window_.section_step};
  }
  [[nodiscard]] bool judged(double x) const noexcept { return x >= window_.begin && x <= window_.end; }
  void keep() {
    for (auto& [key, value] : best_) found_.values.push_back(std::move(value));
    best_.clear();
  }

  [[nodiscard]] const StepRecord& at(std::size_t k) const { return results_.steps[k]; }
  [[nodiscard]] double wheel_position(std::size_t wheel, std::size_t k) const {
    return at(k).position + header_.wheel_x[wheel];
  }

  template <class Value>
  [[nodiscard]] Series of_records(const Value& value) const {
    Series series(records_);
    for (std::size_t k = 0; k < records_; ++k) series[k] = value(at(k));
    return series;
  }

  void deck() {
    if (header_.deck.empty()) {
      miss(of_envelope, "the run has no envelope of the deck (output.deck_envelope)");
    } else if (results_.summary.deck.empty()) {
      miss(of_envelope, "the run was ended before it wrote the envelope of the deck");
    } else {
      return whole_deck();
    }
    recorded_deck();
  }

  /// From the extremes of all its nodes.
  void whole_deck() {
    const bool fast = std::abs(header_.deck_cut_off - window_.deck_cut_off) <= 1e-6 * window_.deck_cut_off;
    for (std::size_t q = 0; q < header_.deck.size(); ++q) {
      const auto measure = std::ranges::find(envelope_measures, header_.deck[q].quantity, &EnvelopeMeasure::quantity);
      if (measure == envelope_measures.end()) continue;
      if (!fast && measure->name == "deck_acceleration") {
        miss({"deck_acceleration"}, fmt::format("output.deck_cut_off is {:.4g} Hz, and the decks ask for {:.4g} Hz",
                                                header_.deck_cut_off, window_.deck_cut_off));
        continue;
      }
      const DeckPlaces& places = header_.deck[q];
      const DeckExtremes& extremes = results_.summary.deck[q];
      for (std::size_t i = 0; i < places.x.size(); ++i) {
        const std::string where = place_on_deck(places, i);
        raise(std::string(measure->name), extremes.smallest[i], extremes.smallest_time[i], where);
        raise(std::string(measure->name), extremes.largest[i], extremes.largest_time[i], where);
      }
    }
    for (const EnvelopeMeasure& measure : envelope_measures) {
      if (std::ranges::count(header_.deck, measure.quantity, &DeckPlaces::quantity) > 0) continue;
      miss({std::string(measure.name)}, "the decks of this scene do not have it");
    }
    keep();
  }

  void recorded_deck() {
    const std::vector<std::string> filtered{"deck_acceleration"},
        all{"deck_acceleration", "deck_acceleration_unfiltered", "deck_displacement"};
    if (std::none_of(header_.node_names.begin(), header_.node_names.end(), [](const auto& n) { return is_deck(n); })) {
      return miss(all, "no node named deck… is recorded");
    }
    const bool fast = samples_fast_enough(window_.deck_cut_off, step_);
    if (!fast)
      miss(filtered,
           fmt::format("records {:g} s apart are too far for a filter of {:.4g} Hz", step_, window_.deck_cut_off));
    for (std::size_t i = 0; i < header_.node_names.size(); ++i) {
      if (!is_deck(header_.node_names[i])) continue;
      const Series raw = of_records([&](const StepRecord& r) { return r.nodes[i].acceleration[vertical]; });
      const Series smooth = fast ? low_passed(raw, window_.deck_cut_off, step_) : Series{};
      for (std::size_t k = 0; k < records_; ++k) {
        const std::string& node = header_.node_names[i];
        raise("deck_acceleration_unfiltered", raw[k], at(k).time, node);
        if (fast) raise("deck_acceleration", smooth[k], at(k).time, node);
        raise("deck_displacement", at(k).nodes[i].displacement[vertical], at(k).time, node);
      }
    }
    keep();
  }

  void wheels() {
    const std::vector<std::string> forces{"wheel_unloading",     "wheel_unloading_unfiltered",
                                          "wheel_unloading_5ft", "unloading_duration",
                                          "wheel_force",         "wheel_force_percentile"};
    const std::vector<std::string> guiding{
        "derailment_2m",  "derailment",      "derailment_percentile",  "derailment_5ft",          "weinstock_sum",
        "track_shift_2m", "track_shift_5ft", "track_shift_percentile", "guiding_force_percentile"};
    const bool fast = samples_fast_enough(window_.wheel_cut_off, step_);
    const bool guided = !header_.wheel_y.empty();
    if (header_.static_wheel_load.empty() || at(0).wheels.empty() || !fast) {
      const std::string reason = fast ? "no wheel forces are recorded"
                                      : fmt::format("records {:g} s apart are too far for a filter of {:.4g} Hz", step_,
                                                    window_.wheel_cut_off);
      miss(forces, reason);
      return miss(guiding, reason);
    }
    if (!guided) miss(guiding, "the scene's wheels have no lateral forces (contact.normal = \"rigid\")");
    if (guided) {
      constexpr double fra_friction = 0.5;
      nadal_ = nadal_limit(flange_angle(header_), window_.friction);
      fra_ = nadal_limit(flange_angle(header_), fra_friction);
    }
    for (std::size_t w = 0; w + 1 < header_.static_wheel_load.size(); w += 2) wheelset(w, guided);
    for (const auto* measures : {&forces, &guiding}) {
      if (measures == &guiding && !guided) continue;
      for (const std::string& measure : *measures) miss_unless_found(measure);
    }
    keep();
  }

  void miss_unless_found(const std::string& measure) {
    if (std::any_of(best_.begin(), best_.end(), [&](const auto& b) { return b.first.first == measure; })) return;
    const bool none =
        std::none_of(best_.begin(), best_.end(), [&](const auto& b) { return b.first.first == "wheel_force"; });
    miss({measure}, none ? fmt::format("no wheel comes to x = {:.4g} m, where judging begins", window_.begin)
                         : fmt::format("no wheel is judged over as long a way{}",
                                       measure.ends_with("percentile") && window_.section_length > 0.0
                                           ? fmt::format(" as a section of {:.4g} m", window_.section_length)
                                           : ""));
  }

  void wheelset(std::size_t left, bool guided) {
    Series Q[2], Y[2];
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t w = left + side;
      Q[side] =
          low_passed(of_records([&](const StepRecord& r) { return r.wheels[w].Q; }), window_.wheel_cut_off, step_);
      if (guided) {
        Y[side] =
            low_passed(of_records([&](const StepRecord& r) { return r.wheels[w].Y; }), window_.wheel_cut_off, step_);
      }
      wheel(w, Q[side]);
      if (guided) guided_wheel(w, Q[side], Y[side]);
    }
    if (!guided) return;
    TrackMean shift(averaged), shift_5ft(five_feet);
    SectionPercentiles percentiles = sections();
    const double Q0 = header_.static_wheel_load[left];
    const std::string name = fmt::format("wheelset {}", left / 2 + 1);
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(left, k), time = at(k).time, sum = Y[0][k] + Y[1][k];
      if (!judged(x)) continue;
      if (const auto mean = shift.add(x, sum)) {
        raise("track_shift_2m", *mean, time, name, Q0);
        percentiles.add(x - averaged, *mean);  // by where its 2 m begin
      }
      if (const auto mean = shift_5ft.add(x, sum)) raise("track_shift_5ft", *mean, time, name, Q0);
      raise("weinstock_sum", weinstock_ratio(Y[0][k], Q[0][k], Y[1][k], Q[1][k]), time, name);
    }
    raise_sections("track_shift_percentile", percentiles, name, Q0);
  }

  void wheel(std::size_t w, const Series& Q) {
    constexpr double lasting = 0.6;  // ΔQ/Q0
    const double Q0 = header_.static_wheel_load[w];
    TrackMean unloading_5ft(five_feet);
    SectionPercentiles percentiles = sections();
    Unloading raw(lasting);
    const std::string name = report::wheel_name(w);
    bool any = false;
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(w, k), time = at(k).time;
      if (!judged(x)) continue;
      any = true;
      const double unloading = (Q0 - Q[k]) / Q0;
      raise("wheel_unloading", std::max(0.0, unloading), time, name);
      const auto mean = unloading_5ft.add(x, unloading);
      if (mean) raise("wheel_unloading_5ft", std::max(0.0, *mean), time, name);
      raw.add(time, at(k).wheels[w].Q, Q0);
      raise("wheel_force", Q[k], time, name, Q0);
      percentiles.add(x, Q[k]);
    }
    if (!any) return;
    raise("wheel_unloading_unfiltered", std::max(0.0, raw.largest()), raw.time(), name);
    raise("unloading_duration", raw.longest_above(), raw.time(), name);
    raise_sections("wheel_force_percentile", percentiles, name, Q0);
  }

  void guided_wheel(std::size_t w, const Series& Q, const Series& Y) {
    constexpr double least_share = 0.05;  // of Q0, for a quotient
    const double Q0 = header_.static_wheel_load[w];
    TrackMean quotient(averaged), quotient_5ft(five_feet);
    SectionPercentiles quotients = sections(), forces = sections();
    const std::string name = report::wheel_name(w);
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(w, k), time = at(k).time;
      if (!judged(x)) continue;
      forces.add(x, Y[k]);
      if (!(Q[k] > least_share * Q0)) continue;
      raise("derailment", Y[k] / Q[k], time, name);
      if (const auto mean = quotient.add(x, Y[k] / Q[k])) {
        raise("derailment_2m", *mean, time, name);
        quotients.add(x - averaged, *mean);
      }
      if (const auto mean = quotient_5ft.add(x, Y[k] / Q[k])) raise("derailment_5ft", *mean, time, name);
    }
    raise_sections("guiding_force_percentile", forces, name, Q0);
    raise_sections("derailment_percentile", quotients, name);
  }

  void bodies() {
    std::vector<std::size_t> cars;
    for (std::size_t i = 0; i < header_.body_names.size(); ++i) {
      if (report::is_car_body(header_.body_names[i])) cars.push_back(i);
    }
    if (cars.empty()) {
      for (const BodyMeasure& measure : body_measures) miss({std::string(measure.name)}, "no car body is recorded");
      return;
    }
    for (const std::size_t car : cars) car_body(car);
    for (const BodyMeasure& measure : body_measures) {
      const bool any =
          std::any_of(best_.begin(), best_.end(), [&](const auto& b) { return b.first.first == measure.name; });
      if (!any) miss({std::string(measure.name)}, std::string(measure.otherwise));
    }
    keep();
  }

  /// Along the track; where the results do not say it, that of the first wheelset [m].
  [[nodiscard]] double body_position(std::size_t body, std::size_t k) const {
    return at(k).position + (body < header_.body_x.size() ? header_.body_x[body] : 0.0);
  }

  void car_body(std::size_t body) {
    const std::string name = report::vehicle_of(header_.body_names[body]);
    const auto acceleration = [&](int direction) {
      return of_records([&](const StepRecord& r) { return r.bodies[body].acceleration[direction]; });
    };
    const Series x = acceleration(longitudinal), y = acceleration(lateral), z = acceleration(vertical);
    const std::vector<double> x_rms = weighted(body, x, weighting_d, "longitudinal", {});
    const std::vector<double> y_rms = weighted(body, y, weighting_d, "lateral", weighting_d);
    const std::vector<double> z_rms = weighted(body, z, weighting_b, "vertical", weighting_k);
    constexpr std::size_t five_minutes = 60;  // windows
    if (z_rms.size() >= five_minutes) raise("mean_comfort", mean_comfort(x_rms, y_rms, z_rms), std::nullopt, name);
    if (!samples_fast_enough(car_body_cut_off, step_)) return;
    const Series y_smooth = low_passed(y, car_body_cut_off, step_), z_smooth = low_passed(z, car_body_cut_off, step_);
    for (std::size_t k = 0; k < records_; ++k) {
      if (!judged(body_position(body, k))) continue;
      raise("car_body_lateral_6hz", y_smooth[k], at(k).time, name);
      raise("car_body_vertical_6hz", z_smooth[k], at(k).time, name);
    }
  }

  /// Measures of a car body's acceleration in one direction; a direction in which it does not move has none.
  /// @param comfort weighting of 5 s windows @param dose that of the running rms and the dose @return rms of the
  /// windows
  std::vector<double> weighted(std::size_t body, const Series& acceleration, const Weighting& comfort,
                               const std::string& direction, const std::optional<Weighting>& dose_weighting) {
    const std::string name = report::vehicle_of(header_.body_names[body]);
    const bool moves = std::any_of(acceleration.begin(), acceleration.end(), [](double a) { return a != 0.0; });
    const bool sperling = direction != "longitudinal";
    WeightedSeries comfort_series(comfort, step_), dose_series(dose_weighting.value_or(comfort), step_);
    WindowedRms rms(5.0, step_);
    VibrationDose dose(step_);
    SperlingIndex index(direction == "lateral" ? SperlingDirection::lateral : SperlingDirection::vertical, step_);
    double end = 0.0;
    for (std::size_t k = 0; k < records_; ++k) {
      const double a = acceleration[k], of_comfort = comfort_series.add(a), of_dose = dose_series.add(a);
      if (!judged(body_position(body, k))) continue;
      end = at(k).time;
      rms.add(of_comfort);
      if (!moves && !sperling) continue;
      windows(rms, "comfort_" + direction, end, name);
      if (!sperling) continue;
      raise("car_body_" + direction, a, end, name);
      dose.add(of_dose);
      index.add(a);
      windows(index, "sperling_" + direction, end, name);
    }
    if (dose.largest_running_rms() > 0.0) raise("running_rms_" + direction, dose.largest_running_rms(), end, name);
    if (sperling && end > 0.0) raise("vibration_dose_" + direction, dose.dose(), end, name);
    return rms.values();
  }

  template <class Windows>
  void windows(const Windows& of, const std::string& measure, double time, const std::string& name) {
    if (!of.values().empty()) raise(measure, of.values().back(), time, name);
  }

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

  const RunResults& results_;
  const ResultHeader& header_;
  RunWindow window_;
  std::size_t records_ = 0;
  double step_ = 0.0, nadal_ = 0.0, fra_ = 0.0;
  std::map<std::pair<std::string, double>, MeasuredValue> best_;
  RunMeasures found_;
};

}  // namespace

RunMeasures run_measures(const RunResults& results, const RunWindow& window) {
  return RunJudge(results, window).measures();
}

RunSeries run_series(const RunResults& results, const RunWindow& window) { return RunJudge(results, window).series(); }

}  // namespace railtab::assess
