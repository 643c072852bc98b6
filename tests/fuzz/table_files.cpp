#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <vector>

#include "../unit/small_geometry_table.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/runtime/results/checkpoint_slot.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/creep_table.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "railtab/tables/geometry_table.hpp"
#include "reading.hpp"

namespace railtab::fuzz {

namespace {

/// One line "name index value".
struct Change {
  std::string name, index;
  double value = 0.0;
};

std::vector<Change> changes_of(const Path& file) {
  std::vector<Change> changes;
  std::ifstream stream(file);
  constexpr std::size_t most = 50;
  for (std::string line; changes.size() < most && std::getline(stream, line);) {
    std::istringstream words(line);
    Change change;
    std::string value;
    words >> change.name >> change.index >> value;
    char* end = nullptr;
    change.value = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0') throw input_error(file.string(), line, "name index value");
    changes.push_back(change);
  }
  return changes;
}

/// A number that a file could hold in this place.
template <class Number>
Number stored(double value) {
  if constexpr (std::is_floating_point_v<Number>) {
    return static_cast<Number>(value);
  } else {
    constexpr double low = static_cast<double>(std::numeric_limits<Number>::min());
    constexpr double high = static_cast<double>(std::numeric_limits<Number>::max()) / 2;
    return value >= low && value <= high ? static_cast<Number>(value) : std::numeric_limits<Number>::max();
  }
}

template <class Number>
void change(std::vector<Number>& values, const Change& change) {
  constexpr double most = 5000;
  if (change.index == "size") {
    if (change.value >= 0.0 && change.value <= most) values.resize(static_cast<std::size_t>(change.value));
    return;
  }
  const std::size_t index = std::strtoul(change.index.c_str(), nullptr, 10);
  if (!values.empty()) values[index % values.size()] = stored<Number>(change.value);
}

void change(TableAxis& axis, const Change& change) {
  if (change.index == "low") axis.low = change.value;
  if (change.index == "high") axis.high = change.value;
  if (change.index == "cells") axis.cells = std::clamp(stored<int>(change.value), 1, most_axis_cells);
}

void look_up(const GeometryTable& table) {
  double sum = 0.0;
  for (const double y : {-0.0041, -0.004, -0.001, 0.0, 0.0007, 0.005}) {
    for (const double yaw : {0.0, 0.01, -0.02}) {
      for (const double roll : {-0.002, 0.0, 0.0013}) {
        const GeometryTable::Lookup found = table.lookup(y, -0.46, yaw, roll);
        for (int n = 0; n < found.count; ++n) sum += found.branch[static_cast<std::size_t>(n)].z_touch;
      }
    }
  }
  static_cast<void>(sum);
}

CreepTableData small_creep_table() {
  CreepTableData table;
  table.layout = CreepTableLayout::paper;
  table.nodes = {{{0.5, 2.0}, {0.0, 1.0, 3.0}, {0.0, 0.5}, {-1.0, 0.0, 1.0}}};
  table.values.assign(3 * 2 * 3 * 2 * 3, 0.25);
  return table;
}

}  // namespace

void read_geometry_file(const Path& file) { look_up(GeometryTable(read_geometry_table(file))); }

void read_creep_file(const Path& file) { static_cast<void>(CreepTable(read_creep_table(file))); }

void read_result_file(const Path& file) {
  static_cast<void>(read_results(file));
  static_cast<void>(ResultWriter::read_checkpoint(file));
}

void write_geometry_seed(const Path& file) { write_geometry_table(file, small_geometry_table()); }

void write_creep_seed(const Path& file) {
  std::filesystem::copy_file(RAILTAB_SOURCE_DIR "/tables/data/creep_table_nu028.h5", file);
}

void write_result_seed(const Path& file) {
  ResultHeader header;
  header.wheel_x = {0.0, 0.0};
  header.static_wheel_load = {1.0, 1.0};
  header.body_names = {"body"};
  ResultWriter out(file, header, 2);
  for (int i = 0; i < 5; ++i) {
    StepRecord record;
    record.time = i;
    record.wheels.resize(2);
    record.bodies.resize(1);
    out.append(record);
  }
  out.checkpoint(std::vector<double>{1.0, 2.0, 3.0}, 5);
}

void change_geometry_numbers(const Path& file) {
  GeometryTableData table = small_geometry_table();
  for (const Change& c : changes_of(file)) {
    if (c.name == "node") change(table.node, c);
    if (c.name == "leaf_branch") change(table.leaf_branch, c);
    if (c.name == "trusted_lowering") change(table.trusted_lowering, c);
    if (c.name == "coefficient") change(table.coefficient, c);
    if (c.name == "lateral") change(table.lateral, c);
    if (c.name == "yaw_squared") change(table.yaw_squared, c);
    if (c.name == "roll") change(table.roll, c);
    if (c.name == "nominal_radius") table.nominal_radius = c.value;
    if (c.name == "track_gauge") table.track_gauge = c.value;
    for (ProfileKnots* profile : {&table.wheel, &table.rail}) {
      const std::string side = profile == &table.wheel ? "wheel." : "rail.";
      if (c.name == side + "s") change(profile->s, c);
      if (c.name == side + "y") change(profile->y, c);
      if (c.name == side + "z") change(profile->z, c);
      if (c.name == side + "dy") change(profile->dy, c);
      if (c.name == side + "dz") change(profile->dz, c);
    }
  }
  const GeometryTable whole(table);
  look_up(whole);
  try {
    static_cast<void>(TableContact(GeometryTable(std::move(table))));
  } catch (const InputError&) {  // made-up profiles need not be a pair
  }
}

void change_creep_numbers(const Path& file) {
  CreepTableData table = small_creep_table();
  for (const Change& c : changes_of(file)) {
    for (std::size_t axis = 0; axis < table.nodes.size(); ++axis) {
      if (c.name == "axis" + std::to_string(axis)) change(table.nodes[axis], c);
    }
    if (c.name == "values") change(table.values, c);
    if (c.name == "smooth") table.layout = CreepTableLayout::smooth;
    if (c.name == "ratio_stretch") table.ratio_stretch = c.value;
    if (c.name == "radius_unit") table.radius_unit = c.value;
  }
  std::size_t values = 3;
  for (const std::vector<double>& nodes : table.nodes) values *= std::max<std::size_t>(nodes.size(), 1);
  constexpr std::size_t most = 1'000'000;
  if (values <= most) table.values.resize(values);
  const CreepTable whole(std::move(table));
  for (const double ratio : {0.5, 1.0, 2.0}) {
    for (const double creepage : {-3.0, 0.0, 1e-12, 0.5, 3.0, 1e3}) {
      static_cast<void>(whole.lookup(ratio, {creepage, 0.5 * creepage, -creepage}));
    }
  }
}

void change_checkpoint_numbers(const Path& file) {
  std::vector<double> slot = encode_checkpoint(3, 500, 5, std::vector<double>{1.0, 2.0, 3.0});
  for (const Change& c : changes_of(file)) {
    if (c.name == "slot") change(slot, c);
  }
  constexpr std::size_t counters = 4, head = 6;
  if (slot.size() >= head && slot[counters - 1] >= 0.0 &&
      slot[counters - 1] <= static_cast<double>(slot.size() - head)) {
    const std::span<const double> state = std::span(slot).subspan(head, static_cast<std::size_t>(slot[counters - 1]));
    const std::span<const double> counts = std::span(slot).first(counters);
    const std::uint64_t sum = word_checksum(std::as_bytes(state), word_checksum(std::as_bytes(counts)));
    slot[counters] = static_cast<double>(sum >> 32U);
    slot[counters + 1] = static_cast<double>(sum & 0xffffffffU);
  }
  if (!decode_checkpoint(slot)) throw input_error(file.string(), "no checkpoint", "one");
}

}  // namespace railtab::fuzz
