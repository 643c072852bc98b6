#pragma once

#include <span>

#include "railtab/tablegen/creep_job.hpp"

namespace railtab {

/// The table of all its solved cases, with the largest and mean proofs as statistics "sweep.<name>".
[[nodiscard]] CreepTableData creep_table_of(const CreepJob& job, std::span<const SolvedCreepCase> solved);

}  // namespace railtab
