#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace railtab::vtk {

/// Values of one quantity, point by point or cell by cell.
struct Array {
  std::string name;  ///< with its unit, "displacement [m]"
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::int32_t>> values;
};

/// VTK's numbers of the kinds of cells that railtab writes.
enum class Cell : std::uint8_t { vertex = 1, poly_line = 4, polygon = 7, quad = 9, hexahedron = 12 };

/// An unstructured grid: points, cells between them, and values of both.
struct Grid {
  std::vector<float> points;  ///< x, y, z of each [m]
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<Array> point_data, cell_data;
  std::vector<std::pair<std::string, double>> numbers;                  ///< of the whole grid
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;  ///< of the whole grid

  [[nodiscard]] std::int64_t point_count() const noexcept { return static_cast<std::int64_t>(points.size() / 3); }
  /// @param corners numbers of points, in VTK's order
  void add_cell(Cell kind, std::span<const std::int64_t> corners);
};

/// A file of VTK's XML format for unstructured grids (.vtu), version 1.0: every array inline, in base64 with a 64-bit
/// length before it, in the byte order of this machine, which the file names. VTK 6 and later read it.
[[nodiscard]] std::string vtu_text(const Grid& grid);
/// First lines of vtu_text() and pvd_text(), by which an earlier export is known.
[[nodiscard]] std::string_view vtu_mark() noexcept;
[[nodiscard]] std::string_view pvd_mark() noexcept;

/// One file of a collection: a part at an instant.
struct CollectionEntry {
  double time = 0.0;  ///< [s]
  int part = 0;
  std::string name;  ///< of the part
  std::string file;  ///< relative to the collection
};
/// ParaView's collection of files over time (.pvd).
[[nodiscard]] std::string pvd_text(std::span<const CollectionEntry> entries);

}  // namespace railtab::vtk
