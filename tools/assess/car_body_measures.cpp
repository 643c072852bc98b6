#include <fmt/format.h>

#include <array>

#include "headline.hpp"
#include "railtab/runtime/drawing/body_names.hpp"
#include "railtab/runtime/measures/comfort.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/measures/weighting.hpp"
#include "run_judge.hpp"

namespace railtab::assess {
namespace {

constexpr double car_body_cut_off = 6.0;  // [Hz]
constexpr double comfort_window = 5.0;    // [s]

/// Measures of car bodies, and why a run has none of them.
struct BodyMeasure {
  std::string_view name, otherwise;
  bool weighted = false;  ///< by frequency
};
constexpr std::string_view too_short = "no car body is judged for as long as 5 s";
constexpr std::string_view too_short_or_still = "no car body is judged for as long as 5 s, or none moves laterally";
constexpr std::string_view no_mean = "no car body is judged for as long as 5 minutes, 60 windows of 5 s";
constexpr std::array body_measures{
    BodyMeasure{"car_body_vertical", "no car body is judged"},
    BodyMeasure{"car_body_lateral", "no car body is judged, or none moves laterally"},
    BodyMeasure{"car_body_vertical_6hz", "no car body is judged, or records are too far apart"},
    BodyMeasure{"car_body_lateral_6hz", "no car body is judged, none moves laterally, or records are too far apart"},
    BodyMeasure{"comfort_vertical", too_short, true},
    BodyMeasure{"comfort_lateral", too_short_or_still, true},
    BodyMeasure{"comfort_longitudinal", "car bodies have no longitudinal acceleration, or none for as long as 5 s",
                true},
    BodyMeasure{"mean_comfort", no_mean, true},
    BodyMeasure{"mean_comfort_seated", no_mean, true},
    BodyMeasure{"mean_comfort_standing", no_mean, true},
    BodyMeasure{"running_rms_vertical", "no car body is judged for as long as 1 s", true},
    BodyMeasure{"running_rms_lateral", "no car body is judged for as long as 1 s, or none moves laterally", true},
    BodyMeasure{"vibration_dose_vertical", "no car body is judged", true},
    BodyMeasure{"vibration_dose_lateral", "no car body is judged, or none moves laterally", true},
    BodyMeasure{"sperling_vertical", too_short},
    BodyMeasure{"sperling_lateral", too_short_or_still}};

/// A direction in which nothing moves has no measures.
bool moves(const Series& acceleration) {
  return std::any_of(acceleration.begin(), acceleration.end(), [](double a) { return a != 0.0; });
}

class CarBodyJudge : public RunJudge {
 public:
  using RunJudge::RunJudge;

  void find() {
    std::vector<std::size_t> cars;
    for (std::size_t i = 0; i < header_.body_names.size(); ++i) {
      if (is_car_body(header_.body_names[i])) cars.push_back(i);
    }
    if (cars.empty()) {
      for (const BodyMeasure& measure : body_measures) miss({std::string(measure.name)}, "no car body is recorded");
      return;
    }
    for (const std::size_t car : cars) car_body(car);
    const std::string too_far = fmt::format(
        "records {:g} s apart are too far for the frequency weighting, at most {:g} s", step_, longest_weighted_step);
    for (const BodyMeasure& measure : body_measures) {
      if (has(measure.name)) continue;
      miss({std::string(measure.name)}, measure.weighted && !weightable_ ? too_far : std::string(measure.otherwise));
    }
    keep();
  }

 private:
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
    unweighted(body, y, "lateral");
    unweighted(body, z, "vertical");
    if (weightable_) comfort(body, x, y, z);
    if (!samples_fast_enough(car_body_cut_off, step_)) return;
    const bool moves_laterally = moves(y);
    const Series y_smooth = low_passed(y, car_body_cut_off, step_), z_smooth = low_passed(z, car_body_cut_off, step_);
    for (std::size_t k = 0; k < records_; ++k) {
      const Spot spot{name, at(k).time, body_position(body, k)};
      if (!judged(*spot.x)) continue;
      if (moves_laterally) raise("car_body_lateral_6hz", y_smooth[k], spot);
      raise("car_body_vertical_6hz", z_smooth[k], spot);
    }
  }

  /// Measures of a car body's acceleration in one direction, as it is; none where it does not move.
  void unweighted(std::size_t body, const Series& acceleration, const std::string& direction) {
    if (!moves(acceleration)) return;
    const std::string name = report::vehicle_of(header_.body_names[body]);
    SperlingIndex index(direction == "lateral" ? SperlingDirection::lateral : SperlingDirection::vertical, step_);
    for (std::size_t k = 0; k < records_; ++k) {
      const Spot spot{name, at(k).time, body_position(body, k)};
      if (!judged(*spot.x)) continue;
      raise("car_body_" + direction, acceleration[k], spot);
      index.add(acceleration[k]);
      windows(index, "sperling_" + direction, spot);
    }
  }

  /// Measures of a car body's weighted accelerations x, y, z.
  void comfort(std::size_t body, const Series& x, const Series& y, const Series& z) {
    const std::string name = report::vehicle_of(header_.body_names[body]);
    const std::vector<double> x_rms = weighted(body, x, weighting_d, "longitudinal", {});
    const std::vector<double> y_rms = weighted(body, y, weighting_d, "lateral", weighting_d);
    const std::vector<double> z_rms = weighted(body, z, weighting_b, "vertical", weighting_k);
    constexpr std::size_t five_minutes = 60;  // windows
    if (z_rms.size() < five_minutes) return;
    raise("mean_comfort", mean_comfort(x_rms, y_rms, z_rms), {name});
    raise("mean_comfort_standing", mean_comfort_standing(x_rms, y_rms, z_rms), {name});
    // rigid, without seats: pan and back move with the floor
    const std::vector<double> x_back = window_rms(body, x, weighting_c);
    raise("mean_comfort_seated", mean_comfort_seated(z_rms, y_rms, z_rms, x_back), {name});
  }

  /// Of a car body's weighted acceleration at the judged places [m/s²].
  [[nodiscard]] std::vector<double> window_rms(std::size_t body, const Series& acceleration,
                                               const Weighting& weighting) const {
    WeightedSeries series(weighting, step_);
    WindowedRms rms(comfort_window, step_);
    for (std::size_t k = 0; k < records_; ++k) {
      const double a = series.add(acceleration[k]);
      if (judged(body_position(body, k))) rms.add(a);
    }
    return rms.values();
  }

  /// Measures of a car body's weighted acceleration in one direction.
  /// @param of_windows weighting of 5 s windows @param of_dose that of the running rms and the dose, none: without them
  /// @return rms of the windows
  std::vector<double> weighted(std::size_t body, const Series& acceleration, const Weighting& of_windows,
                               const std::string& direction, const std::optional<Weighting>& of_dose) {
    const std::string name = report::vehicle_of(header_.body_names[body]);
    const bool moving = moves(acceleration);
    WeightedSeries window_series(of_windows, step_), dose_series(of_dose.value_or(of_windows), step_);
    WindowedRms rms(comfort_window, step_);
    VibrationDose dose(step_);
    Spot roughest;  // second that ends here
    for (std::size_t k = 0; k < records_; ++k) {
      const double in_window = window_series.add(acceleration[k]), in_dose = dose_series.add(acceleration[k]);
      const Spot spot{name, at(k).time, body_position(body, k)};
      if (!judged(*spot.x)) continue;
      rms.add(in_window);
      if (!moving) continue;
      windows(rms, "comfort_" + direction, spot);
      if (!of_dose) continue;
      const double before = dose.largest_running_rms();
      dose.add(in_dose);
      if (dose.largest_running_rms() > before) roughest = spot;
    }
    if (dose.largest_running_rms() > 0.0) raise("running_rms_" + direction, dose.largest_running_rms(), roughest);
    if (dose.dose() > 0.0) raise("vibration_dose_" + direction, dose.dose(), {name});
    return rms.values();
  }

  template <class Windows>
  void windows(const Windows& of, const std::string& measure, const Spot& spot) {
    if (!of.values().empty()) raise(measure, of.values().back(), spot);
  }

  const bool weightable_ = samples_fast_enough_to_weight(step_);
};

}  // namespace

void measure_car_bodies(const RunResults& results, const RunWindow& window, RunMeasures& found) {
  CarBodyJudge(results, window, found).find();
}

}  // namespace railtab::assess
