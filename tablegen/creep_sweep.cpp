#include "railtab/tablegen/creep_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/parallel_failure.hpp"
#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {

namespace {

constexpr std::size_t kLineLength = 64;  // the set-up of an ellipse costs as much as one or two cases
constexpr double kBoundExcess = 1e-12;   // of an element's traction: rounding

/// One thread's solver, set up anew where a/b changes.
class LineSolver {
 public:
  explicit LineSolver(const CreepSweepOptions& options) : poisson_(options.poisson) {
    contact_.elements = options.elements;
    contact_.tolerance = options.tolerance;
  }
  std::vector<SolvedCreepCase> solve(std::span<const CreepCase> line);

 private:
  double poisson_, ratio_ = 0.0;
  RollingContactOptions contact_;
  std::optional<ExtrapolatedRollingContact> solver_;
};

SolvedCreepCase checked(const CreepCase& c, const ExtrapolatedContactSolution& s) {
  SolvedCreepCase solved;
  solved.force = s.force;
  solved.residual = std::max(s.coarse.residual, s.fine.residual);
  solved.bound_excess = std::max(s.coarse.bound_excess, s.fine.bound_excess);
  solved.slip_deviation = std::max(s.coarse.slip_deviation, s.fine.slip_deviation);
  solved.grid_difference = std::hypot(s.fine.force.x - s.coarse.force.x, s.fine.force.y - s.coarse.force.y);
  solved.safe_method = s.coarse.safe_method || s.fine.safe_method;
  if (!s.coarse.converged || !s.fine.converged || !(solved.bound_excess <= kBoundExcess)) {
    throw ComputationError(
        fmt::format("rolling contact at a/b = {}, creepage {}, {}, {}: no solution, residual {:.2g}, friction exceeded "
                    "by {:.2g}",
                    c.ratio, c.creepage.x, c.creepage.y, c.creepage.spin, solved.residual, solved.bound_excess));
  }
  return solved;
}

std::vector<SolvedCreepCase> LineSolver::solve(std::span<const CreepCase> line) {
  std::vector<SolvedCreepCase> solved;
  std::vector<double> neighbour;  // tractions of the case before, on the coarse grid
  for (const CreepCase& c : line) {
    if (!solver_ || c.ratio != ratio_) {
      solver_.emplace(c.ratio, poisson_, contact_);
      ratio_ = c.ratio;
    }
    ExtrapolatedContactSolution s = solver_->solve(c.creepage, neighbour.empty() ? nullptr : &neighbour);
    solved.push_back(checked(c, s));
    neighbour = std::move(s.coarse.traction);
  }
  return solved;
}

/// Hands lines to the sink in their order, whatever the order in which threads finish them.
class InOrder {
 public:
  explicit InOrder(const CreepSink& sink) : sink_(sink) {}
  void add(std::size_t line, std::vector<SolvedCreepCase> solved) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(line, std::move(solved));
    for (auto next = waiting_.begin(); next != waiting_.end() && next->first == told_; next = waiting_.begin()) {
      sink_(next->second);
      waiting_.erase(next);
      ++told_;
    }
  }

 private:
  const CreepSink& sink_;
  std::mutex mutex_;
  std::map<std::size_t, std::vector<SolvedCreepCase>> waiting_;
  std::size_t told_ = 0;
};

}  // namespace

void CreepSweepOptions::validate() const {
  RollingContactOptions contact;
  contact.elements = elements;
  contact.tolerance = tolerance;
  contact.validate();
  if (elements < 8 || elements % 2 != 0) {
    throw input_error("elements", fmt::format("{}", elements), "an even number, 8..240");
  }
  if (!(poisson >= 0.0 && poisson <= 0.5)) throw input_error("poisson", fmt::format("{}", poisson), "0..0.5");
}

std::vector<CreepLine> creep_lines(std::span<const CreepCase> cases) {
  std::vector<CreepLine> lines;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (i == 0 || cases[i].ratio != cases[i - 1].ratio || lines.back().count == kLineLength) lines.push_back({i, 0});
    ++lines.back().count;
  }
  return lines;
}

std::vector<CreepLine> shard_lines(std::span<const CreepLine> lines, int shard, int shards) {
  assert(shard >= 1 && shard <= shards);
  std::vector<CreepLine> own;
  for (std::size_t i = static_cast<std::size_t>(shard - 1); i < lines.size(); i += static_cast<std::size_t>(shards)) {
    own.push_back(lines[i]);
  }
  return own;
}

void sweep_creep(std::span<const CreepCase> cases, std::span<const CreepLine> lines, const CreepSweepOptions& options,
                 const CreepSink& sink) {
  options.validate();
  InOrder in_order(sink);
  ParallelFailure failure;
#pragma omp parallel
  {
    LineSolver solver(options);
#pragma omp for schedule(monotonic : dynamic, 1)
    for (std::size_t i = 0; i < lines.size(); ++i) {
      failure.guard([&] { in_order.add(i, solver.solve(cases.subspan(lines[i].first, lines[i].count))); });
    }
  }
  failure.rethrow();
}

}  // namespace railtab
