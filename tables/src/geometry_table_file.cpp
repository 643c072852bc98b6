#include "railtab/tables/geometry_table_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "railtab/tables/array_file.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

constexpr std::string_view filetype = "railtab-geometry-table";
constexpr int format_version = 2;

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

struct BranchColumn : Column {
  std::vector<double> GeometryBranch::*values;
};
constexpr std::array branch_columns{
    BranchColumn{{"z_touch", "m", "height of the wheelset centre that touches on this branch, z down"},
                 &GeometryBranch::z_touch},
    BranchColumn{{"s_wheel", "m", "arc length of the touching point on the wheel profile"}, &GeometryBranch::s_wheel},
    BranchColumn{{"s_rail", "m", "arc length of the touching point on the rail profile"}, &GeometryBranch::s_rail},
    BranchColumn{{"z_touch_dy", "1", "derivative of z_touch along the lateral axis"}, &GeometryBranch::z_touch_dy},
    BranchColumn{{"s_wheel_dy", "1", "derivative of s_wheel along the lateral axis"}, &GeometryBranch::s_wheel_dy},
    BranchColumn{{"s_rail_dy", "1", "derivative of s_rail along the lateral axis"}, &GeometryBranch::s_rail_dy}};

struct AxisColumn : Column {
  std::vector<double> GeometryTableData::*values;
};
constexpr std::array axis_columns{
    AxisColumn{{"lateral", "m", "lateral shift of the wheelset centre less nominal_radius times roll"},
               &GeometryTableData::lateral},
    AxisColumn{{"yaw_squared", "rad^2", "square of the yaw of the wheelset"}, &GeometryTableData::yaw_squared},
    AxisColumn{{"roll", "rad", "roll of the wheelset against the rail head"}, &GeometryTableData::roll}};

struct DimensionColumn : Column {
  double GeometryTableData::*value;
};
constexpr std::array dimension_columns{
    DimensionColumn{{"track_gauge", "m", "distance of the gauge faces"}, &GeometryTableData::track_gauge},
    DimensionColumn{{"gauge_height", "m", "depth below the rail head at which the gauge is measured"},
                    &GeometryTableData::gauge_height},
    DimensionColumn{{"flange_back", "m", "distance of the flange backs"}, &GeometryTableData::flange_back},
    DimensionColumn{{"nominal_radius", "m", "nominal rolling radius"}, &GeometryTableData::nominal_radius},
    DimensionColumn{{"searched_lowering", "m", "height above first touch up to which the search windows are complete"},
                    &GeometryTableData::searched_lowering},
    DimensionColumn{{"tolerance", "m", "error of penetration that the table was made for"},
                    &GeometryTableData::tolerance}};

using Shape = std::array<std::size_t, 3>;

/// Of a branch's arrays: roll, yaw squared, lateral (C order, lateral fastest).
Shape branch_shape(const GeometryBranch& branch) {
  return {static_cast<std::size_t>(branch.size[2]), static_cast<std::size_t>(branch.size[1]),
          static_cast<std::size_t>(branch.size[0])};
}

Shape cell_shape(const GeometryTableData& table) {
  const auto cells = [](const std::vector<double>& nodes) { return nodes.size() > 1 ? nodes.size() - 1 : 1; };
  return {cells(table.roll), cells(table.yaw_squared), cells(table.lateral)};
}

std::string branch_path(std::size_t n, std::string_view column) { return fmt::format("branches/{}/{}", n, column); }

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
  for (const AxisColumn& column : axis_columns) add(table.*column.values);
  for (const GeometryBranch& branch : table.branches) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::array<double, 2> box{static_cast<double>(branch.first[axis]), static_cast<double>(branch.size[axis])};
      add(box);
    }
    for (const BranchColumn& column : branch_columns) add(branch.*column.values);
  }
  add(table.trusted_lowering);
  for (const SearchWindow& w : table.windows) {
    const std::array<double, 3> window{static_cast<double>(w.cell), w.s_low, w.s_high};
    add(window);
  }
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

void write_branch(ArrayFileWriter& file, std::size_t n, const GeometryBranch& branch) {
  const std::array<std::int64_t, 3> first{branch.first[0], branch.first[1], branch.first[2]};
  file.write(branch_path(n, "first_node"), first, {3}, "1",
             "first node of the branch's box on the axes lateral, yaw_squared, roll; the arrays have the shape "
             "(roll, yaw_squared, lateral) and hold NaN where the branch does not exist");
  const Shape shape = branch_shape(branch);
  for (const BranchColumn& column : branch_columns) {
    file.write(branch_path(n, column.name), branch.*column.values, {shape.begin(), shape.end()}, column.unit,
               column.description);
  }
}

void write_windows(ArrayFileWriter& file, const std::vector<SearchWindow>& windows) {
  file.attribute("windows", "count", static_cast<std::int64_t>(windows.size()));
  if (windows.empty()) return;
  std::vector<std::int64_t> cell;
  std::vector<double> low, high;
  for (const SearchWindow& w : windows) {
    cell.push_back(w.cell);
    low.push_back(w.s_low);
    high.push_back(w.s_high);
  }
  file.write("windows/cell", cell, {cell.size()}, "1",
             "number of the cell (roll, yaw_squared, lateral; lateral fastest), not decreasing");
  file.write("windows/s_low", low, {low.size()}, "m",
             "begin of the stretch of the wheel profile that is searched in this cell");
  file.write("windows/s_high", high, {high.size()}, "m", "end of the stretch");
}

/// One table file being read; every error names the file and the dataset.
class Reading {
 public:
  explicit Reading(const std::filesystem::path& name) : name_(name), file_(name, filetype, format_version) {}

  [[nodiscard]] GeometryTableData table() const {
    GeometryTableData table;
    table.wheel = profile("profiles/wheel", ProfileKind::wheel);
    table.rail = profile("profiles/rail", ProfileKind::rail);
    for (const AxisColumn& column : axis_columns) {
      const std::string path = fmt::format("axes/{}", column.name);
      table.*column.values = numbers(path, {-1});
      if ((table.*column.values).empty()) throw input_error(place(path), "no nodes", "at least one");
    }
    for (const DimensionColumn& column : dimension_columns) {
      table.*column.value = numbers(fmt::format("dimensions/{}", column.name), {}).front();
    }
    const double count = file_.number("branches", "count");
    for (std::size_t n = 0; static_cast<double>(n) < count; ++n) table.branches.push_back(branch(n, table));
    const Shape cells = cell_shape(table);
    table.trusted_lowering = file_.read("cells/trusted_lowering", {cells.begin(), cells.end()});
    check(
        "cells/trusted_lowering", table.trusted_lowering, [](double v) { return v >= 0; }, "a height or infinity");
    table.windows = windows();
    if (file_.contains("statistics")) {
      for (const std::string& name : file_.attribute_names("statistics")) {
        table.statistics.emplace_back(name, file_.number("statistics", name));
      }
    }
    table.provenance = {file_.text("provenance", "program_version"), file_.text("provenance", "command_line"),
                        file_.text("provenance", "created")};
    const std::string expected = file_.text("", "checksum");
    const std::string found = content_checksum(table);
    if (found != expected) {
      throw input_error(name_.string(), fmt::format("contents with checksum {}", found),
                        fmt::format("{}: the file is damaged", expected));
    }
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

  [[nodiscard]] std::vector<SearchWindow> windows() const {
    std::vector<SearchWindow> windows;
    const double count = file_.number("windows", "count");
    if (count == 0) return windows;
    const std::vector<std::int64_t> cell = file_.read_integers("windows/cell");
    const long n = static_cast<long>(cell.size());
    const std::vector<double> low = numbers("windows/s_low", {n});
    const std::vector<double> high = numbers("windows/s_high", {n});
    if (count != static_cast<double>(n)) {
      throw input_error(place("windows/cell"), fmt::format("{} values", n), fmt::format("{}, as counted", count));
    }
    for (std::size_t i = 0; i < cell.size(); ++i) windows.push_back({cell[i], low[i], high[i]});
    return windows;
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

  [[nodiscard]] GeometryBranch branch(std::size_t n, const GeometryTableData& table) const {
    GeometryBranch branch;
    const std::array<std::size_t, 3> nodes{table.lateral.size(), table.yaw_squared.size(), table.roll.size()};
    const std::string path = branch_path(n, "first_node");
    const std::vector<std::int64_t> first = file_.read_integers(path);
    if (first.size() != 3) throw input_error(place(path), fmt::format("{} values", first.size()), "3");
    const std::vector<std::size_t> shape = file_.read(branch_path(n, branch_columns[0].name)).shape;
    if (shape.size() != 3) throw input_error(place(path), fmt::format("arrays of rank {}", shape.size()), "rank 3");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t size = shape[2 - axis];
      if (first[axis] < 0 || static_cast<std::size_t>(first[axis]) > nodes[axis] ||
          size > nodes[axis] - static_cast<std::size_t>(first[axis])) {
        throw input_error(place(path),
                          fmt::format("{} nodes of axis {} from node {}", size, axis_columns[axis].name, first[axis]),
                          fmt::format("a box in its {} nodes", nodes[axis]));
      }
      branch.first[axis] = static_cast<int>(first[axis]);
      branch.size[axis] = static_cast<int>(size);
    }
    for (const BranchColumn& column : branch_columns) {
      const std::string column_path = branch_path(n, column.name);
      branch.*column.values = file_.read(column_path, {shape.begin(), shape.end()});
      check(
          column_path, branch.*column.values, [](double v) { return !std::isinf(v); },
          "a finite number, or NaN where the branch does not exist");
    }
    return branch;
  }

  std::filesystem::path name_;
  ArrayFileReader file_;
};

}  // namespace

void write_geometry_table(const std::filesystem::path& file, const GeometryTableData& table) {
  ArrayFileWriter out(file, filetype, format_version);
  out.attribute("", "description",
                "Wheel-rail contact geometry of one pair. SI units; x forward, y right, z down; right wheel. "
                "Layout: docs/file_formats/geometry_table.md");
  write_profile(out, "profiles/wheel", table.wheel);
  write_profile(out, "profiles/rail", table.rail);
  for (const AxisColumn& column : axis_columns) {
    const std::vector<double>& nodes = table.*column.values;
    out.write(fmt::format("axes/{}", column.name), nodes, {nodes.size()}, column.unit, column.description);
  }
  for (const DimensionColumn& column : dimension_columns) {
    out.write(fmt::format("dimensions/{}", column.name), {&(table.*column.value), 1}, {}, column.unit,
              column.description);
  }
  out.attribute("branches", "count", static_cast<std::int64_t>(table.branches.size()));
  for (std::size_t n = 0; n < table.branches.size(); ++n) write_branch(out, n, table.branches[n]);
  const Shape cells = cell_shape(table);
  out.write("cells/trusted_lowering", table.trusted_lowering, {cells.begin(), cells.end()}, "m",
            "per cell (roll, yaw_squared, lateral): height above first touch from which the table cannot be trusted; "
            "infinity where it always can");
  write_windows(out, table.windows);
  out.attribute("provenance", "program_version", table.provenance.program_version);
  out.attribute("provenance", "command_line", table.provenance.command_line);
  out.attribute("provenance", "created", table.provenance.created);
  for (const auto& [name, value] : table.statistics) out.attribute("statistics", name, value);
  out.attribute("", "checksum", content_checksum(table));
  out.close();
}

GeometryTableData read_geometry_table(const std::filesystem::path& file) { return Reading(file).table(); }

}  // namespace railtab
