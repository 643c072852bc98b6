#include <fmt/format.h>

#include <numbers>

#include "headline.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/measures/rail_wear.hpp"
#include "railtab/runtime/measures/running_safety.hpp"
#include "railtab/runtime/measures/track_mean.hpp"
#include "run_judge.hpp"

namespace railtab::assess {
namespace {

constexpr double averaged = 2.0, five_feet = 1.524;  // [m]
constexpr double least_share = 0.05;                 // of Q0 that a wheel carries where its Y/Q counts

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

/// Of wheels with the outline of the header.
FlangeLimits flange_limits(const ResultHeader& header, double friction) {
  constexpr double degree = std::numbers::pi / 180.0, least = 45.0;  // of a flange
  constexpr double fra_friction = 0.5;
  const double angle = flange_angle(header);
  if (angle < least * degree) {
    return {{},
            fmt::format("its profile is nowhere steeper than {:.1f} degrees, and a flange has {:g} degrees at least",
                        angle / degree, least)};
  }
  const double nadal = nadal_limit(angle, friction);
  return {
      {{"nadal_limit", nadal}, {"weinstock_limit", nadal + friction}, {"fra_limit", nadal_limit(angle, fra_friction)}},
      {}};
}

class WheelJudge : public RunJudge {
 public:
  using RunJudge::RunJudge;

  void find() {
    wear_and_pressure();
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
    if (guided) flange_ = flange_limits(header_, window_.friction);
    for (std::size_t w = 0; w + 1 < header_.static_wheel_load.size(); w += 2) wheelset(w, guided);
    for (const auto* measures : {&forces, &guiding}) {
      if (measures == &guiding && !guided) continue;
      for (const std::string& measure : *measures) miss_unless_found(measure);
    }
    keep();
  }

 private:
  [[nodiscard]] const FlangeLimits& flange_of(std::size_t wheel) const {
    return header_.wheel_outline.empty() || header_.wheel_outline[wheel] == 1.0 ? flange_ : other_flange_;
  }

  /// Needs no filter.
  void wear_and_pressure() {
    const std::vector<std::string> measures{"wear_number", "rail_wear", "contact_pressure"};
    if (header_.wheel_x.empty() || at(0).wheels.empty()) return miss(measures, "no wheels are recorded");
    if (header_.wheel_y.empty()) {
      return miss(measures, "the scene's wheels have no contact patches (contact.normal = \"rigid\")");
    }
    if (std::isnan(at(0).wheels[0].wear_number)) {
      return miss(measures, "the results are of a version that did not record it");
    }
    for (std::size_t side = 0; side < 2; ++side) {
      RailWear rail;
      for (std::size_t w = side; w < header_.wheel_x.size(); w += 2) wear_of_wheel(w, rail);
      const std::optional<RailWear::Metre> most = rail.largest();
      if (most) raise("rail_wear", most->energy, {side == 0 ? "left rail" : "right rail", {}, most->begin});
    }
    for (const std::string& measure : measures) {
      if (!has(measure))
        miss({measure}, fmt::format("no wheel comes to x = {:.4g} m, where judging begins", window_.begin));
    }
    keep();
  }

  void wear_of_wheel(std::size_t w, RailWear& rail) {
    const std::string name = report::wheel_name(w);
    double energy = 0.0, way = 0.0;
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(w, k);
      if (!judged(x)) continue;
      const WheelRecord& now = at(k).wheels[w];
      raise("contact_pressure", now.pressure, {name, at(k).time, x});
      if (k == 0 || !judged(wheel_position(w, k - 1))) continue;
      const double before = wheel_position(w, k - 1), wear = at(k - 1).wheels[w].wear_number;
      rail.add(before, wear, x, now.wear_number);
      energy += 0.5 * (wear + now.wear_number) * (x - before);
      way += x - before;
    }
    if (way > 0.0) raise("wear_number", energy / way, {name});
  }

  void miss_unless_found(const std::string& measure) {
    if (has(measure)) return;
    if (!has("wheel_force")) {
      return miss({measure}, fmt::format("no wheel comes to x = {:.4g} m, where judging begins", window_.begin));
    }
    const bool section = measure.ends_with("percentile") && window_.section_length > 0.0;
    miss({measure}, fmt::format("no wheel is judged over as long a way{}",
                                section ? fmt::format(" as a section of {:.4g} m", window_.section_length) : ""));
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
      const double x = wheel_position(left, k), sum = Y[0][k] + Y[1][k];
      if (!judged(x)) continue;
      const Spot spot{name, at(k).time, x};
      if (const auto mean = shift.add(x, sum)) {
        raise("track_shift_2m", *mean, spot, Q0);
        percentiles.add(x - averaged, *mean);  // by where its 2 m begin
      }
      if (const auto mean = shift_5ft.add(x, sum)) raise("track_shift_5ft", *mean, spot, Q0);
      if (Q[0][k] > least_share * Q0 && Q[1][k] > least_share * Q0) {
        raise("weinstock_sum", weinstock_ratio(Y[0][k], Q[0][k], Y[1][k], Q[1][k]), spot, 0.0, &flange_of(left));
      }
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
    std::optional<Spot> most_unloaded;
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(w, k);
      if (!judged(x)) continue;
      const Spot spot{name, at(k).time, x};
      const double unloading = (Q0 - Q[k]) / Q0;
      raise("wheel_unloading", std::max(0.0, unloading), spot);
      const auto mean = unloading_5ft.add(x, unloading);
      if (mean) raise("wheel_unloading_5ft", std::max(0.0, *mean), spot);
      const double before = raw.largest();
      raw.add(at(k).time, at(k).wheels[w].Q, Q0);
      if (!most_unloaded || raw.largest() > before) most_unloaded = spot;
      raise("wheel_force", Q[k], spot, Q0);
      percentiles.add(x, Q[k]);
    }
    if (!most_unloaded) return;
    raise("wheel_unloading_unfiltered", std::max(0.0, raw.largest()), *most_unloaded);
    if (raw.longest_above() > 0.0) {
      const double begin = raw.longest_begin();
      raise("unloading_duration", raw.longest_above(), {name, begin, wheel_position_at(w, begin)});
    } else {
      raise("unloading_duration", 0.0, {name});
    }
    raise_sections("wheel_force_percentile", percentiles, name, Q0);
  }

  /// Between records [m].
  [[nodiscard]] double wheel_position_at(std::size_t w, double time) const {
    std::size_t k = 1;
    while (k + 1 < records_ && at(k).time < time) ++k;
    const double share = (time - at(k - 1).time) / (at(k).time - at(k - 1).time);
    return std::lerp(wheel_position(w, k - 1), wheel_position(w, k), share);
  }

  void guided_wheel(std::size_t w, const Series& Q, const Series& Y) {
    const double Q0 = header_.static_wheel_load[w];
    const FlangeLimits* flange = &flange_of(w);
    TrackMean quotient(averaged), quotient_5ft(five_feet);
    SectionPercentiles quotients = sections(), forces = sections();
    const std::string name = report::wheel_name(w);
    for (std::size_t k = 0; k < records_; ++k) {
      const double x = wheel_position(w, k);
      if (!judged(x)) continue;
      const Spot spot{name, at(k).time, x};
      forces.add(x, Y[k]);
      if (!(Q[k] > least_share * Q0)) continue;
      raise("derailment", Y[k] / Q[k], spot, 0.0, flange);
      if (const auto mean = quotient.add(x, Y[k] / Q[k])) {
        raise("derailment_2m", *mean, spot, 0.0, flange);
        quotients.add(x - averaged, *mean);
      }
      if (const auto mean = quotient_5ft.add(x, Y[k] / Q[k])) raise("derailment_5ft", *mean, spot, 0.0, flange);
    }
    raise_sections("guiding_force_percentile", forces, name, Q0);
    raise_sections("derailment_percentile", quotients, name, 0.0, flange);
  }

  FlangeLimits flange_, other_flange_{{}, "the results hold the profile of other wheels alone"};
};

}  // namespace

void measure_wheels(const RunResults& results, const RunWindow& window, RunMeasures& found) {
  WheelJudge(results, window, found).find();
}

}  // namespace railtab::assess
