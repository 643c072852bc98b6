#include "railtab/runtime/vsi/vsi_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

const DofIndices& wheelset_dofs(const VsiModel& model, int wheelset_of_vehicle) {
  return model.vehicle.dof[index(model.vehicle.wheelsets[index(wheelset_of_vehicle)])];
}

}  // namespace

double VsiModel::wheelset_x(int wheelset, double time) const noexcept {
  const int per_vehicle = wheelsets_per_vehicle();
  const int body = vehicle.wheelsets[index(wheelset % per_vehicle)];
  return vehicle_x[index(wheelset / per_vehicle)] + vehicle.bodies[index(body)].position[0] + distance(time);
}

TrainContact VsiModel::train_contact() const {
  TrainContact train(contact);
  if (wheelset_geometry.empty()) return train;
  train.model.assign(wheelset_geometry.size(), contact);
  for (std::size_t w = 0; w < wheelset_geometry.size(); ++w) train.model[w].geometry = wheelset_geometry[w].get();
  return train;
}

WheelRise VsiModel::wheel_rise(int wheel, double time) const noexcept {
  if (wheel_deviation.empty()) return {};
  const double R = wheel_radius(wheel / 2);
  const WheelRise rise = wheel_deviation[index(wheel)].at(distance(time) / R);
  return {rise.rise, rise.slope / R, rise.curvature / (R * R)};
}

RailDeviation VsiModel::rail_line(RailSide side, double x) const noexcept {
  RailDeviation d = irregularity.at(side, x);
  if (!span_deviation) return d;
  const RailDeviation turned = span_deviation->at(x);
  d.y += turned.y;
  d.z += turned.z;
  d.dy_dx += turned.dy_dx;
  d.dz_dx += turned.dz_dx;
  d.ddy_dx2 += turned.ddy_dx2;
  d.ddz_dx2 += turned.ddz_dx2;
  return d;
}

VsiState::VsiState(const VsiModel& model)
    : vehicle(model.vehicle_x.size(), LinearMotion(model.vehicle.dofs())),
      structure(model.structure ? model.structure->dofs() : 0) {
  friction.assign(vehicle.size(),
                  Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.vehicle.elements.element.size())));
  const int wheelsets = model.wheelsets();
  contact.displacement = Eigen::VectorXd::Zero(wheelset_unknowns * wheelsets);
  contact.force = Eigen::VectorXd::Zero(wheelset_unknowns * wheelsets);
  contact.end_force = contact.step_load = contact.force;
  contact.memory.resize(index(2 * wheelsets));
  contact.rail_x.assign(index(2 * wheelsets), 0.0);
  contact.contact.resize(index(2 * wheelsets));
  contact.normal.resize(index(2 * wheelsets));
  contact.creep_power.assign(index(2 * wheelsets), 0.0);
  contact.pressure.assign(index(2 * wheelsets), 0.0);
  far_field = Eigen::VectorXd::Zero(6 * wheelsets);
  deflection = {far_field, far_field, far_field};
  if (model.window) left_behind = Eigen::VectorXd::Zero(model.window->numbers());
}

namespace {

// Visits every number of a state in the order of a checkpoint.
template <typename State, typename Visitor>
void visit_numbers(State& state, Visitor&& visit) {
  visit(&state.time, 1);
  const auto visit_vector = [&](auto& v) { visit(v.data(), static_cast<std::size_t>(v.size())); };
  const auto visit_motion = [&](auto& motion) {
    visit_vector(motion.displacement);
    visit_vector(motion.velocity);
    visit_vector(motion.acceleration);
    visit_vector(motion.contact_load);
    visit_vector(motion.step_load);
  };
  for (auto& motion : state.vehicle) visit_motion(motion);
  visit_motion(state.structure.whole());
  visit_vector(state.left_behind);
  visit_vector(state.contact.displacement);
  visit_vector(state.contact.force);
  visit_vector(state.contact.step_load);
  visit_vector(state.contact.rail_x);
  visit_vector(state.far_field);
  for (auto* numbers : {&state.deflection.force, &state.deflection.rate, &state.deflection.slope_force}) {
    visit_vector(*numbers);
  }
  for (auto* extreme : {&state.wheel_extremes.largest_Q, &state.wheel_extremes.smallest_Q,
                        &state.wheel_extremes.derailment, &state.wheel_extremes.unloading}) {
    visit(&extreme->value, 1);
    visit(&extreme->time, 1);
    visit(&extreme->wheel, 1);
  }
  if (!state.friction.empty() && state.friction.front().size() > 0) {
    for (auto& force : state.friction) visit_vector(force);
    for (auto* event : {&state.stops.first, &state.stops.largest}) {
      visit(&event->time, 1);
      visit(&event->force, 1);
      visit(&event->element, 1);
    }
  }
  visit(&state.landing_until, 1);
  visit(&state.impact_until, 1);
  visit(&state.energy_until, 1);
}

}  // namespace

std::vector<double> packed(const VsiState& state) {
  std::vector<double> numbers;
  visit_numbers(state, [&](const auto* data, std::size_t n) { numbers.insert(numbers.end(), data, data + n); });
  return numbers;
}

void unpack(std::span<const double> numbers, VsiState& state) {
  std::size_t expected = 0;
  visit_numbers(state, [&](const auto*, std::size_t n) { expected += n; });
  if (numbers.size() != expected) {
    throw input_error("checkpoint", fmt::format("{} numbers", numbers.size()),
                      fmt::format("{}, the state of this scene", expected));
  }
  visit_numbers(state, [&](auto* data, std::size_t n) {
    std::copy_n(numbers.begin(), n, data);
    numbers = numbers.subspan(n);
  });
  state.structure.loads().loaded.reset();
  state.contact.end_force = state.contact.force;  // but under ContactForceRule::energy: evaluate_contact_at()
}

void place_wheels(const VsiModel& model, double time, std::vector<RailContact>& contacts) {
  contacts.clear();
  if (!model.structure) return;
  contacts.reserve(index(2 * model.wheelsets()));
  for (int w = 0; w < model.wheelsets(); ++w) {
    append_rail_heads(*model.structure, model.wheelset_x(w, time), contacts);
  }
}

std::vector<RailContact> place_wheels(const VsiModel& model, double time) {
  std::vector<RailContact> contacts;
  place_wheels(model, time, contacts);
  return contacts;
}

namespace {

// A rail that is rigid moves with the ground.
void add_ground(const VsiModel& model, double x, double time, RailHeadMotion& head) {
  if (!model.ground_motion) return;
  const GroundPoint ground = model.ground_motion->at(x, time);
  head.displacement.head<2>() += ground.displacement;
  head.velocity.head<2>() += ground.velocity;
  head.yaw += ground.slope[0];
  head.slope += ground.slope[1];
}

// A rail whose structure moves relative to its supports is carried along by them.
void add_carried(const RailContact& contact, const StructureSupports& supports, const SupportMotion& motion,
                 RailHeadMotion& head) {
  const CarriedHead carried = carried_head(contact, supports, motion.displacement);
  head.displacement += carried.head<3>();
  head.velocity += carried_head(contact, supports, motion.velocity).head<3>();
  head.yaw += carried[3];
  head.slope -= carried[4];
}

}  // namespace

void rail_deviation(const VsiModel& model, const std::vector<RailContact>& contacts, double time,
                    const Eigen::VectorXd& structure_displacement,
                    std::vector<std::array<RailHeadMotion, 2>>& deviation) {
  deviation.resize(index(model.wheelsets()));
  const bool relative = model.ground_motion && model.structure && model.structure->supports.carried.size() > 0;
  SupportMotion motion;
  if (relative) motion = support_motion(*model.ground_motion, model.structure->supports.x, time);
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (int side = 0; side < 2; ++side) {
      const double x = model.wheelset_x(w, time);
      RailDeviation d = model.rail_line(static_cast<RailSide>(side), x);
      if (model.deviation_history) {
        const VerticalDeviation given = model.deviation_history->at(w, time);
        d = {.z = given.z, .dz_dx = given.rate / model.speed(time)};
      }
      RailHeadMotion& head = deviation[index(w)][index(side)];
      // A wheel that is not round meets a round one's rail raised by its deviation.
      const WheelRise rise = model.wheel_rise(2 * w + side, time);
      d.z -= rise.rise;
      d.dz_dx -= rise.slope;
      head = RailHeadMotion{{d.y, d.z, 0.0}, Vector3::Zero(), d.dy_dx, d.dz_dx};
      if (model.rail_friction) {
        head.friction = model.rail_friction->at(static_cast<RailSide>(side), x) / model.contact.friction;
      }
      if (contacts.empty() || !contacts[index(2 * w + side)].on_rail) {
        add_ground(model, x, time, head);
        continue;
      }
      const RailContact& contact = contacts[index(2 * w + side)];
      const Eigen::Vector2d slopes = rail_slopes(contact, structure_displacement);
      head.yaw += slopes[0];
      head.slope -= slopes[1];
      if (relative) add_carried(contact, model.structure->supports, motion, head);
    }
  }
}

VerticalDeviation DeviationHistory::at(int wheelset_of_train, double time) const noexcept {
  const std::vector<VerticalDeviation>& history = wheelset[index(wheelset_of_train)];
  const double step = std::round(time / time_step);
  if (history.empty() || step < 0.0) return {};
  return history[std::min(static_cast<std::size_t>(step), history.size() - 1)];
}

VerticalDeviation vertical_deviation(const VsiModel& model, int wheelset, double time) noexcept {
  if (model.deviation_history) return model.deviation_history->at(wheelset, time);
  const double V = model.speed(time);
  const double x = model.wheelset_x(wheelset, time);
  VerticalDeviation mean;
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    RailDeviation d = model.rail_line(side, x);
    const WheelRise rise = model.wheel_rise(2 * wheelset + static_cast<int>(side), time);
    d.z -= rise.rise;
    d.dz_dx -= rise.slope;
    d.ddz_dx2 -= rise.curvature;
    mean.z += 0.5 * d.z;
    mean.rate += 0.5 * V * d.dz_dx;
    mean.acceleration += 0.5 * (V * V * d.ddz_dx2 + model.acceleration(time) * d.dz_dx);
  }
  return mean;
}

VerticalDeviation ground_under(const VsiModel& model, int wheelset, double time) noexcept {
  if (!model.ground_motion) return {};
  const GroundPoint g = model.ground_motion->at(model.wheelset_x(wheelset, time), time);
  const double V = model.speed(time);
  return {
      g.displacement[1], g.velocity[1] + V * g.slope[1],
      g.acceleration[1] + 2.0 * V * g.slope_rate[1] + V * V * g.curvature[1] + model.acceleration(time) * g.slope[1]};
}

void gather_wheelsets(const VsiModel& model, int vehicle, const Eigen::VectorXd& dofs, Eigen::VectorXd& q) noexcept {
  const int per_vehicle = model.wheelsets_per_vehicle();
  for (int w = 0; w < per_vehicle; ++w) {
    const DofIndices& dof = wheelset_dofs(model, w);
    for (int k = 0; k < 6; ++k) {
      q[wheelset_unknowns * (vehicle * per_vehicle + w) + k] = dof[index(k)] == held ? 0.0 : dofs[dof[index(k)]];
    }
  }
}

void scatter_wheelset_forces(const VsiModel& model, int vehicle, const Eigen::VectorXd& force,
                             Eigen::VectorXd& load) noexcept {
  load.setZero();
  const int per_vehicle = model.wheelsets_per_vehicle();
  for (int w = 0; w < per_vehicle; ++w) {
    const DofIndices& dof = wheelset_dofs(model, w);
    for (int k = 0; k < 6; ++k) {
      if (dof[index(k)] != held) load[dof[index(k)]] += force[wheelset_unknowns * (vehicle * per_vehicle + w) + k];
    }
  }
}

void gather_rails(const std::vector<RailContact>& contacts, const Eigen::VectorXd& dofs, Eigen::VectorXd& q) noexcept {
  for (int wheel = 0; wheel < static_cast<int>(contacts.size()); ++wheel) {
    q.segment<3>(rail_unknown(wheel)) = rail_head(contacts[index(wheel)], dofs);
  }
}

void set_rail_forces(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force,
                     LinearMotion& structure) noexcept {
  structure.contact_load.setZero();
  structure.loaded.reset();
  add_rail_forces(contacts, force, structure.contact_load);
}

void add_rail_forces(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force,
                     Eigen::VectorXd& load) noexcept {
  for (int wheel = 0; wheel < static_cast<int>(contacts.size()); ++wheel) {
    add_rail_load(contacts[index(wheel)], force.segment<3>(rail_unknown(wheel)), load);
  }
}

void add_element_forces(const VsiModel& model, const VsiState& state, int vehicle, Eigen::VectorXd& load) {
  const ForceElements& elements = model.vehicle.elements;
  if (elements.empty()) return;
  const LinearMotion& motion = state.vehicle[index(vehicle)];
  const Eigen::VectorXd force = elements.force(elements.rows * motion.displacement, elements.rows * motion.velocity,
                                               state.friction[index(vehicle)]);
  load.noalias() -= elements.rows.transpose() * force;
}

ContactProblem present_contact(const VsiModel& model, const VsiState& state) {
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  ContactProblem problem;
  problem.wheelsets_per_vehicle = model.wheelsets_per_vehicle();
  problem.wheelsets_per_group = problem.wheelsets_per_vehicle;
  problem.predicted = problem.predicted_velocity = Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets());
  for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
    gather_wheelsets(model, v, state.vehicle[index(v)].displacement, problem.predicted);
    gather_wheelsets(model, v, state.vehicle[index(v)].velocity, problem.predicted_velocity);
  }
  const LinearMotion& structure = state.structure.whole();
  gather_rails(contacts, structure.displacement, problem.predicted);
  gather_rails(contacts, structure.velocity, problem.predicted_velocity);
  rail_deviation(model, contacts, state.time, structure.displacement, problem.deviation);
  if (model.normal_contact != NormalContact::hertz) return problem;
  std::vector<RailHeadMotion> between;
  const ElementDeflection& d = state.deflection;
  element_motion(contacts, d.force, d.rate, d.slope_force, model.speed(state.time), between);
  for (int wheel = 0; wheel < static_cast<int>(between.size()); ++wheel) {
    const RailHeadMotion& m = between[index(wheel)];
    problem.predicted.segment<3>(rail_unknown(wheel)) += m.displacement;
    problem.predicted_velocity.segment<3>(rail_unknown(wheel)) += m.velocity;
    add_slopes(m, problem.deviation[index(wheel / 2)][index(wheel % 2)]);
  }
  return problem;
}

}  // namespace railtab
