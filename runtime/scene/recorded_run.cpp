#include "railtab/runtime/scene/recorded_run.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/drawing/drawn_records.hpp"
#include "railtab/runtime/drawing/moving_grid.hpp"
#include "railtab/runtime/scene/plan_memory.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/step_count.hpp"
#include "railtab/runtime/scene/timed_model.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {

RecordedRun::RecordedRun(const SceneParameters& scene, std::filesystem::path file, bool resume)
    : scene_(scene), file_(std::move(file)) {
  remove_abandoned(output_file(file_));  // also where results are gone on with
  if (!resume || !std::filesystem::exists(file_)) return;
  before_ = read_results(file_);
  check_same_run(*before_, scene_, file_);
  if (before_->summary.complete) return;
  checkpoint_ = ResultWriter::read_checkpoint(file_);
  if (checkpoint_ && checkpoint_->records > before_->steps.size()) {
    throw input_error(file_.string(), "records that were added while it was read", "a file that no other run writes");
  }
}

std::span<const StepRecord> RecordedRun::records_before() const noexcept {
  if (!checkpoint_) return {};
  return std::span(before_->steps).first(checkpoint_->records);
}

RunSummary RecordedRun::run(RunObserver observer, SharedSetUp* shared) {
  std::optional<ResultWriter> writer;
  ResultHeader header;
  std::optional<RunCheckpoint> from;
  const int instants = scene_.output.paraview_instants;
  std::optional<DrawnRecords> drawn;
  if (instants > 0) drawn.emplace(instants);
  const auto draw = [&](const StepRecord& record) {
    if (drawn) drawn->add(record);
  };
  if (checkpoint_) {
    writer.emplace(ResultWriter::resume(file_, *checkpoint_));
    from = RunCheckpoint{checkpoint_->step, checkpoint_->state};
    for (const StepRecord& record : records_before()) draw(record);
    has_results_ = true;
  }
  const auto replace_results = [&] {
    if (writer) return;
    const bool shown = drawn && drawing::has_motion(header);
    writer.emplace(file_, header, ResultWriter::records_between_flushes,
                   shown ? ResultWriter::Grid::at_the_end : ResultWriter::Grid::absent);
    has_results_ = true;
  };
  RunObserver writing = observer;
  writing.start = [&](const ResultHeader& of_run) {
    header = of_run;
    if (observer.start) observer.start(of_run);
  };
  writing.ready = [&] {
    if (observer.ready) observer.ready();
    replace_results();
  };
  writing.record = [&](StepRecord& step) {
    writer->append(step);
    draw(step);
    if (observer.record) observer.record(step);
  };
  writing.checkpoint = [&](long step, std::span<const double> state) {
    writer->checkpoint(state, step);
    if (observer.checkpoint) observer.checkpoint(step, state);
  };
  if (observer.setup) observer.setup("building the model");
  const TimedModel timed(scene_, shared);
  const VsiModel& model = timed.model();
  if (!from && observer.warning) {
    const auto steps = static_cast<double>(step_count(scene_.integration, run_duration(scene_, model)));
    const double results = planned_results(scene_, model, steps * scene_.integration.time_step).file;
    if (const std::string full = room_warning(file_, results); !full.empty()) observer.warning(full);
  }
  RunSummary summary = timed.counted(run_scene(scene_, model, writing, from));
  if (from && summary.complete) {
    summary.message = fmt::format("resumed at t = {:.6g} s: counts and times are of the part since then",
                                  static_cast<double>(summary.counted_from) * scene_.integration.time_step);
  }
  if (!writer && is_file(file_) && std::filesystem::file_size(file_) > 0) return summary;  // earlier results stay
  replace_results();  // with nothing but the reason, where no step was made
  writer->finish(summary, drawn ? drawn->take() : std::vector<StepRecord>{});
  return summary;
}

bool RecordedRun::is_resumable() const {
  return has_results_ && std::filesystem::exists(file_) && ResultWriter::read_checkpoint(file_).has_value();
}

void require_results_place(const std::filesystem::path& file, const SceneParameters& scene,
                           const std::filesystem::path& scene_file) {
  require_no_input(file, {scene_file});
  for (const std::filesystem::path& read : scene.files) require_no_input(file, {read});
  require_replaceable(file, {results_filetype});
}

void check_same_run(const RunResults& before, const SceneParameters& scene, const std::filesystem::path& file) {
  const std::string place = file.string();
  if (before.header.scene_text != scene.text) {
    throw input_error(place, "results of another scene", "results of this scene to resume, or another -o");
  }
  const std::vector<std::string>& sums = before.header.input_checksums;
  for (std::size_t i = 0; i < scene.files.size(); ++i) {
    if (i < sums.size() && file_checksum(scene.files[i]) == sums[i]) continue;
    throw input_error(place, fmt::format("results made with other contents of {}", scene.files[i].string()),
                      "the file as it was when the run began, or another -o");
  }
  if (before.header.program_version != version()) {
    throw input_error(place, "results of railtab " + before.header.program_version,
                      std::string("results of railtab ") + version());
  }
  const std::string& mode = before.summary.contact_mode;
  if (!mode.empty() && mode != contact_mode_name(scene.contact)) {
    throw input_error(place, fmt::format("results of --contact {}", mode),
                      "results of the same contact mode to resume");
  }
}

}  // namespace railtab
