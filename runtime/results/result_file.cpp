#include "railtab/runtime/results/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/checkpoint_slot.hpp"
#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {

namespace columns = result_columns;

namespace {

/// The slots of a file that hold a whole checkpoint. One that was made longer and then not written, by a kill or on a
/// full disk, cannot be read: the other one holds.
std::vector<CheckpointSlot> whole_checkpoints(const ArrayFileReader& in) {
  std::vector<CheckpointSlot> whole;
  for (const char* slot : columns::checkpoint_slots) {
    try {
      std::optional<CheckpointSlot> found = decode_checkpoint(in.read(slot).values);
      if (found) whole.push_back(std::move(*found));
    } catch (const InputError&) {
    }
  }
  return whole;
}

std::string motion_path(const columns::MotionGroup& group, const columns::MotionColumn& column) {
  return fmt::format("{}/{}", group.name, column.path);
}

ArrayFileReader open_results(const std::filesystem::path& file) {
  return ArrayFileReader(file, results_filetype, columns::format_version);
}

ResultHeader read_header(const ArrayFileReader& in) {
  ResultHeader header;
  for (const columns::HeaderText& text : columns::header_texts) header.*text.value = in.text("header", text.name);
  const std::vector<std::string> scene = in.read_strings("header/scene_text");
  if (!scene.empty()) header.scene_text = scene.front();
  for (const columns::HeaderTexts& list : columns::header_text_lists) header.*list.values = in.read_strings(list.path);
  header.speed = in.read("header/speed", {}).front();
  for (const columns::HeaderColumn& column : columns::header) header.*column.value = in.read(column.path, {-1});
  for (const columns::MotionGroup& group : columns::motion_groups) {
    header.*group.names = in.read_strings(fmt::format("{}/names", group.name));
  }
  return header;
}

constexpr std::int64_t most_count = 1'000'000'000'000'000;  // of anything in a run

std::string time_of(const columns::WheelExtremeEntry& entry) { return fmt::format("{}_time", entry.name); }
std::string wheel_of(const columns::WheelExtremeEntry& entry) { return fmt::format("{}_wheel", entry.name); }

RunSummary read_summary(const ArrayFileReader& in) {
  RunSummary summary;
  summary.message = in.text(columns::summary_group, "message");
  summary.contact_mode = in.text(columns::summary_group, "contact_mode");
  summary.complete = in.number(columns::summary_group, "complete") != 0.0;
  const std::vector<std::string> names = in.attribute_names(columns::summary_group);
  for (const auto& entry : columns::summary_counts) {
    if (!entry.in_all_files && std::find(names.begin(), names.end(), entry.name) == names.end()) continue;
    summary.*entry.value = in.whole_number(columns::summary_group, entry.name, 0, most_count);
  }
  for (const auto& entry : columns::summary_seconds) {
    summary.*entry.value = in.number(columns::summary_group, entry.name);
  }
  const long impacts = in.whole_number(columns::summary_group, columns::contact_energy_impacts, -1, most_count);
  if (impacts >= 0) {
    ContactEnergy& energy = summary.contact_energy.emplace();
    energy.impacts = impacts;
    for (const auto& entry : columns::summary_contact_energy) {
      energy.*entry.value = in.number(columns::summary_group, entry.name);
    }
  }
  const auto wheels = static_cast<std::int64_t>(in.read("header/static_wheel_load", {-1}).size());
  for (const auto& entry : columns::summary_wheel_extremes) {
    if (!std::ranges::count(names, wheel_of(entry))) continue;
    WheelExtreme& extreme = summary.wheel_extremes.*entry.value;
    extreme.value = in.number(columns::summary_group, entry.name);
    extreme.time = in.number(columns::summary_group, time_of(entry));
    extreme.wheel = static_cast<int>(in.whole_number(columns::summary_group, wheel_of(entry), -1, wheels - 1));
  }
  return summary;
}

void write_header(ArrayFileWriter& out, const ResultHeader& header) {
  out.attribute(
      "", "description",
      "Time histories of a train-track-bridge run. SI units; x forward, y right, z down; first index: record. "
      "Layout: docs/file_formats/results.md");
  for (const columns::HeaderText& text : columns::header_texts) out.attribute("header", text.name, header.*text.value);
  out.write("header/scene_text", std::vector<std::string>{header.scene_text}, "the scene that was run, TOML");
  for (const columns::HeaderTexts& list : columns::header_text_lists) {
    out.write(list.path, header.*list.values, list.description);
  }
  out.write("header/speed", {&header.speed, 1}, {}, "m/s", "speed of the train");
  for (const columns::HeaderColumn& column : columns::header) {
    const std::vector<double>& values = header.*column.value;
    out.write(column.path, values, {values.size()}, column.unit, column.description);
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    out.write(fmt::format("{}/names", group.name), header.*group.names, group.description);
  }
}

void create_histories(ArrayFileWriter& out, const ResultHeader& header) {
  for (const columns::StepColumn& column : columns::step) {
    out.create_growing(column.path, {}, column.unit, column.description);
  }
  const auto& iterations = columns::newton_iterations;
  out.create_growing(iterations.path, {}, iterations.unit, iterations.description);
  const std::size_t wheels = header.wheel_x.size();
  if (wheels > 0) {
    for (const columns::WheelColumn& column : columns::wheel) {
      out.create_growing(column.path, {wheels}, column.unit, column.description);
    }
    out.create_growing(columns::patches.path, {wheels}, columns::patches.unit, columns::patches.description);
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    const std::size_t members = (header.*group.names).size();
    if (members == 0) continue;
    for (const columns::MotionColumn& column : columns::motion) {
      out.create_growing(motion_path(group, column), {members, 6}, column.unit, column.description);
    }
  }
}

void write_summary(ArrayFileWriter& out, const RunSummary& summary) {
  constexpr std::size_t message_room = 1024, mode_room = 32;
  out.attribute(columns::summary_group, "message", summary.message, message_room);
  out.attribute(columns::summary_group, "contact_mode", summary.contact_mode, mode_room);
  for (const auto& entry : columns::summary_counts) {
    out.attribute(columns::summary_group, entry.name, static_cast<std::int64_t>(summary.*entry.value));
  }
  for (const auto& entry : columns::summary_seconds) {
    out.attribute(columns::summary_group, entry.name, summary.*entry.value);
  }
  const ContactEnergy energy = summary.contact_energy.value_or(ContactEnergy{.impacts = -1});
  out.attribute(columns::summary_group, columns::contact_energy_impacts, static_cast<std::int64_t>(energy.impacts));
  for (const auto& entry : columns::summary_contact_energy) {
    out.attribute(columns::summary_group, entry.name, energy.*entry.value);
  }
  for (const auto& entry : columns::summary_wheel_extremes) {
    const WheelExtreme& extreme = summary.wheel_extremes.*entry.value;
    out.attribute(columns::summary_group, entry.name, extreme.value);
    out.attribute(columns::summary_group, time_of(entry), extreme.time);
    out.attribute(columns::summary_group, wheel_of(entry), static_cast<std::int64_t>(extreme.wheel));
  }
  // Last: what says that all the others are true.
  out.attribute(columns::summary_group, "complete", static_cast<std::int64_t>(summary.complete));
}

RunSummary unfinished(const ResultHeader& header) {
  RunSummary summary;
  summary.contact_mode = header.contact_mode;
  summary.message = "the run is going on, or was ended from outside";
  return summary;
}

}  // namespace

struct ResultWriter::Impl {
  ArrayFileWriter out;
  int flush_every;
  std::size_t wheels, bodies, nodes;
  int buffered = 0;
  /// Rows that wait for the next flush, by dataset.
  std::map<std::string, std::vector<double>> rows;
  long checkpoints = 0;
  bool finished = false;

  Impl(ArrayFileWriter&& writer, int every, const ResultHeader& header)
      : out(std::move(writer)),
        flush_every(every),
        wheels(header.wheel_x.size()),
        bodies(header.body_names.size()),
        nodes(header.node_names.size()) {
    assert(every >= 1);
  }

  void flush() {
    for (auto& [path, values] : rows) {
      out.append(path, values);
      values.clear();
    }
    buffered = 0;
    out.flush();
  }
};

ResultWriter::ResultWriter(const std::filesystem::path& file, const ResultHeader& header, int flush_every)
    : impl_(std::make_unique<Impl>(
          ArrayFileWriter(file, results_filetype, columns::format_version, ArrayFileWriter::Mode::growing), flush_every,
          header)) {
  write_header(impl_->out, header);
  create_histories(impl_->out, header);
  write_summary(impl_->out, unfinished(header));
  for (const char* slot : columns::checkpoint_slots) {
    impl_->out.create_slot(
        slot, "1",
        "sequence, step, records, length of the state, checksum (upper and lower 32 bits), state of the solver");
  }
}

ResultWriter::ResultWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

ResultWriter ResultWriter::resume(const std::filesystem::path& file, const Checkpoint& from, int flush_every) {
  ResultHeader header;
  long checkpoints = 0;
  {
    const ArrayFileReader in = open_results(file);
    header = read_header(in);
    header.contact_mode = in.text(columns::summary_group, "contact_mode");
    for (const CheckpointSlot& slot : whole_checkpoints(in)) checkpoints = std::max(checkpoints, slot.sequence);
  }
  ArrayFileWriter out = ArrayFileWriter::reopen(file, results_filetype, columns::format_version);
  if (from.records > out.records()) {
    throw input_error(file.string(), fmt::format("{} records", out.records()),
                      fmt::format("the {} of its checkpoint", from.records));
  }
  out.truncate(from.records);
  write_summary(out, unfinished(header));
  auto impl = std::make_unique<Impl>(std::move(out), flush_every, header);
  impl->checkpoints = checkpoints;
  return ResultWriter(std::move(impl));
}

ResultWriter::~ResultWriter() {
  if (!impl_ || impl_->finished) return;
  try {
    impl_->flush();
    impl_->out.close();
  } catch (const ComputationError&) {
    // The file keeps what was flushed before, and says that it is incomplete.
  }
}

ResultWriter::ResultWriter(ResultWriter&&) noexcept = default;

void ResultWriter::append(const StepRecord& record) {
  assert(record.wheels.size() == impl_->wheels && record.bodies.size() == impl_->bodies &&
         record.nodes.size() == impl_->nodes);
  auto& rows = impl_->rows;
  for (const columns::StepColumn& column : columns::step) rows[column.path].push_back(record.*column.value);
  rows[columns::newton_iterations.path].push_back(record.newton_iterations);
  if (!record.wheels.empty()) {
    for (const columns::WheelColumn& column : columns::wheel) {
      std::vector<double>& values = rows[column.path];
      for (const WheelRecord& wheel : record.wheels) values.push_back(wheel.*column.value);
    }
    for (const WheelRecord& wheel : record.wheels) rows[columns::patches.path].push_back(wheel.patches);
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    if ((record.*group.motions).empty()) continue;
    for (const columns::MotionColumn& column : columns::motion) {
      std::vector<double>& values = rows[motion_path(group, column)];
      for (const MotionRecord& motion : record.*group.motions) {
        const auto& components = motion.*column.value;
        values.insert(values.end(), std::begin(components), std::end(components));
      }
    }
  }
  if (++impl_->buffered >= impl_->flush_every) impl_->flush();
}

void ResultWriter::checkpoint(std::span<const double> state, long step) {
  impl_->flush();
  const long sequence = ++impl_->checkpoints;
  const auto slot = columns::checkpoint_slots[static_cast<std::size_t>(sequence) % columns::checkpoint_slots.size()];
  impl_->out.replace(slot, encode_checkpoint(sequence, step, impl_->out.records(), state));
  impl_->out.flush();
}

std::optional<Checkpoint> ResultWriter::read_checkpoint(const std::filesystem::path& file) {
  const ArrayFileReader in = open_results(file);
  std::vector<CheckpointSlot> whole = whole_checkpoints(in);
  // A file that was cut back to its older checkpoint still holds the newer one, whose records are gone.
  std::erase_if(whole, [&](const CheckpointSlot& slot) { return slot.checkpoint.records > in.records(); });
  const auto newest =
      std::max_element(whole.begin(), whole.end(),
                       [](const CheckpointSlot& a, const CheckpointSlot& b) { return a.sequence < b.sequence; });
  if (newest == whole.end()) return std::nullopt;
  return std::move(newest->checkpoint);
}

void ResultWriter::finish(const RunSummary& summary) {
  impl_->flush();
  write_summary(impl_->out, summary);
  impl_->out.close();
  impl_->finished = true;
}

namespace {

/// Counts are stored as numbers like all others.
int small_count(double value, std::string_view path) {
  constexpr double most = 1e9;
  if (!(value >= 0.0 && value <= most)) throw input_error(path, fmt::format("{}", value), "a count");
  return static_cast<int>(value);
}

void read_wheels(const ArrayFileReader& in, long wheels, std::vector<StepRecord>& steps) {
  const std::vector<long> shape{static_cast<long>(steps.size()), wheels};
  const std::size_t count = static_cast<std::size_t>(wheels);
  for (StepRecord& step : steps) step.wheels.resize(count);
  for (const columns::WheelColumn& column : columns::wheel) {
    const std::vector<double> values = in.read(column.path, shape);
    for (std::size_t i = 0; i < values.size(); ++i) steps[i / count].wheels[i % count].*column.value = values[i];
  }
  const std::vector<double> patches = in.read(columns::patches.path, shape);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    steps[i / count].wheels[i % count].patches = small_count(patches[i], columns::patches.path);
  }
}

void read_motions(const ArrayFileReader& in, const columns::MotionGroup& group, long members,
                  std::vector<StepRecord>& steps) {
  const std::size_t count = static_cast<std::size_t>(members);
  for (StepRecord& step : steps) (step.*group.motions).resize(count);
  for (const columns::MotionColumn& column : columns::motion) {
    const std::vector<double> values =
        in.read(motion_path(group, column), {static_cast<long>(steps.size()), members, 6});
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t member = i / 6;
      ((steps[member / count].*group.motions)[member % count].*column.value)[i % 6] = values[i];
    }
  }
}

}  // namespace

ResultHeader read_result_header(const std::filesystem::path& file) { return read_header(open_results(file)); }

RunSummary read_run_summary(const std::filesystem::path& file) { return read_summary(open_results(file)); }

RunResults read_results(const std::filesystem::path& file) {
  const ArrayFileReader in = open_results(file);
  RunResults results{read_header(in), read_summary(in), std::vector<StepRecord>(in.records())};
  std::vector<StepRecord>& steps = results.steps;
  const std::vector<long> scalar_shape{static_cast<long>(steps.size())};
  for (const columns::StepColumn& column : columns::step) {
    const std::vector<double> values = in.read(column.path, scalar_shape);
    for (std::size_t i = 0; i < values.size(); ++i) steps[i].*column.value = values[i];
  }
  const std::vector<double> iterations = in.read(columns::newton_iterations.path, scalar_shape);
  for (std::size_t i = 0; i < iterations.size(); ++i) {
    steps[i].newton_iterations = small_count(iterations[i], columns::newton_iterations.path);
  }
  if (!results.header.wheel_x.empty()) read_wheels(in, static_cast<long>(results.header.wheel_x.size()), steps);
  for (const columns::MotionGroup& group : columns::motion_groups) {
    const std::vector<std::string>& names = results.header.*group.names;
    if (!names.empty()) read_motions(in, group, static_cast<long>(names.size()), steps);
  }
  return results;
}

}  // namespace railtab
