#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "railtab/runtime/measures/section_percentiles.hpp"
#include "run_measures.hpp"

namespace railtab::assess {

using Series = std::vector<double>;
inline constexpr int longitudinal = 0, lateral = 1, vertical = 2;  // of MotionRecord's six

/// Of a value within its run: x along the track, at that time; y right of the track's centre [m].
struct Spot {
  std::string_view where;
  std::optional<double> time{}, x{}, y{};
};

/// Limits of Y/Q that follow from the flange of a wheel.
struct FlangeLimits {
  std::map<std::string, double, std::less<>> values;  ///< see MeasuredValue::quantities
  std::string unknown;                                ///< why there are none
};

/// Records of a run, and the largest values found in them: what deck, wheels and car bodies are judged with.
class RunJudge {
 public:
  /// @param results and found outlive it @pre count_even_records() >= 2
  RunJudge(const RunResults& results, const RunWindow& window, RunMeasures& found);

 protected:
  void miss(const std::vector<std::string>& measures, const std::string& reason);
  /// Keeps the largest amount of a measure, of values with limits of their own each: those differ in the static wheel
  /// load [N], or in what is known of the flange.
  void raise(const std::string& measure, double value, const Spot& spot, double static_load = 0.0,
             const FlangeLimits* flange = nullptr);
  /// The largest percentile of a quantity in any of its sections.
  void raise_sections(const std::string& measure, const SectionPercentiles& of, const std::string& name,
                      double static_load = 0.0, const FlangeLimits* flange = nullptr);
  [[nodiscard]] bool has(std::string_view measure) const;
  /// Hands the largest values over.
  void keep();

  [[nodiscard]] SectionPercentiles sections() const {
    return {window_.begin, window_.section_length, window_.section_step};
  }
  [[nodiscard]] bool judged(double x) const noexcept { return x >= window_.begin && x <= window_.end; }
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

  const RunResults& results_;
  const ResultHeader& header_;
  RunWindow window_;
  std::size_t records_ = 0;
  double step_ = 0.0;

 private:
  /// The first load of those that differ by rounding alone.
  [[nodiscard]] double grouped(double static_load);

  /// By measure, static wheel load and FlangeLimits::unknown.
  std::map<std::tuple<std::string, double, std::string>, MeasuredValue> best_;
  std::vector<double> loads_;  // grouped
  RunMeasures& found_;
};

/// Records at even times: the last step is recorded whatever the distance.
[[nodiscard]] std::size_t count_even_records(const RunResults& results);

/// Measures of the decks, the wheels and the car bodies. @pre count_even_records() >= 2
void measure_decks(const RunResults& results, const RunWindow& window, RunMeasures& found);
void measure_wheels(const RunResults& results, const RunWindow& window, RunMeasures& found);
void measure_car_bodies(const RunResults& results, const RunWindow& window, RunMeasures& found);

}  // namespace railtab::assess
