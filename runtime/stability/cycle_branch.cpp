#include "railtab/runtime/stability/cycle_branch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace railtab {

namespace {

// A step that turns the branch by more than this is too long [cosine].
constexpr double largest_turn = 0.9;
// Iterations that a step of the right length takes.
constexpr int few_iterations = 4, many_iterations = 10;

BranchPoint direction_of(const BranchTangent& tangent, const CycleSection& section, const BranchPoint& unit) {
  return {tangent.start[section.coordinate] / unit.height, tangent.parameter / unit.parameter};
}

// The tangent with length 1 in units of the branch.
BranchTangent unit_tangent(const Shooting& shooting, const CycleSection& section, const BranchPoint& normal,
                           const BranchPoint& unit) {
  BranchTangent tangent = shooting.tangent(normal);
  const BranchPoint direction = direction_of(tangent, section, unit);
  const double length = std::hypot(direction.height, direction.parameter);
  tangent.scale(1.0 / length);
  return tangent;
}

PeriodicMotion moved(const PeriodicMotion& from, const BranchTangent& tangent, double length, double time_step) {
  PeriodicMotion to = from;
  to.start += length * tangent.start;
  to.period = stepped_time(from.period.duration + length * tangent.duration, time_step);
  to.parameter += length * tangent.parameter;
  return to;
}

std::optional<BranchEnd> end_at(const BranchPoint& point, const BranchSearch& search) {
  if (point.parameter < search.lowest_parameter || point.parameter > search.highest_parameter) {
    return BranchEnd::parameter_range;
  }
  if (point.height > search.highest_height) return BranchEnd::height_range;
  return {};
}

// Why no cycle was found near a guess.
BranchEnd end_before(const PeriodicMotion& guess, const CycleSection& section, const BranchSearch& search) {
  const bool low = guess.point(section).height < search.lowest_height + search.smallest_step * search.unit.height;
  return low ? BranchEnd::height_range : BranchEnd::no_convergence;
}

}  // namespace

std::optional<BranchCycle> cycle_near(Shooting& shooting, const CycleSection& section, const PeriodicMotion& guess,
                                      const BranchLine& line, const BranchSearch& search) {
  const std::optional<PeriodicMotion> motion = shooting.solve(guess, line);
  if (!motion || motion->point(section).height < search.lowest_height || !shooting.differentiate(*motion)) return {};
  return BranchCycle{*motion,
                     shooting.floquet_multipliers(),
                     unit_tangent(shooting, section, line.normal, search.unit),
                     shooting.residual(),
                     shooting.error_along_motion(),
                     shooting.parameter_error(line.normal)};
}

SteppedTime stepped_time(double duration, double longest_step) {
  return {duration, std::max(1, static_cast<int>(std::ceil(duration / longest_step)))};
}

CycleBranch follow_branch(const Flow& flow, const CycleSection& section, const CycleBranchStart& start,
                          const BranchSearch& search, const std::function<bool(const BranchCycle&)>& listener) {
  CycleBranch branch;
  Shooting shooting(flow, section, search.shooting);
  std::optional<BranchCycle> cycle = cycle_near(shooting, section, start.guess, start.line, search);
  if (!cycle) return branch;
  const BranchPoint first = direction_of(cycle->tangent, section, search.unit);
  double length = search.first_step;
  double sense = first.height * start.forward.height + first.parameter * start.forward.parameter < 0.0 ? -1.0 : 1.0;
  for (;;) {
    cycle->tangent.scale(sense);
    branch.cycles.push_back(*cycle);
    if (listener && !listener(*cycle)) return branch.end = BranchEnd::stopped, branch;
    if (const auto end = end_at(cycle->motion.point(section), search)) return branch.end = *end, branch;
    if (static_cast<int>(branch.cycles.size()) >= search.max_cycles) return branch.end = BranchEnd::max_cycles, branch;

    const BranchCycle& last = branch.cycles.back();
    const BranchPoint along = direction_of(last.tangent, section, search.unit);
    for (cycle.reset(); !cycle;) {
      const PeriodicMotion next = moved(last.motion, last.tangent, length, search.time_step);
      const BranchLine across{next.point(section),
                              {along.height / search.unit.height, along.parameter / search.unit.parameter}};
      cycle = cycle_near(shooting, section, next, across, search);
      sense = 1.0;
      if (cycle) {
        const BranchPoint turned = direction_of(cycle->tangent, section, search.unit);
        if (along.height * turned.height + along.parameter * turned.parameter < largest_turn &&
            length > search.smallest_step) {
          cycle.reset();
        }
      }
      if (cycle) {
        if (shooting.iterations() <= few_iterations) length = std::min(1.5 * length, search.largest_step);
        if (shooting.iterations() >= many_iterations) length = std::max(0.5 * length, search.smallest_step);
      } else {
        if (length <= search.smallest_step) return branch.end = end_before(next, section, search), branch;
        length = std::max(0.5 * length, search.smallest_step);
        if (!shooting.differentiate(last.motion)) return branch.end = BranchEnd::no_convergence, branch;
      }
    }
  }
}

}  // namespace railtab
