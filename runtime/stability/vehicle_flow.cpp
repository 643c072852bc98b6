#include "railtab/runtime/stability/vehicle_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/stability/contact_slopes.hpp"
#include "railtab/runtime/stability/linearised_steps.hpp"
#include "railtab/runtime/stability/rigid_rails.hpp"
#include "railtab/runtime/vsi/integrator.hpp"

namespace railtab {

namespace {

constexpr std::size_t y_motion = 1, pitch_motion = 4;
constexpr double length_unit = 1e-3;       // m, rad
constexpr double rate_unit = 10.0;         // 1/s
constexpr double relative_change = 1e-6;   // of time and speed in difference quotients
constexpr double force_tolerance = 1e-10;  // of the static wheel load: far below what a closed cycle leaves

// Whether no force of the vehicle depends on a displacement, beside rounding of the matrix.
bool is_free(const VehicleModel& vehicle, int row) {
  const double ties = vehicle.stiffness.col(row).cwiseAbs().maxCoeff();
  const bool element = !vehicle.elements.empty() && vehicle.elements.rows.col(row).cwiseAbs().maxCoeff() > 0.0;
  return !element && ties < 1e-9 * vehicle.stiffness.diagonal().maxCoeff();
}

// Rows of the displacements that a motion depends on.
std::vector<int> tied_rows(const VehicleModel& vehicle) {
  std::vector<bool> free(index(vehicle.dofs()), false);
  for (const int body : vehicle.wheelsets) {
    const int row = vehicle.dof[index(body)][pitch_motion];
    if (row != held) free[index(row)] = is_free(vehicle, row);
  }
  std::vector<int> rows;
  for (int row = 0; row < vehicle.dofs(); ++row) {
    if (!free[index(row)]) rows.push_back(row);
  }
  return rows;
}

void reject_dry_friction(const VehicleModel& vehicle) {
  for (const ForceElement& element : vehicle.elements.element) {
    if (element.kind != ForceElementKind::friction) continue;
    throw input_error("scene: train.force_elements",
                      fmt::format("\"nonlinear\", with dry friction in {}", element.name),
                      "\"linear\": a limit cycle needs forces that are functions of the motion");
  }
}

// M ü = f − C u̇ − K u; rows without mass get none.
Eigen::VectorXd acceleration(const VsiModel& model, const LinearMotion& motion) {
  const VehicleModel& vehicle = model.vehicle;
  const Eigen::VectorXd force = vehicle.static_load + motion.contact_load -
                                model.vehicle_damping(model.contact.speed) * motion.velocity -
                                vehicle.stiffness * motion.displacement;
  std::vector<int> massive;
  for (int row = 0; row < vehicle.dofs(); ++row) {
    if (vehicle.mass(row, row) > 0.0) massive.push_back(row);
  }
  Eigen::VectorXd result = Eigen::VectorXd::Zero(vehicle.dofs());
  result(massive) = symmetric_solution(vehicle.mass(massive, massive), force(massive));
  return result;
}

}  // namespace

VehicleFlow::VehicleFlow(const VsiModel& model, double alpha)
    : model_(on_rigid_rails(model, model.contact.speed)), alpha_(alpha), displacements_(tied_rows(model.vehicle)) {
  reject_dry_friction(model.vehicle);
  const auto n = static_cast<Eigen::Index>(displacements_.size());
  unit_.setConstant(n + model.vehicle.dofs(), rate_unit * length_unit);
  unit_.head(n).setConstant(length_unit);
}

VsiModel VehicleFlow::model_at(double speed) const { return on_rigid_rails(model_, speed); }

Eigen::VectorXd VehicleFlow::packed(const LinearMotion& motion) const {
  Eigen::VectorXd x(unit_.size());
  x << motion.displacement(displacements_), motion.velocity;
  return x;
}

VsiState VehicleFlow::state_at(const VsiModel& model, const Eigen::VectorXd& x) const {
  VsiState state(model);
  LinearMotion& motion = state.vehicle[0];
  const auto n = static_cast<Eigen::Index>(displacements_.size());
  motion.displacement(displacements_) = x.head(n);
  motion.velocity = x.tail(motion.velocity.size());
  evaluate_contact_at(model, state);
  motion.acceleration = acceleration(model, motion);
  return state;
}

CycleSection VehicleFlow::lateral_section(int wheelset) const {
  const int row = model_.vehicle.dof[index(model_.vehicle.wheelsets[index(wheelset)])][y_motion];
  const auto place = std::lower_bound(displacements_.begin(), displacements_.end(), row) - displacements_.begin();
  return {place, static_cast<Eigen::Index>(displacements_.size()) + row};
}

bool VehicleFlow::run(const VsiModel& model, VsiState& state, const SteppedTime& time,
                      const std::function<void(const VsiState&)>& after_step) const {
  IntegrationParameters parameters;
  parameters.time_step = time.duration / time.steps;
  parameters.alpha = alpha_;
  parameters.contact_force = ContactForceRule::endpoint;
  parameters.tolerance = force_tolerance;
  OperatorLevels operators(model, alpha_, parameters.time_step);
  Integrator integrator(operators, parameters, {}, false);
  integrator.prepare(state);
  integrator.reinitialise(state);
  for (int step = 1; step <= time.steps; ++step) {
    if (!integrator.step(state)) return false;
    state.time = step * parameters.time_step;
    if (after_step) after_step(state);
  }
  return true;
}

std::optional<Eigen::VectorXd> VehicleFlow::end(const Eigen::VectorXd& start, const SteppedTime& time,
                                                double speed) const {
  const VsiModel model = model_at(speed);
  VsiState state = state_at(model, start);
  if (!run(model, state, time, {})) return {};
  return packed(state.vehicle[0]);
}

std::optional<FlowEnd> VehicleFlow::end_with_derivatives(const Eigen::VectorXd& start, const SteppedTime& time,
                                                         double speed) const {
  const VsiModel model = model_at(speed);
  VsiState state = state_at(model, start);
  LinearisedSteps steps(model, {.alpha = alpha_, .time_step = time.duration / time.steps}, displacements_,
                        state.vehicle[0]);
  if (!run(model, state, time, [&](const VsiState& now) { steps.advance(now.vehicle[0]); })) return {};
  FlowEnd result;
  result.state = packed(state.vehicle[0]);
  result.by_state = steps.by_start(displacements_);

  const double duration_change = relative_change * time.duration, speed_change = relative_change * speed;
  const auto later = end(start, {time.duration + duration_change, time.steps}, speed);
  const auto earlier = end(start, {time.duration - duration_change, time.steps}, speed);
  const auto faster = end(start, time, speed + speed_change);
  const auto slower = end(start, time, speed - speed_change);
  if (!later || !earlier || !faster || !slower) return {};
  result.by_time = (*later - *earlier) / (2.0 * duration_change);
  result.by_parameter = (*faster - *slower) / (2.0 * speed_change);
  return result;
}

std::vector<VehicleFlow::Extent> VehicleFlow::lateral_extents(const Eigen::VectorXd& start, const SteppedTime& time,
                                                              double speed) const {
  const VsiModel model = model_at(speed);
  VsiState state = state_at(model, start);
  std::vector<Extent> extents;
  const auto y = [&](std::size_t w) {
    return state.vehicle[0].displacement[model.vehicle.dof[index(model.vehicle.wheelsets[w])][y_motion]];
  };
  for (std::size_t w = 0; w < model.vehicle.wheelsets.size(); ++w) extents.push_back({y(w), y(w)});
  const bool complete = run(model, state, time, [&](const VsiState&) {
    for (std::size_t w = 0; w < extents.size(); ++w) {
      extents[w].low = std::min(extents[w].low, y(w));
      extents[w].high = std::max(extents[w].high, y(w));
    }
  });
  if (!complete) extents.clear();
  return extents;
}

}  // namespace railtab
