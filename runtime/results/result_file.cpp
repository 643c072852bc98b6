#include "railtab/runtime/results/result_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <exception>
#include <limits>
#include <map>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/checkpoint_slot.hpp"
#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/runtime/results/vtkhdf_group.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/file_fields.hpp"

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

template <typename Column>
Field field_of(const Column& column, std::vector<std::string> shape) {
  return {column.path, std::move(shape), column.unit, column.description};
}

Field field_of(const columns::StepColumn& column) {
  Field field = field_of(column, {"records"});
  if (column.value == &StepRecord::time) field.values = Field::Values::increasing;
  return field;
}

const Field iterations_field = field_of(columns::newton_iterations, {"records"});
const Field patches_field = field_of(columns::patches, {"records", "wheels"});
const Field source_field = field_of(columns::from_table, {"records", "wheels"});
const Field speed_field{"header/speed", {}, "m/s", "speed of the train"};
const Field scene_field{"header/scene_text", {"1"}, "text", "the scene that was run, TOML"};

Field field_of(const columns::WheelColumn& column) { return field_of(column, {"records", "wheels"}); }
Field field_of(const columns::HeaderColumn& column) { return field_of(column, {column.dimension}); }
Field field_of(const columns::HeaderTexts& texts) { return {texts.path, {texts.dimension}, "text", texts.description}; }
Field field_of(const columns::MotionGroup& group) {
  return {fmt::format("{}/names", group.name), {group.name}, "text", group.description};
}
Field field_of(const columns::MotionGroup& group, const columns::MotionColumn& column) {
  return {fmt::format("{}/{}", group.name, column.path), {"records", group.name, "6"}, column.unit, column.description};
}

ArrayFileReader open_results(const std::filesystem::path& file) {
  return ArrayFileReader(file, results_filetype, columns::format_version);
}

const Field deck_field{columns::deck_quantities, {"quantities"}, "text", "what is followed on the decks"};
const Field deck_unit_field{"deck/units", {"quantities"}, "text", "their units"};
const Field deck_cut_off_field{columns::deck_cut_off, {}, "Hz", "of the filtered acceleration"};

Field field_of(const columns::DeckPlaceColumn& column, const DeckPlaces& places) {
  return {fmt::format("deck/{}/{}", places.quantity, column.name),
          {fmt::format("places of {}", places.quantity)},
          "m",
          column.description};
}
std::string path_of(const columns::DeckExtremeColumn& column, const DeckPlaces& places) {
  return fmt::format("deck/{}/{}", places.quantity, column.name);
}

void read_deck_places(const ArrayFileReader& in, FieldReader& fields, ResultHeader& header) {
  if (!in.contains(deck_field.path)) return;
  const std::vector<std::string> quantities = fields.texts(deck_field), units = fields.texts(deck_unit_field);
  header.deck_cut_off = fields.numbers(deck_cut_off_field).front();
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    DeckPlaces& places = header.deck.emplace_back(DeckPlaces{quantities[q], units[q]});
    for (const auto& column : columns::deck_places) places.*column.values = fields.numbers(field_of(column, places));
  }
}

/// Over all extremes, in their order; 52 bits, which a reader of numbers keeps.
std::int64_t deck_checksum_of(const std::vector<DeckExtremes>& deck) {
  std::uint64_t sum = checksum_seed;
  for (const DeckExtremes& extremes : deck) {
    for (const auto& column : columns::deck_extremes) sum = checksum(extremes.*column.values, sum);
  }
  return static_cast<std::int64_t>(sum >> 12U);
}

/// None of a run that has not ended.
std::vector<DeckExtremes> read_deck_extremes(const ArrayFileReader& in, const ResultHeader& header) {
  std::vector<DeckExtremes> deck;
  for (const DeckPlaces& places : header.deck) {
    DeckExtremes& extremes = deck.emplace_back();
    for (const auto& column : columns::deck_extremes) {
      std::vector<double> values = in.read(path_of(column, places)).values;
      if (values.empty() || std::isnan(values.front())) return {};
      if (values.size() != places.x.size()) {
        throw input_error(fmt::format("{}: {}", in.file().string(), path_of(column, places)),
                          fmt::format("{} values", values.size()),
                          fmt::format("{}, one of each place", places.x.size()));
      }
      extremes.*column.values = std::move(values);
    }
  }
  if (header.deck.empty()) return deck;
  constexpr std::int64_t most = std::int64_t{1} << 52;
  if (in.whole_number(columns::deck_group, columns::deck_checksum, 0, most) != deck_checksum_of(deck)) {
    throw input_error(fmt::format("{}: {}", in.file().string(), columns::deck_group),
                      "extremes that are not those that were written", "a file as it was written");
  }
  return deck;
}

ResultHeader read_header(const ArrayFileReader& in, FieldReader& fields) {
  ResultHeader header;
  for (const columns::HeaderText& text : columns::header_texts) header.*text.value = in.text("header", text.name);
  header.scene_text = fields.texts(scene_field).front();
  for (const columns::HeaderTexts& list : columns::header_text_lists) {
    if (list.in_all_files || in.contains(list.path)) header.*list.values = fields.texts(field_of(list));
  }
  header.speed = fields.numbers(speed_field).front();
  for (const columns::HeaderColumn& column : columns::header) {
    if (column.in_all_files) header.*column.values = fields.numbers(field_of(column));
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    header.*group.names = fields.texts(field_of(group));
  }
  for (const columns::HeaderColumn& column : columns::header) {  // which agree with the names in number
    if (!column.in_all_files && in.contains(column.path)) header.*column.values = fields.numbers(field_of(column));
  }
  read_deck_places(in, fields, header);
  if (header.wheel_x.size() % 2 != 0) {
    throw input_error(fmt::format("{}: header/wheel_x", in.file().string()),
                      fmt::format("{} wheels", header.wheel_x.size()),
                      "an even number: left and right of each wheelset");
  }
  if (const std::vector<double>& ends = header.judged;
      !ends.empty() && !(ends.size() == 2 && ends.front() <= ends.back())) {
    throw input_error(fmt::format("{}: header/judged", in.file().string()), fmt::format("{}", fmt::join(ends, ", ")),
                      "begin and end of a stretch");
  }
  return header;
}

constexpr std::int64_t most_count = 1'000'000'000'000'000;  // of anything in a run

std::string time_of(const columns::WheelExtremeEntry& entry) { return fmt::format("{}_time", entry.name); }
std::string wheel_of(const columns::WheelExtremeEntry& entry) { return fmt::format("{}_wheel", entry.name); }

RunSummary read_summary(const ArrayFileReader& in, std::size_t wheels) {
  const FieldReader fields(in);
  RunSummary summary;
  summary.message = in.text(columns::summary_group, "message");
  summary.contact_mode = in.text(columns::summary_group, "contact_mode");
  summary.complete = in.whole_number(columns::summary_group, "complete", 0, 1) != 0;
  const std::vector<std::string> names = in.attribute_names(columns::summary_group);
  const auto lacks = [&](const auto& entry) {
    return !entry.in_all_files && std::find(names.begin(), names.end(), entry.name) == names.end();
  };
  for (const auto& entry : columns::summary_counts) {
    if (lacks(entry)) continue;
    summary.*entry.value = in.whole_number(columns::summary_group, entry.name, 0, most_count);
  }
  for (const auto& entry : columns::summary_numbers) {
    if (lacks(entry)) continue;
    summary.*entry.value = fields.number(columns::summary_group, entry.name);
  }
  const long impacts = in.whole_number(columns::summary_group, columns::contact_energy_impacts, -1, most_count);
  if (impacts >= 0) {
    ContactEnergy& energy = summary.contact_energy.emplace();
    energy.impacts = impacts;
    for (const auto& entry : columns::summary_contact_energy) {
      energy.*entry.value = fields.number(columns::summary_group, entry.name);
    }
  }
  if (std::ranges::count(names, std::string(columns::summary_stop_names.front().first))) {
    StopSummary stops;
    for (const auto& [name, value] : columns::summary_stop_names) stops.*value = in.text(columns::summary_group, name);
    for (const auto& [name, value] : columns::summary_stops) {
      stops.*value = fields.number(columns::summary_group, name);
    }
    if (!stops.first_name.empty()) summary.stops = std::move(stops);
  }
  const std::int64_t last_wheel = static_cast<std::int64_t>(wheels) - 1;
  for (const auto& entry : columns::summary_wheel_extremes) {
    if (!std::ranges::count(names, wheel_of(entry))) continue;
    WheelExtreme& extreme = summary.wheel_extremes.*entry.value;
    extreme.value = fields.number(columns::summary_group, entry.name);
    extreme.time = fields.number(columns::summary_group, time_of(entry));
    extreme.wheel = static_cast<int>(in.whole_number(columns::summary_group, wheel_of(entry), -1, last_wheel));
  }
  return summary;
}

void write_header(ArrayFileWriter& out, const ResultHeader& header) {
  out.attribute(
      "", "description",
      "Time histories of a train-track-bridge run. SI units; x forward, y right, z down; first index: record. "
      "Layout: docs/file_formats/results.md");
  for (const columns::HeaderText& text : columns::header_texts) out.attribute("header", text.name, header.*text.value);
  FieldWriter fields(out);
  fields.write(scene_field, std::vector<std::string>{header.scene_text});
  for (const columns::HeaderTexts& list : columns::header_text_lists) {
    if (list.in_all_files || !(header.*list.values).empty()) fields.write(field_of(list), header.*list.values);
  }
  fields.write(speed_field, std::array{header.speed});
  for (const columns::HeaderColumn& column : columns::header) {
    if (column.in_all_files || !(header.*column.values).empty()) fields.write(field_of(column), header.*column.values);
  }
  for (const columns::MotionGroup& group : columns::motion_groups) fields.write(field_of(group), header.*group.names);
}

void create_deck(ArrayFileWriter& out, const ResultHeader& header) {
  if (header.deck.empty()) return;
  FieldWriter fields(out);
  std::vector<std::string> quantities, units;
  for (const DeckPlaces& places : header.deck) {
    quantities.push_back(places.quantity);
    units.push_back(places.unit);
  }
  fields.write(deck_field, quantities);
  fields.write(deck_unit_field, units);
  fields.write(deck_cut_off_field, std::array{header.deck_cut_off});
  for (const DeckPlaces& places : header.deck) {
    for (const auto& column : columns::deck_places) fields.write(field_of(column, places), places.*column.values);
    for (const auto& column : columns::deck_extremes) {
      out.create_slot(path_of(column, places), column.is_time ? "s" : places.unit, column.description);
    }
  }
  out.attribute(columns::deck_group, columns::deck_checksum, std::int64_t{0});
}

void write_deck(ArrayFileWriter& out, const std::vector<DeckPlaces>& deck, const std::vector<DeckExtremes>& extremes) {
  if (extremes.empty()) return;
  assert(extremes.size() == deck.size());
  for (std::size_t q = 0; q < deck.size(); ++q) {
    for (const auto& column : columns::deck_extremes) {
      out.replace(path_of(column, deck[q]), extremes[q].*column.values);
    }
  }
  out.attribute(columns::deck_group, columns::deck_checksum, deck_checksum_of(extremes));
}

void create_histories(ArrayFileWriter& out, const ResultHeader& header) {
  FieldWriter fields(out);
  fields.set("wheels", header.wheel_x.size());
  for (const columns::StepColumn& column : columns::step) fields.create_growing(field_of(column));
  fields.create_growing(iterations_field);
  if (!header.wheel_x.empty()) {
    for (const columns::WheelColumn& column : columns::wheel) fields.create_growing(field_of(column));
    fields.create_growing(patches_field);
    fields.create_growing(source_field);
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    const std::size_t members = (header.*group.names).size();
    if (members == 0) continue;
    fields.set(group.name, members);
    for (const columns::MotionColumn& column : columns::motion) fields.create_growing(field_of(group, column));
  }
}

void write_summary(ArrayFileWriter& out, const RunSummary& summary) {
  constexpr std::size_t message_room = 1024, mode_room = 32;
  out.attribute(columns::summary_group, "message", summary.message, message_room);
  out.attribute(columns::summary_group, "contact_mode", summary.contact_mode, mode_room);
  for (const auto& entry : columns::summary_counts) {
    out.attribute(columns::summary_group, entry.name, static_cast<std::int64_t>(summary.*entry.value));
  }
  for (const auto& entry : columns::summary_numbers) {
    out.attribute(columns::summary_group, entry.name, summary.*entry.value);
  }
  const ContactEnergy energy = summary.contact_energy.value_or(ContactEnergy{.impacts = -1});
  out.attribute(columns::summary_group, columns::contact_energy_impacts, static_cast<std::int64_t>(energy.impacts));
  for (const auto& entry : columns::summary_contact_energy) {
    out.attribute(columns::summary_group, entry.name, energy.*entry.value);
  }
  const StopSummary stops = summary.stops.value_or(StopSummary{});
  for (const auto& [name, value] : columns::summary_stop_names) {
    out.attribute(columns::summary_group, name, stops.*value, message_room);
  }
  for (const auto& [name, value] : columns::summary_stops) out.attribute(columns::summary_group, name, stops.*value);
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
  ResultHeader header;
  Grid grid = Grid::absent;
  int buffered = 0;
  /// Rows that wait for the next flush, by dataset.
  std::map<std::string, std::vector<double>> rows;
  std::vector<std::vector<double>*> in_order;  ///< of rows, as append() fills them: the same for every record
  long checkpoints = 0;
  bool finished = false;
  bool has_source = true;  // else an older file that is resumed

  Impl(ArrayFileWriter&& writer, int every, ResultHeader of_run, Grid with_grid)
      : out(std::move(writer)), flush_every(every), header(std::move(of_run)), grid(with_grid) {
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

ResultWriter::ResultWriter(const std::filesystem::path& file, const ResultHeader& header, int flush_every, Grid grid)
    : impl_(std::make_unique<Impl>(
          ArrayFileWriter(file, results_filetype, columns::format_version, ArrayFileWriter::Mode::growing), flush_every,
          header, grid)) {
  write_header(impl_->out, header);
  create_histories(impl_->out, header);
  create_deck(impl_->out, header);
  write_summary(impl_->out, unfinished(header));
  for (const char* slot : columns::checkpoint_slots) {
    impl_->out.create_slot(
        slot, "1",
        "sequence, step, records, length of the state, checksum (upper and lower 32 bits), state of the solver");
  }
  if (grid != Grid::absent) vtkhdf::create(impl_->out);
}

ResultWriter::ResultWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

ResultWriter ResultWriter::resume(const std::filesystem::path& file, const Checkpoint& from, int flush_every) {
  ResultHeader header;
  long checkpoints = 0;
  bool has_source = true;
  Grid grid = Grid::absent;
  {
    const ArrayFileReader in = open_results(file);
    FieldReader fields(in);
    header = read_header(in, fields);
    has_source = in.contains(source_field.path);
    if (vtkhdf::is_in(in)) grid = Grid::at_the_end;
    header.contact_mode = in.text(columns::summary_group, "contact_mode");
    for (const CheckpointSlot& slot : whole_checkpoints(in)) checkpoints = std::max(checkpoints, slot.sequence);
  }
  ArrayFileWriter out = ArrayFileWriter::reopen(file, results_filetype, columns::format_version);
  if (from.records > out.records()) {
    throw input_error(file.string(), fmt::format("{} records", out.records()),
                      fmt::format("the {} of its checkpoint", from.records));
  }
  out.truncate(from.records);
  for (const DeckPlaces& places : header.deck) {  // those of the part before are no longer true
    for (const auto& column : columns::deck_extremes) out.replace(path_of(column, places), {});
  }
  write_summary(out, unfinished(header));
  if (grid != Grid::absent) vtkhdf::invalidate(out);
  auto impl = std::make_unique<Impl>(std::move(out), flush_every, std::move(header), grid);
  impl->checkpoints = checkpoints;
  impl->has_source = has_source;
  return ResultWriter(std::move(impl));
}

ResultWriter::~ResultWriter() {
  if (!impl_ || impl_->finished) return;
  try {
    impl_->flush();
    impl_->out.close();
  } catch (const std::exception&) {
    // The file keeps what was flushed before, and says that it is incomplete.
  }
}

ResultWriter::ResultWriter(ResultWriter&&) noexcept = default;

void ResultWriter::append(const StepRecord& record) {
  assert(record.wheels.size() == impl_->header.wheel_x.size() &&
         record.bodies.size() == impl_->header.body_names.size() &&
         record.nodes.size() == impl_->header.node_names.size());
  std::vector<std::vector<double>*>& in_order = impl_->in_order;
  std::size_t filled = 0;
  const auto next = [&](const auto& path) -> std::vector<double>& {
    if (filled == in_order.size()) in_order.push_back(&impl_->rows[path()]);
    return *in_order[filled++];
  };
  for (const columns::StepColumn& column : columns::step) {
    next([&] { return column.path; }).push_back(record.*column.value);
  }
  next([] { return columns::newton_iterations.path; }).push_back(record.newton_iterations);
  if (!record.wheels.empty()) {
    for (const columns::WheelColumn& column : columns::wheel) {
      std::vector<double>& values = next([&] { return column.path; });
      for (const WheelRecord& wheel : record.wheels) values.push_back(wheel.*column.value);
    }
    std::vector<double>& patches = next([] { return columns::patches.path; });
    for (const WheelRecord& wheel : record.wheels) patches.push_back(wheel.patches);
    if (impl_->has_source) {
      std::vector<double>& from_table = next([] { return columns::from_table.path; });
      for (const WheelRecord& wheel : record.wheels) from_table.push_back(wheel.from_table);
    }
  }
  for (const columns::MotionGroup& group : columns::motion_groups) {
    if ((record.*group.motions).empty()) continue;
    for (const columns::MotionColumn& column : columns::motion) {
      std::vector<double>& values = next([&] { return field_of(group, column).path; });
      for (const MotionRecord& motion : record.*group.motions) {
        const auto& components = motion.*column.value;
        values.insert(values.end(), std::begin(components), std::end(components));
      }
    }
  }
  assert(filled == in_order.size());
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

void ResultWriter::finish(const RunSummary& summary, std::span<const StepRecord> drawn) {
  impl_->flush();
  write_deck(impl_->out, impl_->header.deck, summary.deck);
  if (impl_->grid != Grid::absent && !drawn.empty()) {
    vtkhdf::write(impl_->out, drawing::moving_grid(impl_->header, drawn));
  }
  write_summary(impl_->out, summary);
  impl_->out.close();
  impl_->finished = true;
}

namespace {

/// Counts are stored as numbers like all others.
std::vector<double> read_counts(const ArrayFileReader& in, FieldReader& fields, const Field& field) {
  constexpr double most = 1e9;
  std::vector<double> values = fields.numbers(field);
  for (const double value : values) {
    if (value >= 0.0 && value <= most && value == std::floor(value)) continue;
    throw input_error(fmt::format("{}: {}", in.file().string(), field.path), fmt::format("{}", value), "a count");
  }
  return values;
}

void read_wheels(const ArrayFileReader& in, FieldReader& fields, std::size_t count, std::vector<StepRecord>& steps) {
  const std::vector<double> patches = read_counts(in, fields, patches_field);
  for (StepRecord& step : steps) step.wheels.resize(count);  // only now is it sure that the file has so many
  for (std::size_t i = 0; i < patches.size(); ++i) {
    steps[i / count].wheels[i % count].patches = static_cast<int>(patches[i]);
  }
  const bool has_source = in.contains(source_field.path);
  const std::vector<double> source = has_source ? read_counts(in, fields, source_field) : std::vector<double>{};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    steps[i / count].wheels[i % count].from_table = has_source ? static_cast<int>(source[i]) : -1;
  }
  constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
  for (const columns::WheelColumn& column : columns::wheel) {
    const bool absent = !column.in_all_files && !in.contains(column.path);
    const std::vector<double> values =
        absent ? std::vector<double>(patches.size(), not_known) : fields.numbers(field_of(column));
    for (std::size_t i = 0; i < values.size(); ++i) steps[i / count].wheels[i % count].*column.value = values[i];
  }
}

void read_motions(FieldReader& fields, const columns::MotionGroup& group, std::size_t count,
                  std::vector<StepRecord>& steps) {
  for (const columns::MotionColumn& column : columns::motion) {
    const std::vector<double> values = fields.numbers(field_of(group, column));
    for (StepRecord& step : steps) (step.*group.motions).resize(count);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t member = i / 6;
      ((steps[member / count].*group.motions)[member % count].*column.value)[i % 6] = values[i];
    }
  }
}

}  // namespace

RunSummary read_run_summary(const std::filesystem::path& file) {
  const ArrayFileReader in = open_results(file);
  FieldReader fields(in);
  return read_summary(in, read_header(in, fields).wheel_x.size());
}

RunResults read_results(const std::filesystem::path& file) {
  const ArrayFileReader in = open_results(file);
  FieldReader fields(in);
  fields.set("records", in.records(), "");
  RunResults results;
  results.header = read_header(in, fields);
  results.summary = read_summary(in, results.header.wheel_x.size());
  results.summary.deck = read_deck_extremes(in, results.header);
  std::vector<StepRecord>& steps = results.steps;
  for (const columns::StepColumn& column : columns::step) {
    const std::vector<double> values = fields.numbers(field_of(column));
    steps.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) steps[i].*column.value = values[i];
  }
  const std::vector<double> iterations = read_counts(in, fields, iterations_field);
  for (std::size_t i = 0; i < iterations.size(); ++i) steps[i].newton_iterations = static_cast<int>(iterations[i]);
  if (!results.header.wheel_x.empty()) read_wheels(in, fields, results.header.wheel_x.size(), steps);
  for (const columns::MotionGroup& group : columns::motion_groups) {
    const std::vector<std::string>& names = results.header.*group.names;
    if (!names.empty()) read_motions(fields, group, names.size(), steps);
  }
  if (vtkhdf::is_in(in)) vtkhdf::check(in, steps);
  return results;
}

}  // namespace railtab
