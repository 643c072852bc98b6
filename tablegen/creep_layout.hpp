#pragma once

#include <array>
#include <span>
#include <vector>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tables/creep_table.hpp"

namespace railtab {

/// One rolling contact to be solved exactly, normalised (G = μF_n = √(ab) = 1).
struct CreepCase {
  double ratio;  ///< a/b
  Creepage creepage;
};

/// The axes of a creep table and how its nodes are computed.
struct CreepLayoutOptions {
  CreepTableLayout layout = CreepTableLayout::smooth;
  double poisson = 0.28;  ///< 0..0.5
  int elements = 40;      ///< of the exact solution, recorded in the table
  /// Nodes of the smooth layout along a/b, radius, polar angle, azimuth; the paper's layout is fixed.
  std::array<int, 4> nodes = {15, 26, 16, 36};

  /// @throws InputError
  void validate() const;
};

/// The cases that a table needs, those of one a/b next to each other, neighbours in creepage mostly as well.
/// The same options give the same list, bit for bit. @throws InputError
[[nodiscard]] std::vector<CreepCase> creep_cases(const CreepLayoutOptions& options);

/// The table of the solved cases: `solved` in the order of creep_cases(). Complete sliding comes from quadrature, the
/// limit of zero creepage from the linear cases among `solved`. Provenance and statistics are left empty.
/// @throws InputError where the number of cases differs or a value is not finite.
[[nodiscard]] CreepTableData assemble_creep_table(const CreepLayoutOptions& options,
                                                  std::span<const CreepForce> solved);

}  // namespace railtab
