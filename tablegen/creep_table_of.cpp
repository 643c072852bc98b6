#include "railtab/tablegen/creep_table_of.hpp"

#include <algorithm>
#include <limits>

namespace railtab {

namespace {

std::vector<std::pair<std::string, double>> statistics(const CreepJob& job, std::span<const SolvedCreepCase> solved) {
  SolvedCreepCase worst;
  worst.bound_excess = -std::numeric_limits<double>::infinity();
  double difference = 0.0;
  std::size_t safe = 0;
  for (const SolvedCreepCase& c : solved) {
    worst.residual = std::max(worst.residual, c.residual);
    worst.bound_excess = std::max(worst.bound_excess, c.bound_excess);
    worst.slip_deviation = std::max(worst.slip_deviation, c.slip_deviation);
    worst.grid_difference = std::max(worst.grid_difference, c.grid_difference);
    difference += c.grid_difference;
    safe += c.safe_method ? 1 : 0;
  }
  const auto count = static_cast<double>(solved.size());
  return {{"sweep.cases", count},
          {"sweep.tolerance", job.tolerance},
          {"sweep.residual.max", worst.residual},
          {"sweep.bound_excess.max", worst.bound_excess},
          {"sweep.slip_deviation.max", worst.slip_deviation},
          {"sweep.grid_difference.mean", difference / count},
          {"sweep.grid_difference.max", worst.grid_difference},
          {"sweep.safe_method_cases", static_cast<double>(safe)}};
}

}  // namespace

CreepTableData creep_table_of(const CreepJob& job, std::span<const SolvedCreepCase> solved) {
  std::vector<CreepForce> forces;
  forces.reserve(solved.size());
  for (const SolvedCreepCase& c : solved) forces.push_back(c.force);
  CreepTableData table = assemble_creep_table(job.layout, forces);
  for (auto& entry : statistics(job, solved)) table.statistics.push_back(std::move(entry));
  return table;
}

}  // namespace railtab
