#include "railtab/runtime/vsi/energy_account.hpp"

#include <utility>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/external_load.hpp"

namespace railtab {

namespace {

// Of bump stops, and of friction that has not begun to slide.
double stored(const ForceElements& elements, const Eigen::VectorXd& x, const Eigen::VectorXd& friction) {
  double sum = 0.0;
  for (std::size_t i = 0; i < elements.element.size(); ++i) {
    const ForceElement& e = elements.element[i];
    if (e.kind == ForceElementKind::stop) sum += e.curve.integral(x[e.row]);
    const double force = friction[static_cast<Eigen::Index>(i)];
    if (e.kind == ForceElementKind::friction) sum += 0.5 * force * force / e.stiffness;
  }
  return sum;
}

}  // namespace

EnergyAccount::EnergyAccount(const VsiModel& model, const VsiState& state)
    : model_(model), contact_(model.train_contact()), frictionless_(contact_) {
  for (WheelContactModel& contact : frictionless_.model) contact.friction = 0.0;
  wheelset_gain_.assign(index(model.wheelsets()), 0.0);
  last_ = observe(state);
  balance_.initial = balance_.energy();
}

EnergyAccount::Instant EnergyAccount::observe(const VsiState& state) {
  EnergyBalance& b = balance_;
  b.time = state.time;
  b.kinetic = b.strain = b.gravity = b.contact = 0.0;
  Instant now;
  for (const LinearMotion& m : state.vehicle) {
    b.kinetic += 0.5 * m.velocity.dot(model_.vehicle.mass * m.velocity);
    b.strain += 0.5 * m.displacement.dot(model_.vehicle.stiffness * m.displacement);
    if (!model_.vehicle.elements.empty()) {
      const std::size_t v = now.elongation.size();
      now.elongation.emplace_back(model_.vehicle.elements.rows * m.displacement);
      now.friction.push_back(state.friction[v]);
      b.strain += stored(model_.vehicle.elements, now.elongation[v], now.friction[v]);
    }
    b.gravity -= model_.vehicle.static_load.dot(m.displacement);
    now.vehicle_displacement.push_back(m.displacement);
    now.vehicle_velocity.push_back(m.velocity);
  }
  if (model_.structure) {
    const LinearMotion& m = state.structure.whole();
    b.kinetic += 0.5 * m.velocity.dot(model_.structure->mass * m.velocity);
    b.strain += 0.5 * m.displacement.dot(model_.structure->stiffness * m.displacement);
    const std::vector<RailContact> contacts = place_wheels(model_, state.time);
    std::vector<RailHeadMotion> between;
    const Eigen::VectorXd& g = state.deflection.force;
    element_motion(contacts, g, state.deflection.rate, g, 0.0, between);
    for (int wheel = 0; wheel < static_cast<int>(between.size()); ++wheel) {
      b.strain += 0.5 * between[index(wheel)].displacement.dot(g.segment<3>(3 * wheel));
    }
    now.structure_velocity = m.velocity;
  }
  contact_.set_speed(model_.speed(state.time));
  frictionless_.set_speed(model_.speed(state.time));
  if (!model_.loads.empty() || model_.speed_profile || model_.lateral_acceleration != 0.0) {
    now.vehicle_load.resize(state.vehicle.size());
    for (std::size_t v = 0; v < state.vehicle.size(); ++v)
      vehicle_load(model_, static_cast<int>(v), state.time, now.vehicle_load[v]);
  }
  const ContactProblem problem = present_contact(model_, state);
  now.wheel_displacement = problem.predicted;
  now.wheel_velocity = problem.predicted_velocity;
  now.mean_force = now.mean_normal_force = Eigen::VectorXd::Zero(problem.predicted.size());
  now.step_load = state.contact.step_load;
  now.contact_energy.assign(index(model_.wheelsets()), 0.0);
  for (int w = 0; w < model_.wheelsets(); ++w) {
    const ContactGeometry& geometry = *contact_[w].geometry;
    const WheelRailPair& pair = geometry.pair();
    const WheelsetMotion motion = wheelset_motion(problem, problem.predicted, w);
    for (int side = 0; side < 2; ++side) {
      const WheelSide wheel_side = wheel_sides[index(side)];
      const RailHeadMotion rail = rail_motion(problem, problem.predicted, w, side);
      const WheelsetPose pose = relative_pose(pair, wheel_side, motion, rail);
      const WheelContact found = wheel_contact(geometry, pose);
      now.contact_energy[index(w)] += elastic_energy(contact_[w], found);
      const std::size_t number = now.contact.size();
      const int k = wheelset_unknowns * w, r = rail_unknown(2 * w + side);
      now.wheel_displacement.segment<3>(r) = rail.displacement;
      now.wheel_velocity.segment<3>(r) = rail.velocity;
      const auto add = [&](const WheelContactModel& contact, const std::vector<ContactMemory>& before,
                           std::vector<ContactMemory>& memory, Eigen::VectorXd& mean) {
        const LoadedWheelForce force = wheel_force(contact, wheel_side, motion, rail, found);
        memory.push_back(contact_memory(pair, found, force));
        if (before.empty()) return;  // the account begins
        const Vector9 f = mean_force(contact, wheel_side, motion, rail, before[number], found, force);
        mean.segment<6>(k) += f.head<6>();
        mean.segment<3>(r) = f.tail<3>();
      };
      add(contact_[w], last_.contact, now.contact, now.mean_force);
      add(frictionless_[w], last_.normal, now.normal, now.mean_normal_force);
    }
    b.contact += now.contact_energy[index(w)];
  }
  return now;
}

double EnergyAccount::dissipated_by_elements(double time_step, const Instant& now) const {
  double sum = 0.0;
  for (std::size_t v = 0; v < now.elongation.size(); ++v) {
    const Eigen::VectorXd &x0 = last_.elongation[v], &x1 = now.elongation[v];
    for (std::size_t i = 0; i < model_.vehicle.elements.element.size(); ++i) {
      const ForceElement& e = model_.vehicle.elements.element[i];
      const double moved = x1[e.row] - x0[e.row];
      if (e.kind == ForceElementKind::damper) sum += e.curve.at(moved / time_step).force * moved;
      if (e.kind != ForceElementKind::friction) continue;
      const double begin = last_.friction[v][static_cast<Eigen::Index>(i)];
      const FrictionStep path = slide(begin, e.stiffness * moved, e.limit(x0).force, e.limit(x1).force);
      sum += path.mean * moved - 0.5 * (path.end * path.end - begin * begin) / e.stiffness;
    }
  }
  return sum;
}

void EnergyAccount::step(double gamma, const VsiState& state) {
  const double time_step = state.time - balance_.time;
  const double contact_before = balance_.contact;
  Instant now = observe(state);
  for (std::size_t v = 0; v < state.vehicle.size(); ++v) {
    const Eigen::VectorXd mean = 0.5 * (last_.vehicle_velocity[v] + now.vehicle_velocity[v]);
    balance_.dissipated += time_step * mean.dot(model_.vehicle.damping * mean);
    if (now.vehicle_load.empty()) continue;
    balance_.load_work +=
        0.5 *
        (last_.vehicle_load[v] + now.vehicle_load[v]).dot(now.vehicle_displacement[v] - last_.vehicle_displacement[v]);
  }
  balance_.dissipated += dissipated_by_elements(time_step, now);
  if (model_.structure) {
    const Eigen::VectorXd mean = 0.5 * (last_.structure_velocity + now.structure_velocity);
    balance_.dissipated += time_step * mean.dot(model_.structure->damping * mean);
  }
  // Displacements of the material: those of the wheelsets, and of the rails without what the wheels' running on adds.
  const Eigen::VectorXd moved = now.wheel_displacement - last_.wheel_displacement;
  Eigen::VectorXd material = moved;
  for (int wheel = 0; wheel < 2 * model_.wheelsets(); ++wheel) {
    const int r = rail_unknown(wheel);
    material.segment<3>(r) = 0.5 * time_step * (last_.wheel_velocity.segment<3>(r) + now.wheel_velocity.segment<3>(r));
  }
  const Eigen::VectorXd creep_force = now.mean_force - now.mean_normal_force;
  const Eigen::VectorXd load = (1.0 - gamma) * last_.step_load + gamma * now.step_load;
  balance_.creep_work += creep_force.dot(material);
  balance_.traction_work += now.mean_normal_force.dot(material - moved);
  balance_.stiffness_work += balance_.contact - contact_before + now.mean_normal_force.dot(moved);
  for (int w = 0; w < model_.wheelsets(); ++w) {
    for (int k = 0; k < 2; ++k) balance_.contact_impulse[index(k)] += time_step * load[wheelset_unknowns * w + 1 + k];
    const auto of = [w](const Eigen::VectorXd& v) {
      return v.segment<wheelset_unknowns>(static_cast<Eigen::Index>(wheelset_unknowns) * w);
    };
    const double work = (of(load) - of(creep_force) - of(now.mean_normal_force)).dot(of(material)) +
                        of(now.mean_normal_force).dot(of(moved));
    wheelset_gain_[index(w)] = now.contact_energy[index(w)] - last_.contact_energy[index(w)] + work;
    balance_.contact_gain += wheelset_gain_[index(w)];
  }
  last_ = std::move(now);
}

}  // namespace railtab
