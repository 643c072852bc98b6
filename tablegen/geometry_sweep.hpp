#pragma once

#include <filesystem>
#include <functional>
#include <vector>

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
  double lateral_root = 0.2e-3;       ///< largest width of a root cell along the sheared lateral axis, 1e-6..1e-2 [m]
  int yaw_roots = 4;                  ///< root cells along yaw², where yaw is an interval
  double roll_root = 2.5e-3;          ///< largest width of a root cell along roll, 1e-5..0.05 [rad]
  double searched_lowering = 0.4e-3;  ///< lowering below first touch up to which the table is generated, 1e-6..0.01 [m]
  double start_error = 32e-6;         ///< a cell is halved where its starts are further off along the wheel [m] ...
  double iterated_cell = 2e-5;        ///< ... as long as this share of uniform queries or more falls into it
  double fallback_cell = 2e-6;        ///< ... and as long as this share of uniform queries is searched in it
  TableShard shard;                   ///< the slab of root cells to generate
  double tolerance = 1e-8;            ///< penetration error asked for, 1e-12..1e-3 [m]

  [[nodiscard]] Interval yaw_amounts() const noexcept;  ///< least and largest amount of yaw [rad]
  /// @throws InputError naming the first member out of its range.
  void validate() const;

  /// With the start error halved and both shares quartered, so many times.
  [[nodiscard]] GeometrySweepOptions refined(int times) const;
};

/// Told the share done, 0..1, from one thread at a time.
using Progress = std::function<void(double)>;

/// Halves the root cells until every leaf's polynomials lead the Newton iteration to what the online search finds, at
/// points of the closed leaf and lowerings up to searched_lowering (OpenMP over the root cells, each by itself). What
/// is still wrong in the smallest leaves limits the lowering up to which they are trusted.
/// @throws InputError for options out of range, and where the wheel meets the rail nowhere in the range.
[[nodiscard]] GeometryTableData sweep_geometry(const ContactSearch& search, const GeometrySweepOptions& options,
                                               const Progress& progress = {});

/// @throws InputError where the wheel meets the rail nowhere in the range of a whole table
void require_contact(const GeometryTableData& table);

/// sweep_geometry(), and, of a whole table, the check of certify_merged_geometry_table(), with finer cells until it
/// passes. A part (options.shard) is not certified: merge_geometry_tables() first.
/// @throws ComputationError where the second refinement does not reach the tolerance; the message says what was
/// reached.
[[nodiscard]] GeometryTableData generate_geometry_table(const ContactSearch& search,
                                                        const GeometrySweepOptions& options,
                                                        const Progress& progress = {});

/// generate_geometry_table() into a file, written under its final name when it is whole. Of a whole table an eighth at
/// a time is swept and kept beside it (FILE.part-<refinement>-<1..8>): after a kill the same call goes on from there,
/// to the same table bit for bit. A part of another pair or other options is generated again; all parts are removed at
/// the end.
/// @throws ComputationError as generate_geometry_table(), InputError where the file cannot be written
void generate_geometry_table_file(const ContactSearch& search, const GeometrySweepOptions& options,
                                  const TableProvenance& provenance, const std::filesystem::path& file,
                                  const Progress& progress = {});

/// The whole table of its parts, the slabs of the same sweep, in any order. Not certified yet.
/// @throws InputError where a part is missing, there twice, or not of the same pair, range and options.
[[nodiscard]] GeometryTableData merge_geometry_tables(std::vector<GeometryTableData> parts);

/// Holds a table against the exact overlap of the outlines in every leaf (certify_outlines()), trusts leaves that
/// disagree only as far as they agree, then holds it against the online search on 2000 random queries
/// (verify_geometry_table()). Stores the statistics in it.
/// @throws ComputationError where the penetration error is above the tolerance at the 99.9 % point or a patch is missed
///         or invented, a search with a finer scan judging where the table differs from the online search, or
///         leaves still disagree with the exact overlap; the message says what was reached and what to do.
void certify_merged_geometry_table(GeometryTableData& table);

}  // namespace railtab
