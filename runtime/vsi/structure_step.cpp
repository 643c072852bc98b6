#include "railtab/runtime/vsi/structure_step.hpp"

#include <cassert>
#include <utility>

namespace railtab {

namespace {

// The transpose of rail_head over all loads.
void add_loads(std::span<const RailLoad> loads, Eigen::VectorXd& sum) {
  for (const RailLoad& rail : loads) add_rail_load(rail.place, rail.load, sum);
}

}  // namespace

StructureMotion rest_under(const StructureModel& structure, std::span<const RailLoad> loads) {
  LinearMotion motion(structure.dofs());
  add_loads(loads, motion.contact_load);
  // Without a load there is nothing to solve.
  if (!motion.contact_load.isZero(0.0)) motion.displacement = StructureResponse(structure).solve(motion.contact_load);
  return StructureMotion(std::move(motion));
}

void advance_structure(const StructureResponse& response, std::span<const RailLoad> loads, StructureMotion& motion,
                       StructureStepWorkspace& ws) {
  const HhtScheme& scheme = response.scheme();
  assert(scheme.contact_force == ContactForceRule::endpoint);
  LinearMotion& of_contacts = motion.loads();
  const DofRange all{0, of_contacts.contact_load.size()};
  find_loaded(of_contacts, all, ws.past_rail_dofs);
  ws.rail_dofs.clear();
  for (const RailLoad& rail : loads) append_dofs(rail.place, ws.rail_dofs);
  ws.load.setZero(all.count);
  ws.response.resize(all.count);
  add_loads(loads, ws.load);
  response.begin_step(motion, {of_contacts.contact_load, ws.past_rail_dofs, -scheme.alpha}, {ws.rail_dofs, {}},
                      ws.solution);
  ws.solution.substitution.respond(response.factor(), scheme.load_weight(), ws.load, ws.response);
  response.finish_step(ws.solution, motion);
  of_contacts.contact_load.swap(ws.load);
  of_contacts.loaded.reset();
}

}  // namespace railtab
