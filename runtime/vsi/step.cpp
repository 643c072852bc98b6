#include "railtab/runtime/vsi/step.hpp"

#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/vsi/contact_continuation.hpp"
#include "railtab/runtime/vsi/contact_touch.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/structure_step.hpp"

namespace railtab {

namespace {

// Rail coupling beyond this distance is left to the far-field correction: rail bending waves within one step have died
// out.
constexpr double compliance_window = 5.0;  // m

std::size_t index(int i) { return static_cast<std::size_t>(i); }
int vehicles(const VsiModel& model) { return static_cast<int>(model.vehicle_x.size()); }

// Vehicles: predictors and the increments that they would make without contact forces at the end of the step.
void free_vehicles(const VsiModel& model, const StepOperators& op, const VsiState& state, StepWorkspace& ws) {
  for (int v = 0; v < vehicles(model); ++v) {
    Prediction& p = ws.vehicle_prediction[index(v)];
    const LinearMotion& motion = state.vehicle[index(v)];
    predict(op.scheme, motion, p);
    vehicle_step_load(model, op.scheme, v, state.time, motion, ws.vehicle_load);
    op.vehicle.free_increment(model.vehicle, op.vehicle_damping, op.scheme, ws.vehicle_load, motion, p,
                              ws.vehicle_free[index(v)]);
    // gather into q: predictor, its velocity, the free motion, and the start (constant acceleration)
    const Eigen::VectorXd free = p.displacement + ws.vehicle_free[index(v)];
    const Eigen::VectorXd start = p.displacement + motion.acceleration / op.scheme.acceleration_rate();
    gather_wheelsets(model, v, p.displacement, ws.problem.predicted);
    gather_wheelsets(model, v, p.velocity, ws.problem.predicted_velocity);
    gather_wheelsets(model, v, free, ws.problem.free);
    gather_wheelsets(model, v, start, ws.solution.displacement);
  }
}

// The structure likewise, under the wheels only: the forward half of its back-substitution.
void free_structure(const VsiModel& model, const StepOperators& op, const VsiState& state,
                    const std::vector<RailContact>& contacts, StepWorkspace& ws) {
  begin_structure(model, op, state, contacts, ws);
  const Prediction& p = ws.structure_prediction;
  gather_rails(contacts, p.displacement, ws.problem.predicted);
  gather_rails(contacts, p.velocity, ws.problem.predicted_velocity);
  gather_rails(contacts, ws.structure_free, ws.problem.free);
  gather_rails(contacts, state.structure.acceleration, ws.solution.displacement);
  for (int wheel = 0; wheel < static_cast<int>(contacts.size()); ++wheel) {
    const int k = rail_unknown(wheel);
    const Vector3 predicted = ws.problem.predicted.segment<3>(k);
    ws.problem.free.segment<3>(k) += predicted + state.far_field.segment<3>(3 * wheel);
    ws.solution.displacement.segment<3>(k) =
        predicted + ws.solution.displacement.segment<3>(k) / op.scheme.acceleration_rate();
  }
}

void rail_couplings(const StepOperators& op, const std::vector<RailContact>& contacts, StepWorkspace& ws) {
  std::vector<RailCoupling>& rail = ws.problem.rail;
  rail.clear();
  const int wheels = static_cast<int>(contacts.size());
  for (int j = 0; j < wheels; ++j) {
    if (!contacts[index(j)].on_rail) continue;
    // Wheels are ordered along the train, so those within reach are neighbours in the list; the compliance is
    // symmetric.
    for (int i = j; i < wheels; ++i) {
      const Eigen::Matrix3d c =
          op.scheme.load_weight() * op.structure->compliance(contacts[index(i)], contacts[index(j)]);
      if (c.isZero(0.0)) break;
      rail.push_back({i, j, c});
      if (i != j) rail.push_back({j, i, c.transpose()});
    }
  }
}

// The structure's own answer to the contact forces, under the wheels; returns what the contact solution had missed.
double answer_under_wheels(const StepOperators& op, const std::vector<RailContact>& contacts, StepWorkspace& ws) {
  for (int dof : ws.rail_dofs) ws.structure_load[dof] = 0.0;
  add_rail_forces(contacts, ws.solution.force, ws.structure_load);
  ws.structure_solution.respond(op.structure->factor(), op.scheme.load_weight(), ws.structure_load, ws.structure_free);
  double missed = 0.0;
  for (int wheel = 0; wheel < static_cast<int>(contacts.size()); ++wheel) {
    const int k = rail_unknown(wheel);
    // What the contact solution has the rail do under its forces: where Newton ended, and what it left.
    const Vector3 expected = ws.solution.displacement.segment<3>(k) + ws.newton.residual.segment<3>(k);
    const Vector3 miss =
        ws.problem.predicted.segment<3>(k) + rail_head(contacts[index(wheel)], ws.structure_free) - expected;
    missed = std::max(missed, miss.cwiseAbs().maxCoeff());
    ws.problem.free.segment<3>(k) += miss;
    ws.far_field.segment<3>(3 * wheel) += miss;
  }
  return missed;
}

void set_force_rule(const HhtScheme& hht, const ContactSolution& start, ContactProblem& problem) {
  const bool energy = hht.contact_force == ContactForceRule::energy;
  problem.start = energy ? &start : nullptr;
  problem.mean_weight = energy ? 1.0 / (hht.gamma() * hht.load_weight()) : 1.0;
}

// Eq. 16, condensed to the contacts; the structure's answer closes it.
void solve_coupling(const VsiModel& model, const StepOperators& op, const StepLimits& limits, const VsiState& state,
                    const std::vector<RailContact>& contacts, StepWorkspace& ws, StepReport& report) {
  for (int pass = 0; pass < limits.max_passes && !report.converged; ++pass) {
    NewtonReport newton;
    double seconds_newton = 0.0;
    {
      const Stopwatch watch(seconds_newton);
      ws.newton.forces_known = pass > 0;  // the structure's answer has moved nothing but q_free
      newton = solve_contact_by_continuation(ws.contact, ws.problem, limits.newton, ws.solution, ws.newton);
    }
    report.newton_iterations += newton.iterations;
    report.counts += newton.counts;
    report.seconds_contact += seconds_newton - newton.counts.seconds_lookup;
    if (!newton.converged) return;
    if (!model.structure) {
      report.converged = true;
      return;
    }
    // Forces that have not changed are answered already.
    if (pass > 0 && newton.iterations == 0) {
      report.converged = true;
      return;
    }
    const Stopwatch watch(report.seconds_structure);
    report.converged = answer_under_wheels(op, contacts, ws) < limits.far_field_tolerance;
  }
}

// What the contacts loaded a subsystem with in the step, from `load` of the solution's forces and from what went
// before; for the next step.
void close_load(const HhtScheme& hht, const Eigen::VectorXd& load, const DofRange& active, LinearMotion& motion) {
  const double g = hht.gamma();
  auto p = active.of(motion.step_load);
  const auto f = active.of(motion.contact_load);  // at the beginning of the step
  if (hht.contact_force == ContactForceRule::endpoint) {
    p = hht.load_weight() * active.of(load) - hht.alpha * f;
  } else {
    p = hht.load_weight() * active.of(load) + (0.5 * f - (1.0 - g) * p) / g;
  }
}

// The same in the contact unknowns.
void close_contact(const HhtScheme& hht, const ContactSolution& start, ContactSolution& end) {
  end.step_load = hht.load_weight() * end.force;
  if (hht.contact_force == ContactForceRule::endpoint) {
    end.step_load -= hht.alpha * start.end_force;
  } else {
    end.step_load += (0.5 * start.end_force - (1.0 - hht.gamma()) * start.step_load) / hht.gamma();
  }
}

// Of the rails' vertical forces on wheels in a step [N].
double largest_change(const ContactSolution& before, const ContactSolution& after) {
  double largest = 0.0;
  for (int wheel = 0; wheel < static_cast<int>(after.patches.size()); ++wheel) {
    const int vertical = rail_unknown(wheel) + 1;
    largest = std::max(largest, std::abs(after.end_force[vertical] - before.end_force[vertical]));
  }
  return largest;
}

// Motion and contact forces at t + dt.
void close_step(const VsiModel& model, const StepOperators& op, const std::vector<RailContact>& contacts,
                VsiState& state, StepWorkspace& ws, StepReport& report) {
  const HhtScheme& hht = op.scheme;
  for (int v = 0; v < vehicles(model); ++v) {
    const Stopwatch watch(report.seconds_vehicle);
    LinearMotion& motion = state.vehicle[index(v)];
    scatter_wheelset_forces(model, v, ws.solution.force, ws.vehicle_load);
    ws.vehicle_increment[index(v)] =
        ws.vehicle_free[index(v)] + hht.load_weight() * (op.vehicle.inverse() * ws.vehicle_load);
    close_load(hht, ws.vehicle_load, {0, ws.vehicle_load.size()}, motion);
    scatter_wheelset_forces(model, v, ws.solution.end_force, motion.contact_load);
    update(hht, ws.vehicle_prediction[index(v)], ws.vehicle_increment[index(v)], motion);
  }
  if (model.structure) {
    const Stopwatch watch(report.seconds_structure);
    const DofRange& active = op.structure->active();
    LinearMotion& motion = state.structure;
    ws.structure_solution.finish(op.structure->factor(), ws.structure_increment);
    close_load(hht, ws.structure_load, active, motion);
    active.of(motion.contact_load).setZero();
    add_rail_forces(contacts, ws.solution.end_force, motion.contact_load);
    update(hht, ws.structure_prediction, ws.structure_increment, active, motion);
  }
  close_contact(hht, state.contact, ws.solution);
  std::swap(state.contact, ws.solution);
  state.far_field = ws.far_field;
  state.time += hht.time_step;
}

}  // namespace

StepOperators::StepOperators(const VsiModel& model, const HhtScheme& hht)
    : scheme(hht),
      vehicle_damping(model.vehicle_damping(model.contact.speed)),
      vehicle(model.vehicle, vehicle_damping, hht),
      speed_(model.contact.speed) {
  if (model.normal_contact == NormalContact::rigid) {
    rigid_wheels.emplace(model.vehicle, vehicle_damping, hht);
  }
  if (!model.structure) return;
  structure = std::make_unique<StructureResponse>(*model.structure, hht);
}

void StepOperators::follow(const VsiModel& model, double time, const DofRange& active) {
  if (model.speed(time) != speed_) {
    speed_ = model.speed(time);
    vehicle_damping = model.vehicle_damping(speed_);
    vehicle = VehicleResponse(model.vehicle, vehicle_damping, scheme);
    if (rigid_wheels) rigid_wheels.emplace(model.vehicle, vehicle_damping, scheme);
  }
  constexpr double ahead = 10.0;  // m
  const double front = model.wheelset_x(0, time);
  const double rear = model.wheelset_x(model.wheelsets() - 1, time);
  if (structure) structure->activate(active);
  if (!structure || (rear >= covered_from_ && front <= covered_to_)) return;
  // A step that is repeated as halves looks back by at most one step.
  covered_from_ = model.wheelset_x(model.wheelsets() - 1, time - scheme.time_step);
  covered_to_ = front + ahead;
  structure->tabulate_compliance(*model.structure, compliance_window, covered_from_, covered_to_);
}

StepWorkspace::StepWorkspace(const VsiModel& model) {
  const std::size_t n = model.vehicle_x.size();
  vehicle_prediction.resize(n);
  vehicle_free.assign(n, Eigen::VectorXd::Zero(model.vehicle.dofs()));
  vehicle_increment = vehicle_free;
  vehicle_load = Eigen::VectorXd::Zero(model.vehicle.dofs());
  structure_load = Eigen::VectorXd::Zero(model.structure ? model.structure->dofs() : 0);
  const VsiState zero(model);
  solution = zero.contact;
  contact = model.contact;
  problem.wheelsets_per_vehicle = model.wheelsets_per_vehicle();
  problem.wheelsets_per_group = 1;
  problem.free = problem.predicted = problem.predicted_velocity = solution.displacement;
}

StepReport advance(const VsiModel& model, const StepOperators& op, const StepLimits& limits, VsiState& state,
                   StepWorkspace& ws) {
  if (op.rigid_wheels) return advance_rigid_wheels(model, op, limits, state, ws);
  StepReport report;
  const HhtScheme& hht = op.scheme;
  const double time = state.time + hht.time_step;
  ws.far_field = state.far_field;
  ws.contact.speed = model.speed(time);
  ws.contact.without_table = limits.without_table;

  // Right-hand side of Eq. 13 without the contact forces at t + dt.
  std::vector<RailContact> contacts;
  {
    const Stopwatch watch(report.seconds_vehicle);
    contacts = place_wheels(model, time);
    free_vehicles(model, op, state, ws);
  }
  if (model.structure) {
    const Stopwatch watch(report.seconds_structure);
    free_structure(model, op, state, contacts, ws);
    ++report.back_substitutions;
    rail_couplings(op, contacts, ws);
  }
  rail_deviation(model, contacts, time, ws.structure_prediction.displacement, ws.problem.deviation);
  ws.problem.velocity_rate = Vector6::Constant(hht.velocity_rate());
  ws.problem.rail_velocity_rate = hht.velocity_rate();
  ws.problem.vehicle_compliance = hht.load_weight() * op.vehicle.compliance();

  set_force_rule(hht, state.contact, ws.problem);
  solve_coupling(model, op, limits, state, contacts, ws, report);
  if (report.converged) report.touch_change = touch_change(state.contact, ws.solution);
  report.hits =
      limits.smooth_only && report.converged && largest_change(state.contact, ws.solution) > limits.largest_change;
  if (limits.smooth_only && (report.hits || report.touch_change != TouchChange::none)) report.converged = false;
  if (report.converged) close_step(model, op, contacts, state, ws, report);
  return report;
}

void remember_contact(const VsiModel& model, VsiState& state) {
  if (model.normal_contact == NormalContact::rigid) return;
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  const ContactProblem problem = present_contact(model, state);
  WheelContactModel contact = model.contact;
  contact.speed = model.speed(state.time);
  ContactSolution now = state.contact;
  now.displacement = problem.predicted;
  static_cast<void>(evaluate_contact(contact, problem, now));
  for (int v = 0; v < vehicles(model); ++v) {
    scatter_wheelset_forces(model, v, now.end_force, state.vehicle[index(v)].contact_load);
  }
  if (model.structure) scatter_rail_forces(contacts, now.end_force, state.structure.contact_load);
  state.contact.end_force = std::move(now.end_force);
  state.contact.memory = std::move(now.memory);
  state.contact.normal = std::move(now.normal);
  state.contact.patches = std::move(now.patches);
}

}  // namespace railtab
