#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/scene_run.hpp"

namespace railtab {

class SharedSetUp;

/// A run that writes its results to a file as it goes, from its beginning or from the last checkpoint of the file.
class RecordedRun {
 public:
  /// @param file of the results; what earlier processes abandoned beside it is removed
  /// @param resume go on from what the file holds, where there is one
  /// @throws InputError as read_results() and check_same_run(), and where the file has changed while it was read
  RecordedRun(const SceneParameters& scene, std::filesystem::path file, bool resume);

  /// Results of the file that is resumed; none where the run begins anew.
  [[nodiscard]] const std::optional<RunResults>& before() const noexcept { return before_; }
  /// Whether these are of a run that came to its end, so that there is nothing to do.
  [[nodiscard]] bool is_complete() const noexcept { return before_ && before_->summary.complete; }
  /// Whether the run goes on from a checkpoint of the file.
  [[nodiscard]] bool is_resumed() const noexcept { return checkpoint_.has_value(); }
  /// Those of its records that the run goes on from.
  [[nodiscard]] std::span<const StepRecord> records_before() const noexcept;

  /// As run_scene(). Earlier results are replaced once the set-up has succeeded and `observer` has been told that the
  /// run is ready: they are worth more than a run that could not begin. Records and checkpoints are written before
  /// `observer` has them. Where it throws, the file holds everything up to there.
  /// @param shared what earlier runs of this process have made, and later ones may take; or null
  [[nodiscard]] RunSummary run(RunObserver observer, SharedSetUp* shared = nullptr);

  /// Whether the file holds results of this run. Not where no step was made and earlier results stay there.
  [[nodiscard]] bool has_results() const noexcept { return has_results_; }
  /// Whether these can be gone on with, after run() has ended or thrown.
  [[nodiscard]] bool is_resumable() const;

 private:
  const SceneParameters& scene_;
  std::filesystem::path file_;
  std::optional<RunResults> before_;
  std::optional<Checkpoint> checkpoint_;
  bool has_results_ = false;
};

/// An output must not destroy what the run reads, nor files that are no results. @throws InputError
void require_results_place(const std::filesystem::path& file, const SceneParameters& scene,
                           const std::filesystem::path& scene_file);

/// Results that a run goes on from must be its own: of the same scene, files, version and contact mode.
/// @throws InputError naming `file`
void check_same_run(const RunResults& before, const SceneParameters& scene, const std::filesystem::path& file);

}  // namespace railtab
