#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "railtab/tablegen/creep_layout.hpp"
#include "railtab/tablegen/creep_sweep.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tables/creep_table.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

/// All that decides the numbers of a creep table, or of one shard of it.
struct CreepJob {
  CreepLayoutOptions layout;  ///< with Poisson's ratio and the elements of the exact solution
  double tolerance = 1e-6;    ///< on the residual of each solution
  std::optional<TableShard> shard;

  /// @throws InputError
  void validate() const;
};

/// What run_creep_job() did.
struct CreepJobOutcome {
  std::size_t cases = 0;        ///< of the table or the shard
  std::size_t resumed = 0;      ///< of these, read from the file of an interrupted run
  double seconds = 0.0;         ///< wall time of the sweep
  std::size_t safe_method = 0;  ///< cases that Newton's method did not solve
  double worst_residual = 0.0;  ///< of all cases
};

/// Solves the cases of a creep table and writes `file`: the table, or a shard file for merge_creep_shards().
///
/// While it runs, `file`.partial holds all lines that are done, flushed ten times a second. Where that file is found,
/// the job goes on after its last line, with the same bits in the result as without interruption; it is removed at the
/// end.
/// @throws InputError where `file`.partial belongs to another job (naming what differs), is damaged or in use;
/// ComputationError as sweep_creep().
CreepJobOutcome run_creep_job(const CreepJob& job, const std::filesystem::path& file, const TableProvenance& provenance,
                              const Progress& progress = {});

/// The table of all its shards, in any order, equal to the last bit to one generated without shards.
/// @throws InputError where a file is no finished shard, was generated with other options or by another version than
/// the first (naming the file and what differs), or a shard is there twice or not at all.
[[nodiscard]] CreepTableData merge_creep_shards(const std::vector<std::filesystem::path>& shards);

/// "railtab-creep-shard", the file type of a finished shard; "railtab-creep-partial", that of an interrupted job.
inline constexpr std::string_view creep_shard_filetype = "railtab-creep-shard";
inline constexpr std::string_view creep_partial_filetype = "railtab-creep-partial";

}  // namespace railtab
