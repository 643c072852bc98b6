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
};
constexpr std::string_view too_short = "no car body is judged for as long as 5 s";
constexpr std::string_view no_mean = "no car body is judged for as long as 5 minutes, 60 windows of 5 s";
constexpr std::array body_measures{
    BodyMeasure{"car_body_vertical", "no car body is judged"},
    BodyMeasure{"car_body_lateral", "no car body is judged"},
    BodyMeasure{"car_body_vertical_6hz", "no car body is judged, or records are too far apart"},
    BodyMeasure{"car_body_lateral_6hz", "no car body is judged, or records are too far apart"},
    BodyMeasure{"comfort_vertical", too_short},
    BodyMeasure{"comfort_lateral", too_short},
    BodyMeasure{"comfort_longitudinal", "car bodies have no longitudinal acceleration, or none for as long as 5 s"},
    BodyMeasure{"mean_comfort", no_mean},
    BodyMeasure{"mean_comfort_seated", no_mean},
    BodyMeasure{"mean_comfort_standing", no_mean},
    BodyMeasure{"running_rms_vertical", "no car body is judged for as long as 1 s"},
    BodyMeasure{"running_rms_lateral", "no car body is judged for as long as 1 s, or none moves laterally"},
    BodyMeasure{"vibration_dose_vertical", "no car body is judged"},
    BodyMeasure{"vibration_dose_lateral", "no car body is judged"},
    BodyMeasure{"sperling_vertical", too_short},
    BodyMeasure{"sperling_lateral", too_short}};

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
    for (const BodyMeasure& measure : body_measures) {
      if (!has(measure.name)) miss({std::string(measure.name)}, std::string(measure.otherwise));
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
    const std::vector<double> x_rms = weighted(body, x, weighting_d, "longitudinal", {});
    const std::vector<double> y_rms = weighted(body, y, weighting_d, "lateral", weighting_d);
    const std::vector<double> z_rms = weighted(body, z, weighting_b, "vertical", weighting_k);
    constexpr std::size_t five_minutes = 60;  // windows
    if (z_rms.size() >= five_minutes) {
      raise("mean_comfort", mean_comfort(x_rms, y_rms, z_rms), {name});
      raise("mean_comfort_standing", mean_comfort_standing(x_rms, y_rms, z_rms), {name});
      // rigid, without seats: pan and back move with the floor
      const std::vector<double> x_back = window_rms(body, x, weighting_c);
      raise("mean_comfort_seated", mean_comfort_seated(z_rms, y_rms, z_rms, x_back), {name});
    }
    if (!samples_fast_enough(car_body_cut_off, step_)) return;
    const Series y_smooth = low_passed(y, car_body_cut_off, step_), z_smooth = low_passed(z, car_body_cut_off, step_);
    for (std::size_t k = 0; k < records_; ++k) {
      const Spot spot{name, at(k).time, body_position(body, k)};
      if (!judged(*spot.x)) continue;
      raise("car_body_lateral_6hz", y_smooth[k], spot);
      raise("car_body_vertical_6hz", z_smooth[k], spot);
    }
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

  /// Measures of a car body's acceleration in one direction; a direction in which it does not move has none.
  /// @param comfort weighting of 5 s windows @param dose that of the running rms and the dose @return rms of the
  /// windows
  std::vector<double> weighted(std::size_t body, const Series& acceleration, const Weighting& comfort,
                               const std::string& direction, const std::optional<Weighting>& dose_weighting) {
    const std::string name = report::vehicle_of(header_.body_names[body]);
    const bool moves = std::any_of(acceleration.begin(), acceleration.end(), [](double a) { return a != 0.0; });
    const bool sperling = direction != "longitudinal";
    WeightedSeries comfort_series(comfort, step_), dose_series(dose_weighting.value_or(comfort), step_);
    WindowedRms rms(comfort_window, step_);
    VibrationDose dose(step_);
    SperlingIndex index(direction == "lateral" ? SperlingDirection::lateral : SperlingDirection::vertical, step_);
    Spot roughest;  // second that ends here
    bool any = false;
    for (std::size_t k = 0; k < records_; ++k) {
      const double a = acceleration[k], of_comfort = comfort_series.add(a), of_dose = dose_series.add(a);
      const Spot spot{name, at(k).time, body_position(body, k)};
      if (!judged(*spot.x)) continue;
      any = true;
      rms.add(of_comfort);
      if (!moves && !sperling) continue;
      windows(rms, "comfort_" + direction, spot);
      if (!sperling) continue;
      raise("car_body_" + direction, a, spot);
      const double before = dose.largest_running_rms();
      dose.add(of_dose);
      if (dose.largest_running_rms() > before) roughest = spot;
      index.add(a);
      windows(index, "sperling_" + direction, spot);
    }
    if (dose.largest_running_rms() > 0.0) raise("running_rms_" + direction, dose.largest_running_rms(), roughest);
    if (sperling && any) raise("vibration_dose_" + direction, dose.dose(), {name});
    return rms.values();
  }

  template <class Windows>
  void windows(const Windows& of, const std::string& measure, const Spot& spot) {
    if (!of.values().empty()) raise(measure, of.values().back(), spot);
  }
};

}  // namespace

void measure_car_bodies(const RunResults& results, const RunWindow& window, RunMeasures& found) {
  CarBodyJudge(results, window, found).find();
}

}  // namespace railtab::assess
