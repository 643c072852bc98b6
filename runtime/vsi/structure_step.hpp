#pragma once

#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

/// Predicts the structure and begins its back-substitution with the load that is known before the contact forces at the
/// end of the step: ws.structure_prediction, and ws.structure_free under the wheels.
inline void begin_structure(const VsiModel& model, const StepOperators& op, const VsiState& state,
                            const std::vector<RailContact>& contacts, StepWorkspace& ws) {
  const DofRange& active = op.structure->active();
  predict(op.scheme, state.structure, active, ws.structure_prediction);
  op.structure->step_load(op.scheme, state.structure, ws.structure_prediction, ws.structure_increment);
  add_ground_load(model, op.scheme, state.time, active, ws.structure_increment);
  ws.rail_dofs.clear();
  for (const RailContact& contact : contacts) append_dofs(contact, ws.rail_dofs);
  active.of(ws.structure_load).setZero();
  ws.structure_free.resize(model.structure->dofs());
  ws.structure_solution.begin(op.structure->factor(), ws.structure_increment, ws.rail_dofs);
  ws.structure_solution.respond(op.structure->factor(), ws.structure_free);
}

}  // namespace railtab
