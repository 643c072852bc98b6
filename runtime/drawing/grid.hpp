#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace railtab::drawing {

/// Values of one quantity, point by point or cell by cell.
struct Array {
  std::string name;  ///< SI units
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::int32_t>> values;
};

/// VTK's numbers of the kinds of cells that railtab writes.
enum class Cell : std::uint8_t { vertex = 1, poly_line = 4, polygon = 7, quad = 9, hexahedron = 12 };

/// An unstructured grid: points, cells between them, and values of both.
struct Grid {
  std::vector<float> points;                        ///< x, y, z of each [m]
  std::vector<std::int64_t> connectivity, offsets;  ///< points of all cells; where each cell's points end
  std::vector<std::uint8_t> types;
  std::vector<Array> point_data, cell_data;
  std::vector<std::pair<std::string, double>> numbers;                  ///< of the whole grid
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;  ///< of the whole grid

  [[nodiscard]] std::int64_t point_count() const noexcept { return static_cast<std::int64_t>(points.size() / 3); }
  /// @param corners numbers of points, in VTK's order
  void add_cell(Cell kind, std::span<const std::int64_t> corners);
};

}  // namespace railtab::drawing
