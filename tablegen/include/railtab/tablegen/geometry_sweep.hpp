#pragma once

#include <functional>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// A closed interval; low = high for a quantity held fixed.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// What a geometry table covers, and how finely.
struct GeometrySweepOptions {
  Interval lateral{-0.012, 0.012};    ///< wheelset lateral shift y, low < high, within ±0.1 [m]
  Interval yaw{-0.030, 0.030};        ///< within ±0.2 [rad]; the table is even in yaw
  Interval roll{0.0, 0.0};            ///< of the wheelset against the rail head, within ±0.1 [rad]
  double lateral_step = 0.05e-3;      ///< largest node spacing of the sheared lateral axis, 1e-6..1e-3 [m]
  int yaw_nodes = 9;                  ///< uniform in yaw², at least 2 where yaw is an interval
  double roll_step = 1e-3;            ///< largest node spacing of the roll axis, 1e-5..0.05 [rad]
  double branch_height = 3e-3;        ///< branches are followed up to this height above first touch, > 0 [m]
  double searched_lowering = 0.4e-3;  ///< height above first touch up to which search windows are made,
                                      ///< 1e-6..branch_height [m]
  double tolerance = 1e-8;            ///< penetration error asked for, 1e-12..1e-3 [m]

  /// @throws InputError naming the first member out of its range.
  void validate() const;
};

/// Told the share done, 0..1, from one thread at a time.
using Progress = std::function<void(double)>;

/// Runs the online search on every node of the grid (OpenMP), follows the branches, sets the limits of trust from the
/// branches' ends and checks each cell against the online search at points off the nodes: a cell in which a touching
/// minimum is missing from the table, or a table start does not lead to it, is limited to the height of that minimum.
/// @throws InputError for options out of range, ComputationError where the wheel meets the rail nowhere in the range.
[[nodiscard]] GeometryTableData sweep_geometry(const ContactSearch& search, const GeometrySweepOptions& options,
                                               const Progress& progress = {});

/// sweep_geometry() at `options.lateral_step`, halved until the table keeps its word: on 2000 random queries
/// (verify_geometry_table()) the penetration error is within `options.tolerance` at the 99.9 % point and no patch is
/// missed or invented, a search with a finer scan judging where it differs from the online search. Statistics and
/// options are stored in the table.
/// @throws ComputationError where three halvings do not reach the tolerance; the message says what was reached.
[[nodiscard]] GeometryTableData generate_geometry_table(const ContactSearch& search,
                                                        const GeometrySweepOptions& options,
                                                        const Progress& progress = {});

}  // namespace railtab
