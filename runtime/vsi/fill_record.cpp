#include "railtab/runtime/vsi/contact_evaluation.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

void fill_motion(const DofIndices& dof, const LinearMotion& motion, MotionRecord& record) {
  for (std::size_t k = 0; k < 6; ++k) {
    const bool free = dof[k] != held;
    record.displacement[k] = free ? motion.displacement[dof[k]] : 0.0;
    record.velocity[k] = free ? motion.velocity[dof[k]] : 0.0;
    record.acceleration[k] = free ? motion.acceleration[dof[k]] : 0.0;
  }
}

void fill_node(const StructureModel& structure, std::size_t node, const LinearMotion& motion, MotionRecord& record) {
  for (std::size_t k = 0; k < 6; ++k) {
    record.displacement[k] = node_motion(structure, node, k, motion.displacement);
    record.velocity[k] = node_motion(structure, node, k, motion.velocity);
    record.acceleration[k] = node_motion(structure, node, k, motion.acceleration);
  }
}

// What supports carry the nodes by.
void add_carried(const VsiModel& model, StepRecord& record) {
  const StructureSupports& supports = model.structure->supports;
  if (!model.ground_motion || supports.carried_nodes.size() == 0) return;
  const SupportMotion motion = support_motion(*model.ground_motion, supports.x, record.time);
  const Eigen::VectorXd displacement = supports.carried_nodes * motion.displacement;
  const Eigen::VectorXd velocity = supports.carried_nodes * motion.velocity;
  const Eigen::VectorXd acceleration = supports.carried_nodes * motion.acceleration;
  for (std::size_t n = 0; n < record.nodes.size(); ++n) {
    for (std::size_t k = 0; k < 6; ++k) {
      const auto row = static_cast<Eigen::Index>(6 * n + k);
      record.nodes[n].displacement[k] += displacement[row];
      record.nodes[n].velocity[k] += velocity[row];
      record.nodes[n].acceleration[k] += acceleration[row];
    }
  }
}

void fill_patches(const WheelRailPair& pair, const ContactSolution& contact, std::size_t index, WheelRecord& wheel) {
  const ContactPatches patches = recorded_patches(pair, contact.contact[index]);
  const ContactPatch* first = nullptr;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
    const ContactPatch& patch = patches.patch[i];
    const double force = contact.normal[index][i];
    if (force <= 0.0) continue;
    ++wheel.patches;
    if (!first || force > wheel.normal_force) {
      wheel.second_normal_force = wheel.normal_force;
      wheel.second_y_rail = wheel.y_rail;
      wheel.normal_force = force;
      first = &patch;
      wheel.y_rail = patch.y_rail;
      wheel.y_wheel = patch.y_wheel;
      wheel.angle = patch.angle;
      wheel.rolling_radius = patch.rolling_radius;
      wheel.penetration = patch.penetration;
    } else if (force > wheel.second_normal_force) {
      wheel.second_normal_force = force;
      wheel.second_y_rail = patch.y_rail;
    }
  }
}

}  // namespace

void fill_record(const VsiModel& model, const VsiState& state, StepRecord& record, bool contact_points) {
  record.time = state.time;
  record.position = model.wheelset_x(0, state.time);
  const auto wheels = static_cast<std::size_t>(2 * model.wheelsets());
  record.wheels.resize(wheels);
  const double speed = model.speed(state.time);
  for (std::size_t wheel = 0; wheel < wheels; ++wheel) {
    WheelRecord& w = record.wheels[wheel];
    w = {};
    if (!contact_points) w.from_table = -1;
    if (model.geometry && contact_points) {
      const ContactGeometry& geometry = model.geometry_of(static_cast<int>(wheel / 2));
      fill_patches(geometry.pair(), state.contact, wheel, w);
      w.from_table = answered_by_table(geometry, state.contact.contact[wheel]) ? 1 : 0;
    }
    const int unknown = rail_unknown(static_cast<int>(wheel));
    w.Y = state.contact.end_force[unknown];
    w.Q = state.contact.end_force[unknown + 1];
    w.X = state.contact.rail_x[wheel];
    w.wear_number = speed > 0.0 ? state.contact.creep_power[wheel] / speed : 0.0;
    w.pressure = state.contact.pressure[wheel];
  }
  const std::size_t bodies = model.vehicle.bodies.size();
  record.bodies.resize(bodies * state.vehicle.size());
  for (std::size_t v = 0; v < state.vehicle.size(); ++v) {
    for (std::size_t b = 0; b < bodies; ++b)
      fill_motion(model.vehicle.dof[b], state.vehicle[v], record.bodies[v * bodies + b]);
  }
  if (!model.structure) return;
  record.nodes.resize(model.structure->nodes.size());
  const StructureModel& structure = *model.structure;
  // motions that are sums need unknowns of other nodes, too
  if (structure.summed_nodes.size() > 0) static_cast<void>(state.structure.whole());
  for (std::size_t n = 0; n < record.nodes.size(); ++n) {
    fill_node(structure, n, state.structure.at(structure.nodes[n].dof), record.nodes[n]);
  }
  add_carried(model, record);
}

}  // namespace railtab
