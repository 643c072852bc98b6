#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "watched_run.hpp"

namespace railtab::stability {
namespace {

using Cases = std::vector<StabilityCase>;

/// Every vertical dof of the train.
template <class Change>
void for_vertical_dofs(const VsiModel& model, VsiState& state, const Change& change) {
  for (LinearMotion& motion : state.vehicle) {
    for (std::size_t body = 0; body < model.vehicle.dof.size(); ++body) {
      const int z = model.vehicle.dof[body][2];
      if (z != held) change(motion, z, body);
    }
  }
}

/// Accelerations that go with displacements and velocities where no wheel touches its rail: Newmark's energy is that of
/// equilibrium at both ends of a step.
void balance_accelerations(const VsiModel& model, VsiState& state) {
  const Eigen::MatrixXd damping = model.vehicle_damping(model.contact.speed);
  for (LinearMotion& m : state.vehicle) {
    m.acceleration = symmetric_solution(model.vehicle.mass, model.vehicle.static_load - damping * m.velocity -
                                                                model.vehicle.stiffness * m.displacement);
  }
  if (!model.structure) return;
  LinearMotion& m = state.structure.whole();
  const SparseLdlt mass(model.structure->mass, "the structure's mass is not positive definite");
  m.acceleration = mass.solve(-(model.structure->damping * m.velocity) - model.structure->stiffness * m.displacement);
}

/// A train that falls from 0.9 m above its rails, wheels in the air, with its suspension and its track struck: a linear
/// system, whose energy Newmark's steps keep but for what dampers take.
CaseResult closed_system(SceneParameters scene) {
  scene.integration.alpha = 0.0;
  scene.integration.duration = 0.2;
  const VsiModel model = build_model(scene);
  const WatchedRun run = watched_run(model, scene.integration, scene.integration.duration, [&](VsiState& state) {
    for_vertical_dofs(model, state, [](LinearMotion& motion, int z, std::size_t body) {
      motion.displacement[z] -= 0.9;
      motion.velocity[z] += 0.1 * static_cast<double>(body % 3);
    });
    if (model.structure) {
      Eigen::VectorXd& velocity = state.structure.whole().velocity;
      for (Eigen::Index i = 0; i < velocity.size(); i += 7) velocity[i] += 0.1;
    }
    for (Eigen::VectorXd* of_wheels : {&state.deflection.force, &state.deflection.slope_force}) of_wheels->setZero();
    balance_accelerations(model, state);
  });
  CaseResult result = judged(run);
  result.error = std::max(result.energy.step, std::abs(result.energy.total));
  if (!result.energy.kept || run.longest_flight < 0.99 * scene.integration.duration) result.outcome = Outcome::wrong;
  return result;
}

/// The whole train thrown up at t = 0.
WatchedRun thrown_up(const VsiModel& model, const IntegrationParameters& integration, double upward_speed) {
  constexpr double duration = 0.8;
  return watched_run(model, integration, duration, [&](VsiState& state) {
    for_vertical_dofs(model, state,
                      [&](LinearMotion& motion, int z, std::size_t) { motion.velocity[z] -= upward_speed; });
  });
}

CaseResult judged_flight(const WatchedRun& run, double least) {
  CaseResult result = judged(run);
  result.note +=
      fmt::format("{}flight of {:.2f} s, {} landings, wheel load up to {:.0f} kN", result.note.empty() ? "" : "; ",
                  run.longest_flight, result.energy.impacts, 1e-3 * run.largest_load);
  if (result.outcome == Outcome::converged && run.longest_flight < least) {
    result.outcome = Outcome::wrong;
    result.note += ", shorter than planned";
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> energy_cases() {
  Cases cases;
  constexpr const char* kept = "energy of a step and of the run";
  cases.push_back({"linear systems, alpha 0", "a coach in the air", kept, 1e-12, Outcome::converged, true,
                   [](double) { return closed_system(coach_on_rigid_track()); }});
  // The factor of the structure is that of a mass matrix that differs by roundings of floats: it is the energy of that
  // one which the 400 steps keep.
  cases.push_back({"linear systems, alpha 0", "the same over a bridge", kept, 1e-6, Outcome::converged, true,
                   [](double) { return closed_system(coach_on_bridge()); }});
  const auto add = [&](const std::string& setting, const char* measure, double allowed, bool quick,
                       const std::function<CaseResult(double)>& run) {
    cases.push_back({"lift-off and landing", setting, measure, allowed, Outcome::converged, quick, run});
  };
  for (const double dt : {1e-4, 5e-4, 2e-3}) {
    add(fmt::format("a coach for 0.56 s, {:g} s", dt), "impulse balance", 1e-3, dt == 5e-4, [=](double) {
      SceneParameters scene = coach_on_rigid_track();
      scene.integration.time_step = dt;
      return judged_flight(thrown_up(build_model(scene), scene.integration, 3.0), 0.5);
    });
  }
  add("a coach for 0.2 s, 0.0005 s", "impulse balance", 1e-3, true, [](double) {
    const SceneParameters scene = coach_on_rigid_track();
    return judged_flight(thrown_up(build_model(scene), scene.integration, 2.1), 0.2);
  });
  for (const double dt : {1e-4, 5e-4, 2e-3}) {
    const auto wheelset = [dt](std::optional<ContactForceRule> rule) {
      IntegrationParameters integration;
      integration.time_step = dt;
      integration.contact_force = rule;
      return judged_flight(thrown_up(sprung_wheelset(), integration, 2.1), 0.2);
    };
    const auto by_energy = [wheelset](std::optional<ContactForceRule> rule) {
      CaseResult result = wheelset(rule);
      result.error = result.energy.impact;
      return result;
    };
    const std::string setting = fmt::format("a wheelset for 0.4 s, {:g} s", dt);
    add(setting, "energy of an impact", 1e-2, dt == 5e-4, [=](double) { return by_energy({}); });
    add(setting + ", contact_force \"energy\"", "energy of an impact", 1e-2, dt == 5e-4,
        [=](double) { return by_energy(ContactForceRule::energy); });
    add(setting + ", contact_force \"endpoint\"", "impulse balance", 1e-3, dt == 5e-4,
        [=](double) { return wheelset(ContactForceRule::endpoint); });
  }
  return cases;
}

}  // namespace railtab::stability
