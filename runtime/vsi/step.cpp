#include "railtab/runtime/vsi/step.hpp"

#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/external_load.hpp"

namespace railtab {

namespace {

// Predictors of the structure, its right-hand side, and the increment without contact forces at the end of the step,
// under the wheels only: the forward half of its back-substitution.
void predict_structure(const StepContext& step, const VsiState& state, StepWorkspace& ws) {
  const StructureResponse& structure = *step.operators.structure;
  const DofRange& active = structure.active();
  predict(step.hht, state.structure, active, ws.structure_prediction);
  past_contact_load(step.hht, state.structure, active, ws.structure_increment);
  add_ground_load(step.model, step.hht, step.begin, active, ws.structure_increment);
  ws.rail_dofs.clear();
  for (const RailContact& contact : step.contacts) append_dofs(contact, ws.rail_dofs);
  active.of(ws.structure_load).setZero();
  ws.structure_free.resize(step.model.structure->dofs());
  structure.begin_step(ws.structure_prediction, ws.structure_increment, ws.rail_dofs, ws.structure);
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
    const DofRange& active = step.operators.structure->active();
    LinearMotion& motion = state.structure;
    ws.structure.substitution.finish(step.operators.structure->factor(), ws.structure_increment);
    close_load(step.hht, active.of(ws.structure_load), active.of(motion.contact_load), active.of(motion.step_load));
    active.of(motion.contact_load).setZero();
    add_rail_forces(step.contacts, ws.solution.end_force, motion.contact_load);
    update(step.hht, ws.structure_prediction, ws.structure_increment, active, motion);
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
  const StepContext step{model, op, limits, hht, state.time, end, place_wheels(model, end)};
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
  static_cast<void>(evaluate_contact(contact, problem, now));
  for (int v = 0; v < static_cast<int>(state.vehicle.size()); ++v) {
    Eigen::VectorXd& load = state.vehicle[static_cast<std::size_t>(v)].contact_load;
    scatter_wheelset_forces(model, v, now.end_force, load);
    add_element_forces(model, state, v, load);
  }
  if (model.structure) scatter_rail_forces(contacts, now.end_force, state.structure.contact_load);
  state.contact.end_force = std::move(now.end_force);
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
