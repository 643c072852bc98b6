#include "railtab/tables/files/geometry_table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "railtab/tables/files/file_fields.hpp"
#include "railtab/tables/files/loaded_table_file.hpp"
#include "railtab/tables/files/table_statements.hpp"

namespace railtab {
namespace {

constexpr int geometry_format_version = 6;

/// A quantity of the table with its place and meaning in the file. One list serves writer, reader and checksum.
struct Column {
  const char* name;
  const char* unit;
  const char* description;
};

struct ProfileColumn : Column {
  std::vector<double> ProfileKnots::*values;
  Field::Values required = Field::Values::finite;
};
constexpr std::array profile_columns{
    ProfileColumn{{"s", "m", "arc length at the knots, from the track centre to the field side"},
                  &ProfileKnots::s,
                  Field::Values::increasing},
    ProfileColumn{{"y", "m", "lateral position, towards the field side"}, &ProfileKnots::y},
    ProfileColumn{{"z", "m", "vertical position, down"}, &ProfileKnots::z},
    ProfileColumn{{"dy", "1", "dy/ds of the piecewise cubic Hermite curve"}, &ProfileKnots::dy},
    ProfileColumn{{"dz", "1", "dz/ds of the piecewise cubic Hermite curve"}, &ProfileKnots::dz}};

struct AxisColumn : Column {
  TableAxis GeometryTableData::*axis;
};
constexpr std::array axis_columns{
    AxisColumn{{"lateral", "m", "lateral shift of the wheelset centre less nominal_radius times roll: low, high"},
               &GeometryTableData::lateral},
    AxisColumn{{"yaw_squared", "rad^2", "square of the yaw of the wheelset: low, high"},
               &GeometryTableData::yaw_squared},
    AxisColumn{{"roll", "rad", "roll of the wheelset against the rail head: low, high"}, &GeometryTableData::roll}};

struct DimensionColumn : Column {
  double GeometryTableData::*value;
};
constexpr std::array dimension_columns{
    DimensionColumn{{"track_gauge", "m", "distance of the gauge faces"}, &GeometryTableData::track_gauge},
    DimensionColumn{{"gauge_height", "m", "depth below the rail head at which the gauge is measured"},
                    &GeometryTableData::gauge_height},
    DimensionColumn{{"flange_back", "m", "distance of the flange backs"}, &GeometryTableData::flange_back},
    DimensionColumn{{"nominal_radius", "m", "nominal rolling radius"}, &GeometryTableData::nominal_radius},
    DimensionColumn{{"tolerance", "m", "error of penetration that the table was made for"},
                    &GeometryTableData::tolerance}};

Field field_of(const std::string& group, const ProfileColumn& column) {
  return {
      fmt::format("{}/{}", group, column.name), {group + " knots"}, column.unit, column.description, column.required};
}

Field field_of(const AxisColumn& column) {
  return {fmt::format("axes/{}", column.name), {"2"}, column.unit, column.description};
}

Field field_of(const DimensionColumn& column) {
  return {fmt::format("dimensions/{}", column.name), {}, column.unit, column.description};
}

const Field node_field{
    "cells/node",
    {"nodes"},
    "1",
    "the root cells' nodes (roll, yaw_squared, lateral; lateral fastest), then those below; 4 times an "
    "index plus 0, 1, 2: halved along lateral, yaw_squared, roll, index of the lower half's node, the "
    "upper half's is the next; plus 3: index of a leaf"};
const Field leaf_branch_field{"cells/leaf_branches", {"leaves"}, "1", "number of branches of each leaf"};
const Field lowering_field{"cells/trusted_lowering",
                           {"leaves"},
                           "m",
                           "per leaf: lowering below first touch up to which its branches are all that can touch"};
const Field coefficient_field{"branches/coefficient",
                              {"branches", "terms", "4"},
                              "m; 1",
                              "per branch, in the order of the leaves: polynomials of the leaf's local coordinates for "
                              "z_touch, s_wheel, s_rail [m] and n_y n_z [1]"};

/// Over every number of the table, in the order of the lists above, lengths included.
std::string content_checksum(const GeometryTableData& table) {
  std::uint64_t sum = checksum({});
  const auto add = [&sum](std::span<const double> values) { sum = counted_checksum(values, sum); };
  for (const ProfileKnots* profile : {&table.wheel, &table.rail}) {
    for (const ProfileColumn& column : profile_columns) add(profile->*column.values);
  }
  for (const AxisColumn& column : axis_columns) {
    const TableAxis& axis = table.*column.axis;
    const std::array<double, 3> numbers{axis.low, axis.high, static_cast<double>(axis.cells)};
    add(numbers);
  }
  const std::array<double, 2> shard{static_cast<double>(table.shard.index), static_cast<double>(table.shard.count)};
  add(shard);
  const auto add_array = [&](const auto& values) { sum = counted_checksum(std::span(values), sum); };
  add_array(table.node);
  add_array(table.leaf_branch);
  add_array(table.trusted_lowering);
  add_array(table.coefficient);
  for (const DimensionColumn& column : dimension_columns) add({&(table.*column.value), 1});
  for (const auto& [name, value] : table.statistics) add({&value, 1});
  if (table.loaded) sum = loaded_checksum(*table.loaded, sum);
  return fmt::format("{:016x}", sum);
}

std::size_t terms_of(const GeometryTableData& table) {
  return static_cast<std::size_t>(branch_terms(!table.yaw_squared.fixed(), !table.roll.fixed()));
}

void write_profile(ArrayFileWriter& file, const std::string& group, const ProfileKnots& profile) {
  FieldWriter out(file);
  for (const ProfileColumn& column : profile_columns) out.write(field_of(group, column), profile.*column.values);
  file.attribute(group, "name", profile.name);
  if (!profile.notes.empty()) file.attribute(group, "notes", fmt::format("{}", fmt::join(profile.notes, "\n")));
  if (!profile.inclination.empty()) file.attribute(group, "inclination", profile.inclination);
}

void write_axis(ArrayFileWriter& file, const AxisColumn& column, const TableAxis& axis) {
  const Field field = field_of(column);
  FieldWriter(file).write(field, std::array<double, 2>{axis.low, axis.high});
  file.attribute(field.path, "cells", static_cast<std::int64_t>(axis.cells));
}

void write_cells(ArrayFileWriter& file, const GeometryTableData& table) {
  FieldWriter out(file);
  out.set("terms", terms_of(table));
  out.write(node_field, table.node);
  out.write(leaf_branch_field, table.leaf_branch);
  out.write(lowering_field, table.trusted_lowering);
  out.write(coefficient_field, table.coefficient);
}

ProfileKnots read_profile(const ArrayFileReader& file, FieldReader& in, const std::string& group, ProfileKind kind) {
  ProfileKnots profile;
  profile.kind = kind;
  profile.name = file.text(group, "name");
  const std::vector<std::string> present = file.attribute_names(group);
  const auto has = [&](const char* name) { return std::find(present.begin(), present.end(), name) != present.end(); };
  if (has("notes")) {
    std::istringstream notes(file.text(group, "notes"));
    for (std::string line; std::getline(notes, line);) profile.notes.push_back(line);
  }
  if (has("inclination")) profile.inclination = file.text(group, "inclination");
  for (const ProfileColumn& column : profile_columns) profile.*column.values = in.numbers(field_of(group, column));
  return profile;
}

TableAxis read_axis(const ArrayFileReader& file, FieldReader& in, const AxisColumn& column) {
  const Field field = field_of(column);
  const std::vector<double> ends = in.numbers(field);
  return {ends[0], ends[1], static_cast<int>(file.whole_number(field.path, "cells", 1, most_axis_cells))};
}

int count_of(const ArrayFileReader& file, const char* attribute) {
  return static_cast<int>(file.whole_number("cells", attribute, 1, TableShard::most));
}

}  // namespace

void write_geometry_table(const std::filesystem::path& file, const GeometryTableData& table) {
  ArrayFileWriter out(file, geometry_table_filetype, geometry_format_version);
  out.attribute("", "description",
                "Wheel-rail contact geometry of one pair. SI units; x forward, y right, z down; right wheel. "
                "Layout: docs/file_formats/geometry_table.md");
  write_profile(out, "profiles/wheel", table.wheel);
  write_profile(out, "profiles/rail", table.rail);
  for (const AxisColumn& column : axis_columns) write_axis(out, column, table.*column.axis);
  for (const DimensionColumn& column : dimension_columns) {
    FieldWriter(out).write(field_of(column), std::array{table.*column.value});
  }
  out.attribute("cells", "shard_index", static_cast<std::int64_t>(table.shard.index));
  out.attribute("cells", "shard_count", static_cast<std::int64_t>(table.shard.count));
  write_cells(out, table);
  if (table.loaded) write_loaded_table(out, *table.loaded);
  write_statements(out, table.provenance, table.statistics, content_checksum(table));
  out.close();
}

GeometryTableData read_geometry_table(const std::filesystem::path& name) {
  const ArrayFileReader file(name, geometry_table_filetype, geometry_format_version);
  FieldReader in(file);
  GeometryTableData table;
  table.wheel = read_profile(file, in, "profiles/wheel", ProfileKind::wheel);
  table.rail = read_profile(file, in, "profiles/rail", ProfileKind::rail);
  for (const AxisColumn& column : axis_columns) table.*column.axis = read_axis(file, in, column);
  for (const DimensionColumn& column : dimension_columns) {
    table.*column.value = in.numbers(field_of(column)).front();
  }
  table.shard = {count_of(file, "shard_index"), count_of(file, "shard_count")};
  table.node = in.counts(node_field);
  table.leaf_branch = in.counts(leaf_branch_field);
  table.trusted_lowering = in.floats(lowering_field);
  in.set("terms", terms_of(table), "axes");
  table.coefficient = in.floats(coefficient_field);
  table.loaded = read_loaded_table(file);
  table.statistics = read_statistics(file);
  table.provenance = read_provenance(file);
  require_checksum(file, content_checksum(table));
  return table;
}

}  // namespace railtab
