#pragma once

#include "railtab/runtime/reliability/fragility.hpp"
#include "railtab/runtime/reliability/peak_search.hpp"
#include "railtab/runtime/reliability/sobol_indices.hpp"
#include "railtab/runtime/reliability/subset_simulation.hpp"
#include "railtab/runtime/reliability/threshold_search.hpp"
#include "study_runs.hpp"

namespace railtab::vsi {

/// Runs at one point of the grid, or of one intensity, against the limit. A run that ended early counts as beyond it.
struct ExceedanceCount {
  StudyPoint point;  ///< values of the variables with values; random ones are 0
  std::size_t runs = 0, exceeded = 0, ended_early = 0;
  ConfidenceInterval probability;
};

/// Where a measure reaches the limit, at one point of the grid of the other variables.
struct StudyThreshold {
  struct Place {
    double value;     ///< of the variable
    double response;  ///< infinite where the run ended early
  };
  StudyPoint point;              ///< values of the other variables
  std::optional<Place> below;    ///< the value before; none where the first one reaches the limit
  std::optional<Place> reached;  ///< none where no value does
  /// Linear between both; none without both, and where the run ended early.
  [[nodiscard]] std::optional<double> crossing(double limit) const noexcept;
};

/// What a study has come to; of the analysis what its method gives.
struct StudyResult {
  std::vector<StudyPoint> points;  ///< of the runs
  std::vector<ExceedanceCount> exceedance;
  std::optional<FragilityFit> fragility;
  std::optional<SubsetResult> subset;
  std::optional<SobolIndices> importance;
  std::optional<PeakSearch> peak;
  std::vector<StudyThreshold> thresholds;
};

/// How many runs a study makes, at most where the method ends by itself.
[[nodiscard]] std::size_t greatest_run_count(const StudyPlan& plan);
/// Makes the runs of a plan with a method and analyses them. @pre not StudyMethod::table @param progress of all runs,
/// 0..1
/// @throws StudyStopped, ComputationError as StudyRuns::rows(), and where a run has no value of the measure
[[nodiscard]] StudyResult analyse(const StudyPlan& plan, StudyRuns& runs, const std::function<void(double)>& progress);

}  // namespace railtab::vsi
