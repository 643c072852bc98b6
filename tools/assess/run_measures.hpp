#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "deck_charts.hpp"
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

/// Unloading of the wheel with the largest filtered one over its position, for charts. Empty where there is none.
struct WheelSeries {
  std::string wheel;
  std::vector<double> position, unloading, filtered_unloading;
};
[[nodiscard]] WheelSeries wheel_series(const RunResults& results, const RunWindow& window);

/// What a deck does in the run that governs one of its measures, for charts: the extremes along it, and the history of
/// the recorded node that governs or is nearest to the one that does.
struct DeckSeries {
  MeasuredValue governing;        ///< the measure's largest value and where it stood
  report::DeckEnvelope envelope;  ///< of that measure; empty where the deck is not followed
  std::string node;               ///< recorded; empty: none
  double node_x = 0.0;            ///< [m]
  std::optional<double> node_y;   ///< right of the track's centre [m], where that of the governing place is told
  bool node_governs = false;      ///< it is the one that governs, not a neighbour
  std::vector<double> time;
  std::vector<double> judged;      ///< the node's displacement or low-passed acceleration; empty: too slow records
  std::vector<double> unfiltered;  ///< its acceleration; empty for a displacement
};
/// @param governing a value of deck_acceleration or deck_displacement of this run
[[nodiscard]] DeckSeries deck_series(const RunResults& results, const RunWindow& window,
                                     const MeasuredValue& governing);

}  // namespace railtab::assess
