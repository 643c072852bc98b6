#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/assessment/measure_kind.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "run_folder.hpp"
#include "study_plan.hpp"

namespace railtab::vsi {

/// A value for each variable of a plan.
using StudyPoint = std::vector<StudyValue>;

/// Points that are known before a run is made: all values of the grid with all samples, the last variable fastest and
/// the samples last. Each point of the grid has the same samples.
[[nodiscard]] std::vector<StudyPoint> planned_points(const StudyPlan& plan);
/// Values of random variables at these probabilities, numbers of keys that take integers rounded down.
/// @pre all variables are random
[[nodiscard]] StudyPoint point_at(const StudyPlan& plan, const std::vector<Probability>& probabilities);

/// What a run has come to.
struct StudyRow {
  bool complete = false;                        ///< false: derailed, no convergence
  std::vector<std::optional<double>> measures;  ///< one per study_measures()
  double simulated_time = 0.0;                  ///< [s]
  std::string message;                          ///< why it is not complete
};

/// Measures of a run, in the order of the columns.
[[nodiscard]] const std::vector<const MeasureKind*>& study_measures();

/// Ends a study early; its exit code.
struct StudyStopped {
  int code;
};

struct StudyRunsOptions {
  std::filesystem::path folder;
  std::size_t processes = 1;
  bool quiet = false;
};

/// Runs of a study in a folder. A run has the name of what it changes in the scene, so that it is made once, whichever
/// plan, shard or process asks for it.
class StudyRuns {
 public:
  /// @param plan and scene outlive it @throws InputError where a deck's frequencies cannot be found
  StudyRuns(const StudyPlan& plan, const SceneParameters& scene, StudyRunsOptions options);

  /// Reads the scene of every point. @throws InputError naming the variable and its line of the plan, or the measure
  /// that a scene without a bridge does not have
  void check(const std::vector<StudyPoint>& points) const;
  /// Binds the folder, which is there, to the scene. @throws InputError where it holds the runs of another one
  void bind_folder() const;
  /// Removes what killed processes left of these runs.
  void tidy(const std::vector<StudyPoint>& points) const;
  /// Makes the runs that are not there yet. @param progress of these, 0..1 @return exit code, see RunPool::run()
  int make(const std::vector<StudyPoint>& points, const std::function<void(double)>& progress);
  /// The same; then a row for each point. @throws StudyStopped after Ctrl-C, ComputationError where a run has none
  std::vector<StudyRow> rows(const std::vector<StudyPoint>& points, const std::function<void(double)>& progress);

  [[nodiscard]] std::string columns() const;
  /// Rows of the runs that are finished, each once, in the order of the points.
  [[nodiscard]] RunCount table(const std::vector<StudyPoint>& points, std::string& rows) const;
  /// Of the runs that are finished, see warnings_of_runs().
  [[nodiscard]] std::vector<std::string> warnings(const std::vector<StudyPoint>& points) const;
  /// Empty where the run is not finished.
  [[nodiscard]] std::optional<StudyRow> find_row(const StudyPoint& point) const;
  [[nodiscard]] std::string name_of(const StudyPoint& point) const { return row_of(point).name; }
  /// [Hz]; none where the plan varies the decks: each run then has that of its own.
  [[nodiscard]] std::optional<double> deck_cut_off() const noexcept { return deck_cut_off_; }

 private:
  [[nodiscard]] RunRow row_of(const StudyPoint& point) const;
  /// Of these points, each run once.
  [[nodiscard]] std::vector<RunRow> rows_of(const std::vector<StudyPoint>& points) const;
  [[nodiscard]] std::vector<KeyChange> changes_of(const StudyPoint& point) const;
  [[nodiscard]] SceneParameters changed_scene(const StudyPoint& point) const;
  [[nodiscard]] double cut_off_at(const StudyPoint& point) const;
  [[nodiscard]] SceneParameters scene_of(const StudyPoint& point) const;
  [[nodiscard]] RunPool pool(const std::function<void(double)>& progress) const;
  [[nodiscard]] PooledRun pooled_at(const StudyPoint& point) const;

  const StudyPlan& plan_;
  const SceneParameters& scene_;
  StudyRunsOptions options_;
  std::optional<double> deck_cut_off_;
  mutable std::pair<std::string, double> last_cut_off_;  ///< name of the run, and its cut-off
};

}  // namespace railtab::vsi
