#include "railtab/runtime/vsi/step.hpp"

#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/external_load.hpp"

namespace railtab {

namespace {

bool is_endpoint(const StepContext& step) { return step.hht.contact_force == ContactForceRule::endpoint; }

// What the forces up to the beginning of the step, and the ground, add to the structure's right-hand side.
KnownLoad known_load(const StepContext& step, const LinearMotion& motion, StepWorkspace& ws) {
  if (is_endpoint(step) && !step.model.ground_motion) {
    return {motion.contact_load, ws.past_rail_dofs, -step.hht.alpha};
  }
  const DofRange& active = step.operators.structure->active();
  past_contact_load(step.hht, motion, active, ws.structure_past);
  add_ground_load(step.model, step.hht, step.begin, active, ws.structure_past);
  return {ws.structure_past};
}

// close_load() of the structure. Under ContactForceRule::endpoint all loads but those under the wheels and of the
// past_rail_dofs are zero.
void close_structure_load(const StepContext& step, const StepWorkspace& ws, LinearMotion& motion) {
  const DofRange& active = step.operators.structure->active();
  if (is_endpoint(step)) {
    for (const std::vector<int>* dofs : {&ws.past_rail_dofs, &ws.rail_dofs}) {
      close_load(step.hht, *dofs, ws.structure_load, motion.contact_load, motion.step_load);
    }
    for (int dof : ws.past_rail_dofs) motion.contact_load[dof] = 0.0;
    std::vector<int>& loaded = motion.loaded ? *motion.loaded : motion.loaded.emplace();
    loaded = ws.rail_dofs;
    // and those that wheels have left, where step_load is still to be cleared
    for (int dof : ws.past_rail_dofs) {
      if (motion.step_load[dof] != 0.0 && ws.structure_load[dof] == 0.0) loaded.push_back(dof);
    }
  } else {
    motion.loaded.reset();
    close_load(step.hht, active.of(ws.structure_load), active.of(motion.contact_load), active.of(motion.step_load));
    active.of(motion.contact_load).setZero();
  }
  add_rail_forces(step.contacts, ws.solution.end_force, motion.contact_load);
}

// Predictors of the structure, its right-hand side, and the increment without contact forces at the end of the step,
// under the wheels only: the forward half of its back-substitution.
void predict_structure(const StepContext& step, const VsiState& state, StepWorkspace& ws) {
  const StructureResponse& structure = *step.operators.structure;
  const DofRange& active = structure.active();
  for (int dof : ws.rail_dofs) ws.structure_load[dof] = 0.0;
  ws.rail_dofs.clear();
  ws.rail_dofs_ahead.clear();
  for (const RailContact& contact : step.contacts) {
    append_dofs(contact, ws.rail_dofs);
    append_dofs_ahead(contact, ws.rail_dofs_ahead);
  }
  std::erase_if(ws.rail_dofs_ahead, [&](int dof) { return dof < active.begin || dof >= active.end(); });
  const NewmarkPredictor predictor(step.hht);
  const LinearMotion& motion = state.structure.at(ws.rail_dofs);
  for (int dof : ws.rail_dofs) {
    const double velocity = motion.velocity[dof], acceleration = motion.acceleration[dof];
    ws.structure_predicted[dof] = predictor.displacement(motion.displacement[dof], velocity, acceleration);
    ws.structure_predicted_velocity[dof] = predictor.velocity(velocity, acceleration);
    ws.structure_velocity[dof] = velocity;
  }
  if (is_endpoint(step)) find_loaded(motion, active, ws.past_rail_dofs);
  structure.begin_step(state.structure, known_load(step, motion, ws), {ws.rail_dofs, ws.rail_dofs_ahead}, ws.structure);
  ws.structure.substitution.respond(structure.factor(), ws.structure_free);
}

// Eqs. 12 and 13: predictors and right-hand sides.
void predict(const StepContext& step, const VsiState& state, ContactLaw& contacts, StepWorkspace& ws,
             StepReport& report) {
  {
    const Stopwatch watch = report.times.measure(Phase::vehicle);
    contacts.predict_vehicles(step, state, ws);
  }
  if (!step.model.structure) return;
  const Stopwatch watch = report.times.measure(Phase::structure);
  predict_structure(step, state, ws);
  ++report.back_substitutions;
}

// The structure's response to the contact forces, under the wheels.
void respond(const StepContext& step, StepWorkspace& ws) {
  for (int dof : ws.rail_dofs) ws.structure_load[dof] = 0.0;
  add_rail_forces(step.contacts, ws.solution.force, ws.structure_load);
  ws.structure.substitution.respond(step.operators.structure->factor(), step.hht.load_weight(), ws.structure_load,
                                    ws.structure_free);
}

// Eq. 16 condensed to the contacts, and the structure's response to their forces, until the two agree.
bool solve_condensed(const StepContext& step, ContactLaw& contacts, StepWorkspace& ws, StepReport& report) {
  for (int pass = 0; pass < step.limits.max_passes; ++pass) {
    const ContactSolve solved = contacts.solve(step, pass, ws, report);
    if (solved == ContactSolve::diverged) return false;
    // Forces that have not changed have their response already.
    if (!step.model.structure || solved == ContactSolve::unchanged) return true;
    const Stopwatch watch = report.times.measure(Phase::structure);
    respond(step, ws);
    if (contacts.correct_far_field(step, ws) < step.limits.far_field_tolerance) return true;
  }
  return false;
}

// Whether the step stands.
StepOutcome outcome(const StepLimits& limits, bool converged, ContactChange change, double force_change) {
  if (!converged) return StepOutcome::diverged;
  if (limits.rejected == RejectedEvents::none) return StepOutcome::accepted;
  if (change == ContactChange::gained) return StepOutcome::contact_state_changed;
  if (limits.rejected == RejectedEvents::contact_change_and_force_jump && force_change > limits.force_jump) {
    return StepOutcome::force_jumped;
  }
  return change == ContactChange::lost ? StepOutcome::contact_state_changed : StepOutcome::accepted;
}

// Motion and contact forces at t + Δt.
void close(const StepContext& step, VsiState& state, ContactLaw& contacts, StepWorkspace& ws, StepReport& report) {
  if (step.model.structure) {
    const Stopwatch watch = report.times.measure(Phase::structure);
    const StructureResponse& structure = *step.operators.structure;
    structure.finish_step(ws.structure, state.structure);
    close_structure_load(step, ws, state.structure.loads());
  }
  const Stopwatch watch = report.times.measure(Phase::vehicle);
  contacts.close(step, state, ws);
  state.far_field = ws.far_field;
  state.time = step.end;
}

}  // namespace

StepWorkspace::StepWorkspace(const VsiModel& model)
    : vehicle_load(Eigen::VectorXd::Zero(model.vehicle.dofs())),
      structure_load(Eigen::VectorXd::Zero(model.structure ? model.structure->dofs() : 0)),
      structure_predicted(structure_load),
      structure_predicted_velocity(structure_load),
      structure_velocity(structure_load),
      structure_free(structure_load),
      solution(VsiState(model).contact) {}

//   Eq. 12, 13   predictors ã, ṽ and right-hand sides ψ of K̄ Δa + D̄ X = ψ     predict
//   Eq. 14, 15   contacts at t + Δt: forces X(a, v), distributed by D          present
//   Eq. 16       [ K̄   D̄ ] [ Δa ]   [ ψ ]                                       solve_condensed
//                [ H̄   0 ] [ ΔX ] = [ r̄ ]
//   a, v, a'' and X at t + Δt                                                  close
StepReport advance(const VsiModel& model, const StepOperators& op, const StepLimits& limits, VsiState& state,
                   ContactLaw& contacts, StepWorkspace& ws) {
  HhtScheme hht = op.scheme;
  hht.contact_force = limits.contact_force;
  const double end = state.time + hht.time_step;
  place_wheels(model, end, ws.contacts);
  const StepContext step{model, op, limits, hht, state.time, end, ws.contacts};
  StepReport report;
  ws.far_field = state.far_field;

  predict(step, state, contacts, ws, report);
  contacts.present(step, state, ws);
  const bool converged = solve_condensed(step, contacts, ws, report);
  if (converged) report.contact_change = contact_change(state.contact, ws.solution, limits.light_touch);
  report.outcome = outcome(limits, converged, report.contact_change, largest_force_change(state.contact, ws.solution));
  if (report.outcome == StepOutcome::accepted) close(step, state, contacts, ws, report);
  return report;
}

void evaluate_contact_at(const VsiModel& model, VsiState& state) {
  if (model.normal_contact == NormalContact::rigid) return;
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  const ContactProblem problem = present_contact(model, state);
  TrainContact contact = model.train_contact();
  contact.set_speed(model.speed(state.time));
  ContactSolution now = state.contact;
  now.displacement = problem.predicted;
  evaluate_contact(contact, problem, now);
  for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
    Eigen::VectorXd& load = state.vehicle[static_cast<std::size_t>(v)].contact_load;
    scatter_wheelset_forces(model, v, now.end_force, load);
    add_element_forces(model, state, v, load);
  }
  if (model.structure) set_rail_forces(contacts, now.end_force, state.structure.loads());
  state.contact.end_force = std::move(now.end_force);
  state.contact.rail_x = std::move(now.rail_x);
  state.contact.memory = std::move(now.memory);
  state.contact.normal = std::move(now.normal);
  state.contact.creep_power = std::move(now.creep_power);
  state.contact.pressure = std::move(now.pressure);
  state.contact.contact = std::move(now.contact);
}

std::unique_ptr<ContactLaw> make_contact_law(const VsiModel& model) {
  return model.normal_contact == NormalContact::rigid ? make_rigid_wheels(model) : make_hertz_contact(model);
}

}  // namespace railtab
