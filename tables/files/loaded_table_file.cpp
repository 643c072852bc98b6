#include "railtab/tables/files/loaded_table_file.hpp"

#include <algorithm>
#include <array>

#include "railtab/tables/files/file_fields.hpp"
#include "railtab/tables/files/table_statements.hpp"

namespace railtab {

namespace {

constexpr const char* group = "loaded";

/// Arrays of numbers with their place in the file. One list serves writer, reader and checksum.
struct TableColumn {
  std::vector<double> LoadedTableData::*values;
  Field field;
};

const std::array<TableColumn, 6>& columns() {
  using Values = Field::Values;
  static const std::array<TableColumn, 6> list{
      TableColumn{&LoadedTableData::lateral,
                  {"loaded/lateral", {"lateral"}, "m", "nodes of the reduced lateral shift y0", Values::increasing}},
      TableColumn{&LoadedTableData::roll,
                  {"loaded/roll", {"roll"}, "rad", "nodes of the reduced roll", Values::increasing}},
      TableColumn{&LoadedTableData::yaw_squared,
                  {"loaded/yaw_squared", {"yaw"}, "rad^2", "nodes of the square of the yaw", Values::increasing}},
      TableColumn{
          &LoadedTableData::cut,
          {"loaded/cut", {"cuts"}, "m", "arc lengths on the rail profile between its parts", Values::increasing}},
      TableColumn{
          &LoadedTableData::shift,
          {"loaded/shift", {"lateral", "roll", "yaw", "2"}, "m; 1", "lateral shift y at the nodes, and dy/dy0"}},
      TableColumn{&LoadedTableData::touch, {"loaded/touch", {"lateral", "roll", "yaw"}, "m", "height of first touch"}}};
  return list;
}

const Field height_field{"loaded/height",
                         {"lateral", "levels", "roll", "yaw", "4"},
                         "m; m/J^0.2; 1; 1/J^0.2",
                         "height of the wheelset at energy w^5 less that of first touch, and the height's derivatives "
                         "with respect to w, to y0 and to both"};
const Field pressed_field{"loaded/pressed",
                          {"nodes"},
                          "1",
                          "at the nodes (lateral, level), the parts of the rail that are pressed anywhere in roll and "
                          "yaw, bit by bit from the first"};
const Field part_field{"loaded/part",
                       {"pressed", "roll", "yaw", "12"},
                       "1; m; rad; N/m; Pa",
                       "per pressed part: share of the vertical force, mean point of the wheel (x over yaw, y, z), "
                       "contact angle, semi-axes a, b over w, force per length at its peak and its upper end over w^2, "
                       "arc lengths on rail and wheel, largest pressure over w"};

}  // namespace

void write_loaded_table(ArrayFileWriter& file, const LoadedTableData& table) {
  FieldWriter out(file);
  out.set("levels", static_cast<std::size_t>(table.levels));
  out.set("cuts", table.cut.size());
  for (const TableColumn& column : columns()) {
    if (column.values == &LoadedTableData::cut && table.cut.empty()) continue;
    out.write(column.field, table.*column.values);
  }
  out.write(height_field, table.height);
  out.write(pressed_field, table.pressed);
  out.write(part_field, table.part);
  file.attribute(group, "levels", static_cast<std::int64_t>(table.levels));
  out.number(group, "largest_level", table.largest_level);
  out.number(group, "contact_modulus", table.contact_modulus);
  if (table.climb != 0.0) out.number(group, "climb", table.climb);
  for (const auto& [name, value] : table.statistics) out.number("loaded/statistics", name, value);
}

std::optional<LoadedTableData> read_loaded_table(const ArrayFileReader& file) {
  if (!file.contains("loaded/height")) return {};
  FieldReader in(file);
  LoadedTableData table;
  table.levels = static_cast<int>(file.whole_number(group, "levels", 3, 10000));
  table.largest_level = in.number(group, "largest_level", 0.0);
  table.contact_modulus = in.number(group, "contact_modulus", 0.0);
  const std::vector<std::string> attributes = file.attribute_names(group);
  if (std::find(attributes.begin(), attributes.end(), "climb") != attributes.end()) {
    table.climb = in.number(group, "climb", 0.0, largest_climb);
  }
  in.set("levels", static_cast<std::size_t>(table.levels), group);
  const bool cut = file.contains("loaded/cut");
  for (const TableColumn& column : columns()) {
    if (column.values == &LoadedTableData::cut && !cut) continue;
    table.*column.values = in.numbers(column.field);
  }
  table.height = in.floats(height_field);
  table.pressed = in.counts(pressed_field);
  table.part = in.floats(part_field);
  table.statistics = read_statistics(file, "loaded/statistics");
  require_consistent(table, file.file().string() + ": loaded");
  return table;
}

std::uint64_t loaded_checksum(const LoadedTableData& table, std::uint64_t sum) noexcept {
  const auto add = [&sum](std::span<const double> values) { sum = counted_checksum(values, sum); };
  for (const TableColumn& column : columns()) add(table.*column.values);
  const std::array<double, 3> level{static_cast<double>(table.levels), table.largest_level, table.contact_modulus};
  add(level);
  if (table.climb != 0.0) add({&table.climb, 1});
  for (const auto& [name, value] : table.statistics) add({&value, 1});
  sum = checksum(std::span(table.pressed), checksum(std::span(table.height), sum));
  return checksum(std::span(table.part), sum);
}

}  // namespace railtab
