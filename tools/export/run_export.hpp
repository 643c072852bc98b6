#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::vtk {

/// How a run is exported.
struct ExportOptions {
  std::vector<std::size_t> records;  ///< indices of RunResults::steps, rising, at least one
  double scale = 1.0;  ///< points = place at rest + scale·displacement; 0: all at rest, for ParaView's own warp
  bool z_up = false;   ///< turned about x: x forward, y left, z up; else railtab's axes
};

/// Where an export goes: a collection of all parts, and a folder with a collection and the files of each part.
struct ExportPlace {
  std::filesystem::path collection;  ///< FILE.pvd
  std::filesystem::path folder;      ///< beside it, or the folder that it is in
};
/// "FILE.pvd": with the folder FILE beside it; any other name: a folder, in which the collection is "all.pvd".
/// @throws InputError where either could not be created, or would replace what is no earlier export
[[nodiscard]] ExportPlace export_place(const std::string& output);

/// What was written, and what could not be.
struct ExportSummary {
  std::vector<std::string> parts, not_recorded;
  std::size_t files = 0;
};
/// Writes all files into a folder of another name, then renames it: an export is whole or absent. An earlier one is
/// replaced.
/// @throws InputError where the results have nothing that can be drawn, or the place is not export_place()'s;
/// ComputationError where the disk is full
ExportSummary write_export(const RunResults& results, const ExportOptions& options, const ExportPlace& place);

}  // namespace railtab::vtk
