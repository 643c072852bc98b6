#include "railtab/runtime/stability/hunting_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"

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

bool is_fold(const CycleBranch& branch, std::size_t i) {
  const auto speed = [&](std::size_t k) { return branch.cycles[k].motion.parameter; };
  return i > 0 && i + 1 < branch.cycles.size() && (speed(i) - speed(i - 1)) * (speed(i + 1) - speed(i)) < 0.0;
}

}  // namespace

double LimitCycle::amplitude() const { return *std::max_element(amplitudes.begin(), amplitudes.end()); }

std::optional<double> HuntingBranch::nonlinear_critical_speed() const {
  if (!linear.critical) return {};
  double lowest = linear.critical->speed;
  for (const std::vector<LimitCycle>* group : {&cycles, &folds}) {
    for (const LimitCycle& cycle : *group) lowest = std::min(lowest, cycle.speed);
  }
  return lowest;
}

HuntingBranch hunting_branch(const VsiModel& model, const HuntingSearch& search,
                             const std::function<bool(const LimitCycle&)>& listener) {
  HuntingBranch result;
  const VehicleFlow flow(model, search.alpha);
  result.linear = linear_critical_speed(model, search.speed);
  if (!result.linear.critical) return result;
  const double critical = result.linear.critical->speed;
  const VsiModel rigid = flow.model_at(critical);
  const LinearShape shape = lateral_shapes(model, critical)[index(search.speed.motion - 1)];
  result.section_wheelset = leading_wheelset(model.vehicle, shape);
  const CycleSection section = flow.lateral_section(result.section_wheelset);
  const PeriodicMotion guess = linear_cycle(rigid, flow, shape, result.section_wheelset, search.first_amplitude,
                                            search.time_step);
  BranchSearch along{.unit = branch_unit,
                     .first_step = search.first_amplitude / branch_unit.height,
                     .largest_step = search.largest_step,
                     .lowest_parameter = search.speed.low,
                     .highest_parameter = search.speed.high,
                     .lowest_height = 0.5 * search.first_amplitude,
                     .highest_height = search.largest_amplitude,
                     .time_step = search.time_step,
                     .max_cycles = search.max_cycles};
  const BranchLine first{guess.point(section), {1.0 / branch_unit.height, 0.0}};
  const CycleBranch branch = follow_branch(flow, section, guess, first, {1.0, 0.0}, along, [&](const BranchCycle& c) {
    result.cycles.push_back(limit_cycle(flow, c));
    return !listener || listener(result.cycles.back());
  });
  result.end = branch.end;
  if (result.cycles.empty()) {
    throw ComputationError(fmt::format(
        "no limit cycle of {} found near its linear critical speed of {:.4f} m/s with an amplitude of {:.3g} m: set "
        "another first amplitude or a shorter time step",
        model.vehicle.name, critical, search.first_amplitude));
  }
  result.bifurcation = branch.cycles.front().tangent.parameter < 0.0 ? Bifurcation::subcritical
                                                                     : Bifurcation::supercritical;
  for (std::size_t i = 0; i < branch.cycles.size(); ++i) {
    if (!is_fold(branch, i)) continue;
    if (const auto fold = fold_near(flow, section, branch, i, along)) {
      result.folds.push_back(limit_cycle(flow, *fold));
    }
  }
  return result;
}

}  // namespace railtab
