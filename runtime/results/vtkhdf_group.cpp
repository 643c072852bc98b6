#include "railtab/runtime/results/vtkhdf_group.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/drawing/grid.hpp"

namespace railtab::vtkhdf {
namespace {

using drawing::MovingGrid;
using Integers = std::vector<std::int64_t>;
using Shape = std::vector<std::size_t>;

constexpr const char *group = "VTKHDF", *steps_group = "VTKHDF/Steps", *steps_attribute = "NSteps";
constexpr std::string_view type = "UnstructuredGrid", not_yet = "not written yet!", vectors = "displacement";
static_assert(type.size() == not_yet.size(), "one is overwritten by the other");
constexpr std::array<std::int64_t, 2> version{2, 0};

constexpr const char *times_path = "VTKHDF/Steps/Values", *points_path = "VTKHDF/Points";
constexpr const char* displacement_path = "VTKHDF/PointData/displacement";
constexpr const char* recorded_path = "VTKHDF/PointData/recorded";
constexpr const char *types_path = "VTKHDF/Types", *part_path = "VTKHDF/CellData/part";
constexpr const char *offsets_path = "VTKHDF/Offsets", *connectivity_path = "VTKHDF/Connectivity";

/// T instants, P points, C cells with K corners, by which the integers of the group follow from one another.
struct Counts {
  std::int64_t T = 0, P = 0, C = 0, K = 0;
};

/// Integers that follow from the counts alone: what the writer writes and the reader expects.
struct CountColumn {
  const char* path;
  Shape row_shape;
  const char* description;
  Integers (*values)(const Counts&);
};

Integers at_each_instant(const Counts& n, std::int64_t value) { return Integers(static_cast<std::size_t>(n.T), value); }
Integers none_skipped(const Counts& n) { return at_each_instant(n, 0); }
/// Rows that lie one instant after the other.
Integers one_after_the_other(const Counts& n) {
  Integers first = none_skipped(n);
  for (std::size_t t = 0; t < first.size(); ++t) first[t] = static_cast<std::int64_t>(t) * n.P;
  return first;
}

/// The first three tell the counts. They have a row per instant, of which PartOffsets skips none: readers take the
/// number of parts either from NumberOfParts or from the rows per instant.
const std::array<CountColumn, 11>& count_columns() {
  static const std::array<CountColumn, 11> columns{
      {{"VTKHDF/NumberOfPoints", {}, "P, points", [](const Counts& n) { return at_each_instant(n, n.P); }},
       {"VTKHDF/NumberOfCells", {}, "C, cells", [](const Counts& n) { return at_each_instant(n, n.C); }},
       {"VTKHDF/NumberOfConnectivityIds",
        {},
        "K, corners of all cells",
        [](const Counts& n) { return at_each_instant(n, n.K); }},
       {"VTKHDF/Steps/NumberOfParts", {}, "of each instant", [](const Counts& n) { return at_each_instant(n, 1); }},
       {"VTKHDF/Steps/PartOffsets", {}, "first part of each instant", none_skipped},
       {"VTKHDF/Steps/PointOffsets", {}, "first row of each instant in Points", one_after_the_other},
       {"VTKHDF/Steps/CellOffsets", {1}, "first cell of each instant: the cells stay", none_skipped},
       {"VTKHDF/Steps/ConnectivityIdOffsets", {1}, "first corner of each instant", none_skipped},
       {"VTKHDF/Steps/PointDataOffsets/displacement", {}, "first row of each instant", one_after_the_other},
       {"VTKHDF/Steps/PointDataOffsets/recorded", {}, "first row of each instant", none_skipped},
       {"VTKHDF/Steps/CellDataOffsets/part", {}, "first row of each instant", none_skipped}}};
  return columns;
}

/// Every other dataset.
constexpr std::size_t other_datasets = 8;

template <class Value>
std::span<const Value> none() {
  return {};
}

InputError damaged(const ArrayFileReader& in, std::string_view path, const std::string& found,
                   const std::string& expected) {
  return input_error(fmt::format("{}: {}", in.file().string(), path), found, expected);
}

void require_shape(const ArrayFileReader& in, const char* path, const Shape& expected) {
  const Shape found = in.shape(path);
  if (found == expected) return;
  throw damaged(in, path, fmt::format("the shape ({})", fmt::join(found, ", ")),
                fmt::format("({})", fmt::join(expected, ", ")));
}

Integers integers(const ArrayFileReader& in, const char* path, const Shape& shape) {
  require_shape(in, path, shape);
  return in.read_integers(path);
}

/// How many corners a kind of cell has at least and at most; none of a kind that railtab does not write.
std::optional<std::pair<std::int64_t, std::int64_t>> corners_of(std::int64_t kind) {
  constexpr std::int64_t any = std::int64_t{1} << 40U;
  switch (static_cast<drawing::Cell>(kind)) {
    case drawing::Cell::vertex:
      return {{1, 1}};
    case drawing::Cell::poly_line:
      return {{2, any}};
    case drawing::Cell::polygon:
      return {{3, any}};
    case drawing::Cell::quad:
      return {{4, 4}};
    case drawing::Cell::hexahedron:
      return {{8, 8}};
  }
  return std::nullopt;
}

void require_within(const ArrayFileReader& in, const char* path, const Integers& values, std::int64_t below) {
  for (const std::int64_t value : values) {
    if (value < 0 || value >= below) {
      throw damaged(in, path, fmt::format("{}", value), fmt::format("0 to {}", below - 1));
    }
  }
}

void check_cells(const ArrayFileReader& in, const Counts& n) {
  const auto cells = static_cast<std::size_t>(n.C);
  const Integers offsets = integers(in, offsets_path, {cells + 1}), kinds = integers(in, types_path, {cells});
  require_within(in, connectivity_path, integers(in, connectivity_path, {static_cast<std::size_t>(n.K)}), n.P);
  require_within(in, part_path, integers(in, part_path, {cells}),
                 static_cast<std::int64_t>(drawing::moving_parts.size()));
  require_within(in, recorded_path, integers(in, recorded_path, {static_cast<std::size_t>(n.P)}), 2);
  if (offsets.front() != 0 || offsets.back() != n.K) {
    throw damaged(in, offsets_path, fmt::format("{} to {}", offsets.front(), offsets.back()),
                  fmt::format("0 to {}", n.K));
  }
  for (std::size_t c = 0; c < cells; ++c) {
    const auto corners = corners_of(kinds[c]);
    if (!corners) throw damaged(in, types_path, fmt::format("the kind {}", kinds[c]), "1, 4, 7, 9 or 12");
    const std::int64_t count = offsets[c + 1] - offsets[c];
    if (count >= corners->first && count <= corners->second) continue;
    throw damaged(in, offsets_path, fmt::format("{} corners of cell {}", count, c),
                  fmt::format("what the kind {} has", kinds[c]));
  }
}

void check_instants(const ArrayFileReader& in, const Counts& n, std::span<const StepRecord> steps) {
  require_shape(in, times_path, {static_cast<std::size_t>(n.T)});
  auto step = steps.begin();
  for (const double time : in.read(times_path).values) {
    step = std::find_if(step, steps.end(), [time](const StepRecord& s) { return s.time == time; });
    if (step == steps.end()) throw damaged(in, times_path, fmt::format("{} s", time), "times of records, rising");
    ++step;
  }
  for (const char* path : {points_path, displacement_path}) {
    require_shape(in, path, {static_cast<std::size_t>(n.T * n.P), 3});
    const Array values = in.read(path);
    if (!std::ranges::all_of(values.values, [](double value) { return std::isfinite(value); })) {
      throw damaged(in, path, "a value that is not finite", "finite ones");
    }
  }
}

}  // namespace

void create(ArrayFileWriter& out) {
  out.attribute(group, "Version", std::span(version));
  out.ascii_attribute(group, "Type", not_yet);
  out.create_late(points_path, none<float>(), {3}, "m", "x, y, z of each point without its displacement, per instant");
  out.create_late(connectivity_path, none<std::int64_t>(), {}, "1", "points of all cells");
  out.create_late(offsets_path, none<std::int64_t>(), {}, "1", "where the points of each cell begin, and the end");
  out.create_late(types_path, none<std::uint8_t>(), {}, "1", "kinds of cells, VTK's numbers");
  out.create_late(displacement_path, none<float>(), {3}, "m", "x, y, z, per instant");
  out.create_late(recorded_path, none<std::uint8_t>(), {}, "1", "1 where the displacement is one of the records");
  out.create_late(part_path, none<std::uint8_t>(), {}, "1",
                  fmt::format("of each cell: 0 {}", fmt::join(drawing::moving_parts, ", ")));
  out.create_late(times_path, none<double>(), {}, "s", "instants");
  for (const CountColumn& column : count_columns()) {
    out.create_late(column.path, none<std::int64_t>(), column.row_shape, "1", column.description);
  }
  out.ascii_attribute("VTKHDF/PointData", "Vectors", vectors);
  out.attribute(steps_group, steps_attribute, std::int64_t{0});
}

bool is_in(const ArrayFileReader& in) { return in.contains(group); }

void invalidate(ArrayFileWriter& out) {
  out.ascii_attribute(group, "Type", not_yet);
  out.flush();
}

void write(ArrayFileWriter& out, const MovingGrid& grid) {
  out.write_late(points_path, std::span<const float>(grid.points));
  out.write_late(displacement_path, std::span<const float>(grid.displacement));
  out.write_late(recorded_path, std::span<const std::uint8_t>(grid.recorded));
  out.write_late(connectivity_path, std::span<const std::int64_t>(grid.connectivity));
  out.write_late(offsets_path, std::span<const std::int64_t>(grid.offsets));
  out.write_late(types_path, std::span<const std::uint8_t>(grid.types));
  out.write_late(part_path, std::span<const std::uint8_t>(grid.part));
  out.write_late(times_path, std::span<const double>(grid.times));
  const Counts counts{static_cast<std::int64_t>(grid.times.size()), static_cast<std::int64_t>(grid.recorded.size()),
                      static_cast<std::int64_t>(grid.types.size()),
                      static_cast<std::int64_t>(grid.connectivity.size())};
  for (const CountColumn& column : count_columns()) {
    out.write_late(column.path, std::span<const std::int64_t>(column.values(counts)));
  }
  out.attribute(steps_group, steps_attribute, counts.T);
  out.cut();
  out.flush();
  // Last: what says that all the rest is there.
  out.ascii_attribute(group, "Type", type);
}

void check(const ArrayFileReader& in, std::span<const StepRecord> steps) {
  const Integers found = in.whole_numbers(group, "Version");
  if (!std::ranges::equal(found, version)) {
    throw damaged(in, group, fmt::format("Version {}", fmt::join(found, ", ")),
                  fmt::format("{}", fmt::join(version, ", ")));
  }
  const std::string found_type = in.text(group, "Type");
  if (found_type == not_yet) return;
  if (found_type != type) throw damaged(in, group, fmt::format("Type {}", found_type), std::string(type));
  const std::string found_vectors = in.text("VTKHDF/PointData", "Vectors");
  if (found_vectors != vectors) throw damaged(in, "VTKHDF/PointData", "Vectors " + found_vectors, std::string(vectors));
  Counts n;
  n.T = in.whole_number(steps_group, steps_attribute, 1, static_cast<std::int64_t>(steps.size()));
  const std::array<std::int64_t*, 3> counts{&n.P, &n.C, &n.K};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    *counts[i] = integers(in, count_columns()[i].path, {static_cast<std::size_t>(n.T)}).front();
    constexpr std::int64_t most = std::int64_t{1} << 32U;
    if (*counts[i] < 1 || *counts[i] > most) {
      throw damaged(in, count_columns()[i].path, fmt::format("{}", *counts[i]), fmt::format("1 to {}", most));
    }
  }
  for (const CountColumn& column : count_columns()) {
    const Integers expected = column.values(n);
    Shape shape{expected.size()};
    shape.insert(shape.end(), column.row_shape.begin(), column.row_shape.end());
    if (integers(in, column.path, shape) == expected) continue;
    throw damaged(in, column.path, "other numbers", fmt::format("those of {} instants of {} points", n.T, n.P));
  }
  check_cells(in, n);
  check_instants(in, n, steps);
}

double memory_bytes(const drawing::MovingGridSize& size, double instants) {
  constexpr double per_point = 6.0 * sizeof(float);
  return per_point * size.points * instants + size.points + 10.0 * size.cells + 8.0 * size.connectivity;
}

double file_bytes(const drawing::MovingGridSize& size, double instants) {
  // Of each dataset: its header, the index of its chunks and the last chunk, which is not full; of the two large ones a
  // larger one, and pages for a longer index.
  constexpr double page_bytes = 4096.0, per_dataset = 4.0 * page_bytes, more = 6.0 * page_bytes;
  constexpr double groups = 6.0, per_group = 3.0 * page_bytes;  // with the table of names
  return memory_bytes(size, instants) + per_dataset * static_cast<double>(count_columns().size() + other_datasets) +
         2.0 * more + groups * per_group;
}

}  // namespace railtab::vtkhdf
