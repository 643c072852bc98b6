#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/irregularity.hpp"

namespace railtab {

namespace {

// Points so uneven that their spline has little to do with them.
void reject_swings(const Irregularity& irregularity, const std::vector<FileColumn>& columns) {
  const Irregularity::Extreme swing = irregularity.farthest_out();
  if (swing.beyond <= 1.0) return;
  const FileColumn& column = columns[swing.column + 1];
  throw input_error(
      column.place(swing.point + 1),
      fmt::format("a spline through the points that swings to {:.3g} m at x = {:.6g} m, before the next row, {:.3g} "
                  "times the range of the column's values beyond it",
                  swing.value, swing.x, swing.beyond),
      "points more evenly spaced: beside a steep change as near to each other as in it");
}

}  // namespace

Irregularity read_irregularity(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 5> names{"x", "y_left", "z_left", "y_right", "z_right"};
  constexpr std::string_view expected = "5 columns: x, y_left, z_left, y_right, z_right";
  std::vector<FileColumn> columns = read_columns(file);
  if (columns.size() != names.size()) {
    throw input_error(columns.front().place(0), fmt::format("{} columns", columns.size()), expected);
  }
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (columns[c].name != names[c]) {
      throw input_error(columns[c].place(0), fmt::format("column '{}'", columns[c].name),
                        fmt::format("'{}'; {}", names[c], expected));
    }
    const double factor = factor_to_si(columns[c], {{"m", 1.0}, {"mm", 1e-3}});
    constexpr double largest = 0.5;  // [m]: no wheel follows more
    if (c > 0) require_magnitude(columns[c], factor, largest);
    for (double& value : columns[c].values) value *= factor;
    if (c == 0) require_argument(columns[c]);
  }
  Irregularity irregularity(std::move(columns[0].values), std::move(columns[1].values), std::move(columns[2].values),
                            std::move(columns[3].values), std::move(columns[4].values));
  reject_swings(irregularity, columns);
  return irregularity;
}

}  // namespace railtab
