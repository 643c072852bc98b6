#pragma once

// The Manchester benchmark's wheelset in a run of its own, cases A2.1 and A2.2: the shift and yaw of the case are held,
// height, roll and rotation follow from the loads.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "manchester_rolling.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {

/// A wheelset whose lateral shift and yaw stiff springs hold near the given ones, free to move up and down, to roll
/// and to turn about its axle. The lateral spring acts at the height of the rails, so that a push against a flange does
/// not roll the wheelset; the benchmark loads each wheel by itself.
/// @param at_rails lateral shift of the wheelset at the height of the rails to which the spring pulls it [m]
inline VsiModel held_wheelset(const ManchesterWheelset& wheelset, double at_rails, double yaw) {
  constexpr double R0 = 0.46, lever = 1.0, mass = 1568.0;  // m, m, kg
  constexpr double stiffness = 1e9, damping = 2e6;         // [N/m, N s/m]: 20 kN are 20 µm
  const std::vector<RigidBody> bodies{{"frame", 1.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}},
                                      {"wheelset", mass, {656.0, 168.0, 656.0}, {0.0, 0.0, -R0}}};
  DofIndices none;
  none.fill(held);
  const DofIndices free{held, 0, 0, 0, 0, 0};
  std::vector<Suspension> springs{{0, 1, {0.0, 0.0, 0.0}, {0.0, stiffness, 0.0}, {0.0, damping, 0.0}}};
  for (const double side : {-1.0, 1.0})
    springs.push_back({0, 1, {0.0, side * lever, -R0}, {stiffness, 0.0, 0.0}, {damping, 0.0, 0.0}});
  VsiModel model;
  model.vehicle = assemble_vehicle({"held wheelset", bodies, springs, {1}, {none, free}, R0, 10.0});
  const DofIndices& dof = model.vehicle.dof[1];
  model.vehicle.static_load[dof[2]] = 2.0 * ManchesterWheelset::load;
  const double push = stiffness * at_rails;  // N
  model.vehicle.static_load[dof[1]] = push;
  model.vehicle.static_load[dof[3]] = -R0 * push;
  model.vehicle.static_load[dof[5]] = 2.0 * stiffness * lever * lever * yaw;
  model.vehicle_x = {0.0};
  model.gyroscopic_moments = GyroscopicMoments::neglected;
  model.geometry = std::make_shared<const ContactGeometry>(wheelset.geometry());
  model.contact.geometry = model.geometry.get();
  model.contact.normal = wheelset.model();
  model.contact.creep_law = creep_law("table", wheelset.model().material.nu);
  model.contact.friction = manchester_friction;
  model.contact.speed = manchester_speed;
  return model;
}

/// Displacement and rotation of the wheelset after a second of rolling, and how far it still moved in the last tenth.
struct RollingRest {
  MotionRecord motion;
  double drift = 0.0;  ///< of its height [m]
};

inline RollingRest roll_to_rest(const VsiModel& model, double y, double yaw) {
  VsiModel centred = model;  // at rest without the pushes to y and yaw, from where the wheelset is displaced
  const DofIndices& dof = model.vehicle.dof[1];
  for (const std::size_t pushed : {1u, 3u, 5u}) centred.vehicle.static_load[dof[pushed]] = 0.0;
  VsiState state(centred);
  if (!static_equilibrium(centred, state).converged) throw std::runtime_error("no equilibrium");
  if (!displace_train(centred, y, yaw, state)) throw std::runtime_error("no height for the shift");
  constexpr double duration = 1.0;
  RollingRest rest;
  double height = 0.0;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    rest.motion = record.bodies.at(1);
    if (record.time < 0.9 * duration) height = rest.motion.displacement[2];
    rest.drift =
        std::max(record.time < 0.9 * duration ? 0.0 : rest.drift, std::abs(rest.motion.displacement[2] - height));
  };
  IntegrationParameters integration;
  integration.alpha = -0.3;  // the steady state is wanted, not the way there
  const RunSummary summary = simulate(model, integration, duration, 20, state, observer);
  if (!summary.complete) throw std::runtime_error(summary.message);
  return rest;
}

/// The wheelset in a run at its shift: the pull of the spring by the secant, until its centre is there to 0.1 µm.
struct HeldRun {
  HeldRun(const ManchesterWheelset& wheelset, double y, double yaw) {
    double pull = y - wheelset.search().pair().nominal_radius() * rigid_position(wheelset.search(), y, yaw).roll;
    double last_pull = pull, last_miss = 0.0;
    for (int i = 0; i < 12; ++i) {
      model = held_wheelset(wheelset, pull, yaw);
      rest = roll_to_rest(model, y, yaw);
      const double miss = rest.motion.displacement[1] - y;
      if (std::abs(miss) < 1e-7) return;
      const double slope = i == 0 ? 1.0 : (miss - last_miss) / (pull - last_pull);
      last_pull = pull;
      last_miss = miss;
      pull -= miss / slope;
    }
  }
  VsiModel model;
  RollingRest rest;
};

}  // namespace railtab
