#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "railtab/runtime/assessment/verdict.hpp"
#include "railtab/runtime/results/result_file.hpp"

namespace railtab::assess {

/// What of a run is judged, and how its series are filtered.
struct RunWindow {
  /// Where wheels and car bodies begin to be judged [m].
  double begin = 0.0;
  double deck_cut_off = 30.0;   ///< [Hz]
  double wheel_cut_off = 20.0;  ///< [Hz]
  double friction = 0.3;        ///< of Nadal's limit
  /// Where they end to be judged [m].
  double end = std::numeric_limits<double>::infinity();
  double section_length = 0.0;  ///< of percentiles, from `begin` on [m]; 0: one section, all that is judged
  double section_step = 0.5;    ///< between their values [m]
  /// Largest twist of the track without traffic over the 3 m from any place between two on [m]; empty: not known.
  std::function<double(double first, double last)> track_twist{};
};

struct RunMeasures {
  std::vector<MeasuredValue> values;  ///< the largest of each measure, by static wheel load where limits depend on it
  std::vector<MissingMeasure> missing;
};

/// Measures of the stage `contact` from the records of one run; what the results do not hold is missing, with the
/// reason.
[[nodiscard]] RunMeasures run_measures(const RunResults& results, const RunWindow& window);

/// Deck acceleration of one node over time, unfiltered and filtered; unloading of one wheel over its position: for
/// charts. Empty where there is none.
struct RunSeries {
  std::vector<double> time, acceleration, filtered_acceleration;  ///< of the node with the largest filtered one
  std::string node;
  std::vector<double> position, unloading, filtered_unloading;  ///< of the wheel with the largest filtered one
  std::string wheel;
};
[[nodiscard]] RunSeries run_series(const RunResults& results, const RunWindow& window);

}  // namespace railtab::assess
