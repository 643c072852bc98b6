#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/measures/track_mean.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::report {

/// The largest (or smallest) value of a quantity over a run, and where it stood.
struct Extreme {
  double value = 0.0;
  double time = 0.0;  ///< [s]
  std::string where;  ///< "coach-1", "wheelset 2 left", node name; empty: the run has no such quantity
  [[nodiscard]] bool found() const noexcept { return !where.empty(); }
};

/// Headline numbers of a run. Maxima without filter or percentile, raw but for the sliding means over 2 m of way, over
/// the recorded steps; Q, Y/Q and unloading over all steps (RunSummary::wheel_extremes) where the summary has them.
/// Wheels and car bodies on the judged stretch, decks throughout.
struct Headline {
  Extreme deck_acceleration;      ///< |vertical| of nodes named deck… [m/s²]
  Extreme deck_displacement;      ///< |vertical| of nodes named deck… [m]
  Extreme car_body_vertical;      ///< |vertical acceleration| at a car body's centre of gravity [m/s²]
  Extreme car_body_lateral;       ///< |lateral acceleration| there, where any moves laterally [m/s²]
  Extreme derailment;             ///< |Y|/Q of a wheel while Q > 0; ΣY and this: not of rigid wheels [-]
  Extreme derailment_2m;          ///< |mean of Y/Q over 2 m| of a wheel, records with Q > 0 [-]
  Extreme track_shift_2m;         ///< |mean of ΣY over 2 m| of a wheelset [N]
  Extreme unloading;              ///< (Q0 - Q)/Q0 of a wheel; 1 is lift-off [-]
  Extreme largest_Q, smallest_Q;  ///< [N]
  std::string extent;             ///< of what these are the extremes: extent_of_extremes()
  double simulated_time = 0.0;    ///< of the last record [s]
  double distance = 0.0;          ///< run by the train [m]
  /// Share of contact queries that the table alone answered [-]; 0 where there was no query.
  double table_share = 0.0;
  /// Simulated time over wall time, above 1 faster than the train; 0 where a run was resumed or is not complete, since
  /// its wall time is then not known.
  double real_time_factor = 0.0;
};

/// Gathers the headline while a run goes, or from its results.
class HeadlineCollector {
 public:
  explicit HeadlineCollector(const ResultHeader& header);
  void add(const StepRecord& step);
  [[nodiscard]] Headline result(const RunSummary& summary) const;

 private:
  ResultHeader header_;
  void add_sliding_means(const StepRecord& step);

  struct Followed {
    std::size_t index;  // in a step's record
    std::string name;
  };

  std::vector<std::string> wheel_names_, wheelset_names_;
  std::vector<Followed> car_bodies_;  // by the names of their vehicles
  std::vector<Followed> deck_;        // nodes
  std::vector<TrackMean> quotient_;   // per wheel
  std::vector<TrackMean> shift_;      // per wheelset
  WheelExtremes recorded_;            // of the recorded steps
  Headline headline_;                 // without those
  double first_position_ = 0.0;
  double last_position_ = 0.0;
  bool any_ = false;
  bool sparse_ = false;  // records too far apart for sliding means
};

[[nodiscard]] Headline headline_of(const RunResults& results);

/// A warning where a table served less than half of the queries: it makes a run slow, not wrong. Else empty.
[[nodiscard]] std::string uncovered_queries(const RunSummary& summary);

/// Which steps the headline's values are of, and which stretch of the line, in words.
[[nodiscard]] std::string extent_of_extremes(const ResultHeader& header, const RunSummary& summary);
/// "wheelset 3 left" for a wheel's index in StepRecord::wheels.
[[nodiscard]] std::string wheel_name(std::size_t wheel);
/// "coach-1" of "coach-1/car-body".
[[nodiscard]] std::string vehicle_of(const std::string& body_name);

}  // namespace railtab::report
