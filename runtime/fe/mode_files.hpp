#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

/// Largest damping ratio of a mode: modes near critical damping and beyond do not vibrate.
inline constexpr double most_damping_ratio = 0.99;

/// One natural mode, as programs list them.
struct FeMode {
  int number = 0;          ///< the program's
  double frequency = 0.0;  ///< [Hz], > 0
  double mass = 0.0;       ///< modal mass in the model's unit, that of the shapes' normalisation, > 0
  double damping = -1.0;   ///< of critical, 0 to most_damping_ratio; -1: the table has no column of it
};

/// Modes from a table with the columns mode, frequency, mass and perhaps damping, by rising frequency.
/// @throws InputError with file and line: a mode twice, a value out of range
[[nodiscard]] std::vector<FeMode> read_mode_table(const std::filesystem::path& file);

/// Columns of tables of shapes, by motion: along x, y, z and about them.
inline constexpr std::array<const char*, 6> shape_columns{"ux", "uy", "uz", "rotx", "roty", "rotz"};

/// Shapes of the modes at nodes, as matrix rows.
struct FeShapes {
  std::vector<FeRow> rows;                  ///< node and motion 0..5, along or about the model's x, y, z
  std::vector<std::vector<double>> values;  ///< of each row, mode by mode
};
/// Shapes from a table with the columns mode, node and some of ux, uy, uz, rotx, roty, rotz: each node in every mode of
/// `modes` once. @throws InputError with file and line, or naming node and mode that are missing
[[nodiscard]] FeShapes read_mode_shapes(const std::filesystem::path& file, const std::vector<FeMode>& modes);

/// Deflections of nodes under a unit force along the model's vertical axis at the node itself, by number, in the
/// model's units: columns node and flexibility. @throws InputError with file and line
[[nodiscard]] std::map<int, double> read_flexibility(const std::filesystem::path& file);

}  // namespace railtab
