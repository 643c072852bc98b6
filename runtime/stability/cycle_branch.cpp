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
  tangent.start /= length;
  tangent.duration /= length;
  tangent.parameter /= length;
  return tangent;
}

PeriodicMotion moved(const PeriodicMotion& from, const BranchTangent& tangent, double length, double time_step) {
  PeriodicMotion to = from;
  to.start += length * tangent.start;
  to.period = stepped_time(from.period.duration + length * tangent.duration, time_step);
  to.parameter += length * tangent.parameter;
  return to;
}

// Rest is a periodic motion too, of any period and at any parameter, which Newton's method may fall to: no cycle below
// the lowest height counts.
std::optional<BranchCycle> cycle_at(Shooting& shooting, const CycleSection& section, const PeriodicMotion& guess,
                                    const BranchLine& line, const BranchPoint& unit, double lowest_height) {
  const std::optional<PeriodicMotion> motion = shooting.solve(guess, line);
  if (!motion || motion->point(section).height < lowest_height || !shooting.differentiate(*motion)) return {};
  return BranchCycle{*motion, shooting.floquet_multipliers(), unit_tangent(shooting, section, line.normal, unit),
                     shooting.residual(), shooting.error_along_motion()};
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

// Where the parabola through three points has its extremum; none where they lie on a line.
std::optional<double> extremum(const std::array<BranchPoint, 3>& p) {
  const double left = (p[1].parameter - p[0].parameter) / (p[1].height - p[0].height);
  const double right = (p[2].parameter - p[1].parameter) / (p[2].height - p[1].height);
  const double bend = (right - left) / (p[2].height - p[0].height);
  const double height = 0.5 * (p[0].height + p[1].height) - 0.5 * left / bend;
  if (!std::isfinite(height)) return {};
  return height;
}

}  // namespace

SteppedTime stepped_time(double duration, double longest_step) {
  return {duration, std::max(1, static_cast<int>(std::ceil(duration / longest_step)))};
}

CycleBranch follow_branch(const Flow& flow, const CycleSection& section, const CycleBranchStart& start,
                          const BranchSearch& search, const std::function<bool(const BranchCycle&)>& listener) {
  CycleBranch branch;
  Shooting shooting(flow, section, search.shooting);
  std::optional<BranchCycle> cycle =
      cycle_at(shooting, section, start.guess, start.line, search.unit, search.lowest_height);
  if (!cycle) return branch;
  const BranchPoint first = direction_of(cycle->tangent, section, search.unit);
  double length = search.first_step;
  double sense = first.height * start.forward.height + first.parameter * start.forward.parameter < 0.0 ? -1.0 : 1.0;
  for (;;) {
    cycle->tangent.start *= sense;
    cycle->tangent.duration *= sense;
    cycle->tangent.parameter *= sense;
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
      cycle = cycle_at(shooting, section, next, across, search.unit, search.lowest_height);
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

std::optional<BranchCycle> fold_near(const Flow& flow, const CycleSection& section, const CycleBranch& branch,
                                     std::size_t cycle, const BranchSearch& search) {
  std::array<BranchCycle, 3> around{branch.cycles[cycle - 1], branch.cycles[cycle], branch.cycles[cycle + 1]};
  Shooting shooting(flow, section, search.shooting);
  constexpr int most_parabolas = 12;
  for (int i = 0; i < most_parabolas; ++i) {
    const auto height =
        extremum({around[0].motion.point(section), around[1].motion.point(section), around[2].motion.point(section)});
    if (!height) return around[1];
    PeriodicMotion guess = around[1].motion;
    const double slope = around[1].tangent.start[section.coordinate];
    const double length = slope != 0.0 ? (*height - guess.point(section).height) / slope : 0.0;
    guess = moved(guess, around[1].tangent, length, search.time_step);
    const BranchLine level{{*height, guess.parameter}, {1.0 / search.unit.height, 0.0}};
    const auto found = cycle_at(shooting, section, guess, level, search.unit, search.lowest_height);
    if (!found) return {};
    const double change = std::abs(found->motion.parameter - around[1].motion.parameter);
    const auto height_of = [&](std::size_t k) { return around[k].motion.point(section).height; };
    const bool rises = height_of(2) > height_of(0);
    const bool beyond = (*height > height_of(1)) == rises;  // between the middle and the last
    if (beyond) around[0] = std::exchange(around[1], *found);
    if (!beyond) around[2] = std::exchange(around[1], *found);
    if (change < search.parameter_tolerance) return around[1];
  }
  return {};
}

}  // namespace railtab
