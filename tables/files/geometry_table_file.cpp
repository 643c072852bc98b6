#include "railtab/tables/files/geometry_table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/table_statements.hpp"

namespace railtab {
namespace {

constexpr int format_version = 4;

/// A quantity of the table with its place and meaning in the file. One list serves writer, reader and checksum.
struct Column {
  const char* name;
  const char* unit;
  const char* description;
};

struct ProfileColumn : Column {
  std::vector<double> ProfileKnots::*values;
};
constexpr std::array profile_columns{
    ProfileColumn{{"s", "m", "arc length at the knots, from the track centre to the field side"}, &ProfileKnots::s},
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

/// Over every number of the table, in the order of the lists above, lengths included.
std::string content_checksum(const GeometryTableData& table) {
  std::uint64_t sum = checksum({});
  const auto add = [&sum](std::span<const double> values) {
    const double length = static_cast<double>(values.size());
    sum = checksum(values, checksum({&length, 1}, sum));
  };
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
  const auto add_array = [&](const auto& values) {
    const double length = static_cast<double>(values.size());
    sum = checksum(std::span(values), checksum({&length, 1}, sum));
  };
  add_array(table.node);
  add_array(table.leaf_branch);
  add_array(table.trusted_lowering);
  add_array(table.coefficient);
  for (const DimensionColumn& column : dimension_columns) add({&(table.*column.value), 1});
  for (const auto& [name, value] : table.statistics) add({&value, 1});
  return fmt::format("{:016x}", sum);
}

void write_profile(ArrayFileWriter& file, const std::string& group, const ProfileKnots& profile) {
  for (const ProfileColumn& column : profile_columns) {
    const std::vector<double>& values = profile.*column.values;
    file.write(fmt::format("{}/{}", group, column.name), values, {values.size()}, column.unit, column.description);
  }
  file.attribute(group, "name", profile.name);
  if (!profile.notes.empty()) file.attribute(group, "notes", fmt::format("{}", fmt::join(profile.notes, "\n")));
}

void write_axis(ArrayFileWriter& file, const AxisColumn& column, const TableAxis& axis) {
  const std::string path = fmt::format("axes/{}", column.name);
  const std::array<double, 2> ends{axis.low, axis.high};
  file.write(path, ends, {2}, column.unit, column.description);
  file.attribute(path, "cells", static_cast<std::int64_t>(axis.cells));
}

std::size_t terms_of(const GeometryTableData& table) {
  return static_cast<std::size_t>(branch_terms(!table.yaw_squared.fixed(), !table.roll.fixed()));
}

void write_cells(ArrayFileWriter& file, const GeometryTableData& table) {
  file.write("cells/node", table.node, {table.node.size()}, "1",
             "the root cells' nodes (roll, yaw_squared, lateral; lateral fastest), then those below; 4 times an index "
             "plus 0, 1, 2: halved along lateral, yaw_squared, roll, index of the lower half's node, the upper half's "
             "is the next; plus 3: index of a leaf");
  file.write("cells/leaf_branches", table.leaf_branch, {table.leaf_branch.size()}, "1",
             "number of branches of each leaf");
  file.write("cells/trusted_lowering", table.trusted_lowering, {table.trusted_lowering.size()}, "m",
             "per leaf: lowering below first touch up to which its branches are all that can touch");
  const std::size_t terms = terms_of(table);
  file.write(
      "branches/coefficient", table.coefficient, {table.coefficient.size() / (4 * terms), terms, 4}, "m; 1",
      "per branch, in the order of the leaves: polynomials of the leaf's local coordinates for z_touch, s_wheel, "
      "s_rail [m] and n_y n_z [1]");
}

/// One table file being read; every error names the file and the dataset.
class Reading {
 public:
  explicit Reading(const std::filesystem::path& name)
      : name_(name), file_(name, geometry_table_filetype, format_version) {}

  [[nodiscard]] GeometryTableData table() const {
    GeometryTableData table;
    table.wheel = profile("profiles/wheel", ProfileKind::wheel);
    table.rail = profile("profiles/rail", ProfileKind::rail);
    for (const AxisColumn& column : axis_columns) table.*column.axis = axis(fmt::format("axes/{}", column.name));
    for (const DimensionColumn& column : dimension_columns) {
      table.*column.value = numbers(fmt::format("dimensions/{}", column.name), {}).front();
    }
    table.shard = {count_of("cells", "shard_index", TableShard::most),
                   count_of("cells", "shard_count", TableShard::most)};
    table.node = counts("cells/node");
    table.leaf_branch = counts("cells/leaf_branches");
    table.trusted_lowering = floats("cells/trusted_lowering", {static_cast<long>(table.leaf_branch.size())});
    table.coefficient = floats("branches/coefficient", {-1, static_cast<long>(terms_of(table)), 4});
    table.statistics = read_statistics(file_);
    table.provenance = read_provenance(file_);
    require_checksum(file_, name_, content_checksum(table));
    return table;
  }

 private:
  [[nodiscard]] std::string place(const std::string& path) const { return fmt::format("{}: {}", name_.string(), path); }

  template <typename Valid>
  void check(const std::string& path, const std::vector<double>& values, const Valid& valid,
             std::string_view expected) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!valid(values[i])) throw input_error(place(path), fmt::format("{} as value {}", values[i], i), expected);
    }
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& path, const std::vector<long>& shape) const {
    std::vector<double> values = file_.read(path, shape);
    check(
        path, values, [](double v) { return std::isfinite(v); }, "a finite number");
    return values;
  }

  [[nodiscard]] std::vector<float> floats(const std::string& path, const std::vector<long>& shape) const {
    const std::vector<double> values = numbers(path, shape);
    return {values.begin(), values.end()};
  }

  [[nodiscard]] std::vector<std::uint32_t> counts(const std::string& path) const {
    const std::vector<std::int64_t> values = file_.read_integers(path);
    std::vector<std::uint32_t> result;
    result.reserve(values.size());
    for (const std::int64_t value : values) {
      if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
        throw input_error(place(path), fmt::format("{}", value), "a number of 32 bits");
      }
      result.push_back(static_cast<std::uint32_t>(value));
    }
    return result;
  }

  [[nodiscard]] int count_of(const std::string& path, const std::string& attribute, int most) const {
    return static_cast<int>(file_.whole_number(path, attribute, 1, most));
  }

  [[nodiscard]] TableAxis axis(const std::string& path) const {
    const std::vector<double> ends = numbers(path, {2});
    return {ends[0], ends[1], count_of(path, "cells", most_axis_cells)};
  }

  [[nodiscard]] ProfileKnots profile(const std::string& group, ProfileKind kind) const {
    ProfileKnots profile;
    profile.kind = kind;
    profile.name = file_.text(group, "name");
    const std::vector<std::string> present = file_.attribute_names(group);
    if (std::find(present.begin(), present.end(), "notes") != present.end()) {
      std::istringstream notes(file_.text(group, "notes"));
      for (std::string line; std::getline(notes, line);) profile.notes.push_back(line);
    }
    long knots = -1;
    for (const ProfileColumn& column : profile_columns) {
      profile.*column.values = numbers(fmt::format("{}/{}", group, column.name), {knots});
      knots = static_cast<long>((profile.*column.values).size());
    }
    return profile;
  }

  std::filesystem::path name_;
  ArrayFileReader file_;
};

}  // namespace

void write_geometry_table(const std::filesystem::path& file, const GeometryTableData& table) {
  ArrayFileWriter out(file, geometry_table_filetype, format_version);
  out.attribute("", "description",
                "Wheel-rail contact geometry of one pair. SI units; x forward, y right, z down; right wheel. "
                "Layout: docs/file_formats/geometry_table.md");
  write_profile(out, "profiles/wheel", table.wheel);
  write_profile(out, "profiles/rail", table.rail);
  for (const AxisColumn& column : axis_columns) write_axis(out, column, table.*column.axis);
  for (const DimensionColumn& column : dimension_columns) {
    out.write(fmt::format("dimensions/{}", column.name), {&(table.*column.value), 1}, {}, column.unit,
              column.description);
  }
  out.attribute("cells", "shard_index", static_cast<std::int64_t>(table.shard.index));
  out.attribute("cells", "shard_count", static_cast<std::int64_t>(table.shard.count));
  write_cells(out, table);
  write_statements(out, table.provenance, table.statistics, content_checksum(table));
  out.close();
}

GeometryTableData read_geometry_table(const std::filesystem::path& file) { return Reading(file).table(); }

}  // namespace railtab
