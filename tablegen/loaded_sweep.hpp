#pragma once

#include <filesystem>
#include <functional>

#include "railtab/tablegen/contact_jumps.hpp"
#include "railtab/tablegen/loaded_column.hpp"
#include "railtab/tables/loaded_table.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

/// What the loaded part of a table covers, and how finely.
struct LoadedSweepOptions {
  /// Of the reduced lateral shift y0: of the wheelset at reduced roll 0, low < high, within ±0.1 [m].
  Interval lateral{-0.008, 0.008};
  /// Of the wheelset against the rail head, within ±0.1 [rad], low < high; with climb that of roll + climb·y.
  Interval roll{-0.005, 0.005};
  double climb = 0.0;           ///< as of LoadedTableData; |roll| + climb·|lateral| at most 0.1 rad
  double yaw = 0.010;           ///< largest, 0..0.2 [rad]; 0: without yaw
  double largest_load = 300e3;  ///< vertical force at y = 0 up to which energies are tabulated, 1e3..1e7 [N]
  int levels = 33;              ///< of energy, 5..1000
  /// Of nodes of roll at most, 3 nodes at least, 1e-5..0.1 [rad]. Halved once where the largest pressure under 10 kN,
  /// half-way between two of them and without yaw, is off by more than 4 %.
  double roll_spacing = 1e-3;
  int yaw_nodes = 4;            ///< 2..LoadedTable::most_yaws where not fixed
  double force_error = 2.5e-3;  ///< of the vertical force above 5 kN, at which an interval of y0 is halved, 1e-5..0.1
  double light_error = 8e-3;    ///< the same from 1 to 5 kN
  double least_interval =
      8e-6;  ///< of y0, not halved further: smaller ones would show the solutions' noise, 1e-8..1e-3 [m]
  LoadedContactOptions contact;  ///< its elements: 28 across unless asked for otherwise

  LoadedSweepOptions() { contact.elements.across_narrowest = 28; }

  /// @throws InputError naming the first member out of its range
  void validate() const;
};

/// A column of nodes over the energy, in the numbering of a sweep's nodes of roll and yaw².
struct LoadedSweepColumn {
  double y0 = 0.0;
  std::size_t roll = 0, yaw = 0;
  LateralWarp::Place shift{};
  LoadedColumn solution;
};

/// Columns that outlive the sweep: those known at its start, and where new ones go, from one thread at a time.
struct LoadedColumnStore {
  std::vector<LoadedSweepColumn> known;
  std::function<void(const LoadedSweepColumn&)> keep;
};

/// Solves the loaded contact at the nodes of a table. All intervals of roll are halved where roll_spacing says.
/// Intervals of y0 are halved until the interpolation agrees with the solution in their middle, without roll and yaw
/// and at two corners of their range (OpenMP over columns).
/// @throws InputError, ComputationError of loaded_column()
[[nodiscard]] LoadedTableData sweep_loaded(const ContactSearch& search, const LoadedSweepOptions& options,
                                           LoadedColumnStore store = {}, const Progress& progress = {});

/// sweep_loaded() into the file of the pair's geometry table. Columns are kept beside it as they are solved
/// (FILE.loaded-partial): after a kill the same call goes on from there, to the same table bit for bit. A partial file
/// of another pair or other options is begun anew.
/// @throws InputError where the file is no whole geometry table or cannot be written
void add_loaded_table(const std::filesystem::path& file, const LoadedSweepOptions& options,
                      const TableProvenance& provenance, const Progress& progress = {});

}  // namespace railtab
