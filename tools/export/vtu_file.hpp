#pragma once

#include <span>
#include <string>
#include <string_view>

#include "railtab/runtime/drawing/grid.hpp"

namespace railtab::vtk {

using drawing::Array;
using drawing::Grid;

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
