#pragma once

#include <functional>
#include <string>
#include <vector>

#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::work_precision {

/// A run and what it cost.
struct MeasuredRun {
  RunSummary summary;
  std::vector<std::string> body_names, node_names;
  std::vector<StepRecord> records;
  double seconds = 0.0;  ///< processor time from the first step on, without the set-up
};

/// @param run passes an observer on to a run
[[nodiscard]] MeasuredRun measured(const std::function<RunSummary(const RunObserver&)>& run);
/// The runs 0 to count - 1 in turn, three times (once where `quick`); each with the median of its times.
[[nodiscard]] std::vector<MeasuredRun> median_runs(std::size_t count, bool quick,
                                                   const std::function<MeasuredRun(std::size_t)>& run);

/// What two runs are compared by.
enum class Quantity {
  wheel_forces,           ///< Q and Y of every wheel [N]
  car_body_acceleration,  ///< vertical and lateral, of every body that is not a wheelset or a bogie [m/s²]
  deck_acceleration,      ///< vertical, of the nodes of the deck [m/s²]
};

/// Difference of two runs at the same times: over the rms of the reference's dynamic part (each channel without its
/// mean), and the largest over the largest. NaN where the runs have no such quantity or not the same times.
struct RunError {
  double rms = 0.0, largest = 0.0;
};
[[nodiscard]] RunError run_error(const MeasuredRun& reference, const MeasuredRun& run, Quantity quantity);

}  // namespace railtab::work_precision
