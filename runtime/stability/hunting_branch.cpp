#include "railtab/runtime/stability/hunting_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/stability/branch_folds.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {

namespace {

constexpr BranchPoint branch_unit{1e-3, 2.0};  // m, m/s

LimitCycle limit_cycle(const VehicleFlow& flow, const BranchCycle& cycle) {
  LimitCycle result;
  result.speed = cycle.motion.parameter;
  result.frequency = 1.0 / cycle.motion.period.duration;
  for (const VehicleFlow::Extent& y :
       flow.lateral_extents(cycle.motion.start, cycle.motion.period, cycle.motion.parameter)) {
    result.amplitudes.push_back(y.amplitude());
  }
  result.multiplier = cycle.multipliers[0];
  result.residual = cycle.residual;
  result.error_along_motion = cycle.error_along_motion;
  result.motion = cycle.motion;
  return result;
}

// The wheelset that moves most in the linear motion.
int leading_wheelset(const VehicleModel& vehicle, const LinearShape& shape) {
  int leading = 0;
  double largest = 0.0;
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const double moves = std::abs(shape.displacement[vehicle.dof[index(vehicle.wheelsets[w])][1]]);
    if (moves <= largest) continue;
    largest = moves;
    leading = static_cast<int>(w);
  }
  return leading;
}

// The linear motion about rest with a lateral amplitude of a wheelset, when that is farthest to the right.
PeriodicMotion linear_cycle(const VsiModel& model, const VehicleFlow& flow, const LinearShape& shape, int wheelset,
                            double amplitude, double time_step) {
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) {
    throw ComputationError(fmt::format("{} does not come to rest on straight rails at {:.6g} m/s", model.vehicle.name,
                                       model.contact.speed));
  }
  const int y = model.vehicle.dof[index(model.vehicle.wheelsets[index(wheelset)])][1];
  const Eigen::VectorXcd displacement = shape.displacement * (amplitude / shape.displacement[y]);
  const double frequency = std::abs(shape.value.imag());
  const std::complex<double> turning(0.0, shape.value.imag());
  LinearMotion& motion = state.vehicle[0];
  motion.displacement += displacement.real();
  motion.velocity += (turning * displacement).real();
  return {flow.packed(motion), stepped_time(2.0 * std::numbers::pi / frequency, time_step), model.contact.speed};
}

// The end of a simulation: states at each step.
struct SettledMotion {
  std::vector<double> time;
  std::vector<Eigen::VectorXd> state;
};

SettledMotion settled_motion(const VehicleFlow& flow, const HuntingSearch& search) {
  const SettledStart& start = *search.start;
  const VsiModel model = flow.model_at(start.speed);
  VsiState state(model);
  if (!static_equilibrium(model, state).converged || !displace_train(model, start.shift, 0.0, state)) {
    throw ComputationError(fmt::format("{} does not stand {:.3g} m aside on straight rails: set a smaller shift",
                                       model.vehicle.name, start.shift));
  }
  IntegrationParameters integration;
  integration.time_step = search.time_step;
  integration.alpha = search.alpha;
  constexpr double kept = 3.0;  // s: several cycles
  SettledMotion motion;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    if (now.time < start.duration - kept) return;
    motion.time.push_back(now.time);
    motion.state.push_back(flow.packed(now.vehicle[0]));
  };
  const RunSummary summary = simulate(model, integration, start.duration, 1, state, observer);
  if (!summary.complete) {
    throw ComputationError(fmt::format("simulation at {:.6g} m/s: {}", start.speed, summary.message));
  }
  return motion;
}

double lateral_range(const SettledMotion& motion, Eigen::Index y) {
  double low = 0.0, high = 0.0;
  for (const Eigen::VectorXd& x : motion.state) {
    low = std::min(low, x[y]);
    high = std::max(high, x[y]);
  }
  return high - low;
}

// The last cycle of a motion from where a wheelset is farthest to the right; none where it does not oscillate.
std::optional<PeriodicMotion> last_cycle(const SettledMotion& motion, Eigen::Index y, double speed, double time_step) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < motion.state.size(); ++i) {
    const double before = motion.state[i - 1][y], now = motion.state[i][y];
    if (before < 0.0 && now >= 0.0) crossings.push_back(motion.time[i] - time_step * now / (now - before));
  }
  constexpr std::size_t fewest = 3;
  if (crossings.size() < fewest || lateral_range(motion, y) < 1e-4) return {};
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  std::size_t farthest = motion.state.size() - 1;
  for (std::size_t i = motion.state.size(); i-- > 0 && motion.time[i] > motion.time.back() - 1.02 * period;) {
    if (motion.state[i][y] > motion.state[farthest][y]) farthest = i;
  }
  return PeriodicMotion{motion.state[farthest], stepped_time(period, time_step), speed};
}

}  // namespace

double LimitCycle::amplitude() const { return *std::max_element(amplitudes.begin(), amplitudes.end()); }

std::optional<double> HuntingBranch::nonlinear_critical_speed() const {
  double lowest = linear.critical ? linear.critical->speed : std::numeric_limits<double>::infinity();
  for (const LimitCycle& cycle : cycles) lowest = std::min(lowest, cycle.speed);
  for (const LimitCycleFold& fold : folds) lowest = std::min(lowest, fold.cycle.speed);
  if (!std::isfinite(lowest)) return {};
  return lowest;
}

namespace {

// What a branch begins with.
struct FirstCycle {
  PeriodicMotion guess;
  BranchLine line;
  int wheelset = 0;  // of the section
};

FirstCycle linear_start(const VsiModel& linear, const VsiModel& model, const VehicleFlow& flow,
                        const HuntingSearch& search, double critical) {
  const LinearShape shape = lateral_shapes(linear, critical)[index(search.speed.motion - 1)];
  const int wheelset = leading_wheelset(model.vehicle, shape);
  const PeriodicMotion guess =
      linear_cycle(flow.model_at(critical), flow, shape, wheelset, search.first_amplitude, search.time_step);
  return {guess, {guess.point(flow.lateral_section(wheelset)), {1.0 / branch_unit.height, 0.0}}, wheelset};
}

FirstCycle settled_start(const VsiModel& model, const VehicleFlow& flow, const HuntingSearch& search) {
  const SettledMotion motion = settled_motion(flow, search);
  int wheelset = 0;
  for (int w = 1; w < model.wheelsets_per_vehicle(); ++w) {
    const auto range = [&](int k) { return lateral_range(motion, flow.lateral_section(k).coordinate); };
    if (range(w) > range(wheelset)) wheelset = w;
  }
  const CycleSection section = flow.lateral_section(wheelset);
  const auto guess = last_cycle(motion, section.coordinate, search.start->speed, search.time_step);
  if (!guess) {
    throw ComputationError(fmt::format(
        "a simulation of {} at {:.6g} m/s comes to rest after a shift of {:.3g} m: begin at a higher speed or farther "
        "aside",
        model.vehicle.name, search.start->speed, search.start->shift));
  }
  return {*guess, {guess->point(section), {0.0, 1.0 / branch_unit.parameter}}, wheelset};
}

BranchSearch branch_search(const HuntingSearch& search) {
  return {.unit = branch_unit,
          .first_step = search.first_amplitude / branch_unit.height,
          .largest_step = search.largest_step,
          .lowest_parameter = search.speed.low,
          .highest_parameter = search.speed.high,
          .lowest_height = 0.5 * search.first_amplitude,
          .highest_height = search.largest_amplitude,
          .time_step = search.time_step,
          .max_cycles = search.max_cycles,
          .shooting = {}};
}

// One branch of two that begin with the same cycle, from the end of the first to that of the second.
CycleBranch joined(CycleBranch first, const CycleBranch& second) {
  std::reverse(first.cycles.begin(), first.cycles.end());
  for (BranchCycle& cycle : first.cycles) cycle.tangent.scale(-1.0);
  if (!second.cycles.empty()) first.cycles.insert(first.cycles.end(), second.cycles.begin() + 1, second.cycles.end());
  first.end = second.end;
  return first;
}

}  // namespace

HuntingBranch hunting_branch(const VsiModel& linear, const VsiModel& model, const HuntingSearch& search,
                             const std::function<bool(const LimitCycle&)>& listener) {
  HuntingBranch result;
  const VehicleFlow flow(model, search.alpha);
  result.linear = linear_critical_speed(linear, search.speed);
  if (!result.linear.critical && !search.start) return result;
  const FirstCycle start = search.start ? settled_start(model, flow, search)
                                        : linear_start(linear, model, flow, search, result.linear.critical->speed);
  result.section_wheelset = start.wheelset;
  const CycleSection section = flow.lateral_section(start.wheelset);
  const BranchSearch along = branch_search(search);
  const auto tell = [&](const BranchCycle& cycle) { return !listener || listener(limit_cycle(flow, cycle)); };
  const auto follow = [&](const BranchPoint& forward) {
    return follow_branch(flow, section, {start.guess, start.line, forward}, along, tell);
  };
  CycleBranch branch = follow(search.start ? BranchPoint{0.0, 1.0} : BranchPoint{1.0, 0.0});
  if (search.start) branch = joined(std::move(branch), follow({0.0, -1.0}));
  result.end = branch.end;
  if (branch.cycles.empty()) {
    throw ComputationError(
        fmt::format("no limit cycle of {} found near {:.4f} m/s, where Newton's method does not "
                    "converge: set a shorter time step or begin at another speed",
                    model.vehicle.name, start.guess.parameter));
  }
  if (!search.start) {
    result.bifurcation =
        branch.cycles.front().tangent.parameter < 0.0 ? Bifurcation::subcritical : Bifurcation::supercritical;
  }
  for (const BranchCycle& cycle : branch.cycles) result.cycles.push_back(limit_cycle(flow, cycle));
  for (const BranchFold& fold : branch_folds(flow, section, branch, along)) {
    const auto [before, after] = fold.bracket;
    result.folds.push_back(
        {limit_cycle(flow, fold.cycle), {limit_cycle(flow, before), limit_cycle(flow, after)}, fold.converged});
  }
  return result;
}

}  // namespace railtab
