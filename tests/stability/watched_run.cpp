#include "watched_run.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "energy_watch.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"

namespace railtab::stability {
namespace {

/// Sums over the dofs y and z of all bodies.
struct Pair {
  double y = 0.0, z = 0.0;
};

Pair momentum(const VsiModel& model, const VsiState& state) {
  Pair sum;
  for (const LinearMotion& motion : state.vehicle) {
    const Eigen::VectorXd p = model.vehicle.mass * motion.velocity;
    for (const DofIndices& dof : model.vehicle.dof) {
      if (dof[1] != held) sum.y += p[dof[1]];
      if (dof[2] != held) sum.z += p[dof[2]];
    }
  }
  return sum;
}

Pair load(const VsiModel& model) {
  Pair sum;
  for (const DofIndices& dof : model.vehicle.dof) {
    if (dof[1] != held) sum.y += model.vehicle.static_load[dof[1]];
    if (dof[2] != held) sum.z += model.vehicle.static_load[dof[2]];
  }
  const auto vehicles = static_cast<double>(model.vehicle_x.size());
  return {vehicles * sum.y, vehicles * sum.z};
}

Pair wheel_forces(const StepRecord& record) {
  Pair sum;
  for (const WheelRecord& wheel : record.wheels) {
    sum.y += wheel.Y;
    sum.z += wheel.Q;
  }
  return sum;
}

bool all_finite(const StepRecord& record) {
  bool finite = true;
  for (const WheelRecord& w : record.wheels) finite = finite && std::isfinite(w.Q + w.Y + w.X + w.penetration);
  for (const auto* motions : {&record.bodies, &record.nodes}) {
    for (const MotionRecord& m : *motions) {
      for (int k = 0; k < 6; ++k)
        finite = finite && std::isfinite(m.displacement[k] + m.velocity[k] + m.acceleration[k]);
    }
  }
  return finite;
}

/// Takes in record after record, and the account of every step.
class Watch {
 public:
  Watch(const VsiModel& model, WatchedRun& run) : model_(&model), run_(&run) {}

  void operator()(const StepRecord& record) {
    run_->finite = run_->finite && all_finite(record);
    const double step = run_->records > 0 ? record.time - time_ : 0.0;
    const Pair force = wheel_forces(record);
    if (run_->records++ > 0 && !of_account_) {
      impulse_.y += 0.5 * step * (force_.y + force.y);
      impulse_.z += 0.5 * step * (force_.z + force.z);
    }
    force_ = force;
    time_ = record.time;
    flight_.resize(record.wheels.size(), 0.0);
    for (std::size_t w = 0; w < record.wheels.size(); ++w) {
      flight_[w] = record.wheels[w].patches == 0 ? flight_[w] + step : 0.0;
      run_->longest_flight = std::max(run_->longest_flight, flight_[w]);
      run_->largest_load = std::max(run_->largest_load, record.wheels[w].Q);
    }
    const std::size_t bodies = model_->vehicle.bodies.size();
    for (std::size_t i = 0; i < record.bodies.size(); ++i) {
      const auto& wheelsets = model_->vehicle.wheelsets;
      if (std::find(wheelsets.begin(), wheelsets.end(), static_cast<int>(i % bodies)) == wheelsets.end()) continue;
      run_->largest_shift = std::max(run_->largest_shift, std::abs(record.bodies[i].displacement[1]));
    }
  }

  void operator()(const EnergyBalance& balance) {
    impulse_ = {-balance.contact_impulse[0], -balance.contact_impulse[1]};
    of_account_ = true;
  }

  void conclude(const Pair& change) {
    const Pair weight = load(*model_);
    const double vertical = weight.z * time_ - impulse_.z - change.z;
    const double lateral = weight.y * time_ - impulse_.y - change.y;
    const double scale = std::abs(weight.z) * time_ + std::abs(impulse_.z) + std::abs(change.z);
    run_->impulse_error = scale > 0.0 ? std::hypot(vertical, lateral) / scale : 0.0;
  }

 private:
  const VsiModel* model_;
  WatchedRun* run_;
  double time_ = 0.0;
  Pair force_, impulse_;
  bool of_account_ = false;  // wheels that follow the rails have none
  std::vector<double> flight_;
};

}  // namespace

WatchedRun watched_run(const VsiModel& model, const IntegrationParameters& integration, double duration,
                       const std::function<void(VsiState&)>& disturb) {
  return watched_run(model, model, integration, duration, disturb);
}

WatchedRun watched_run(const VsiModel& start, const VsiModel& model, const IntegrationParameters& integration,
                       double duration, const std::function<void(VsiState&)>& disturb) {
  WatchedRun run;
  VsiState state(model);
  run.started = steady_start(start, state).converged;
  if (!run.started) {
    run.summary.message = "no static equilibrium";
    return run;
  }
  if (disturb) disturb(state);
  const Pair before = momentum(model, state);
  Watch watch(model, run);
  EnergyWatch energy;
  RunObserver observer;
  observer.energy = [&](const EnergyBalance& balance) {
    watch(balance);
    energy.take(balance);
  };
  observer.record = [&](const StepRecord& record) {
    watch(record);
    energy.record(record);
  };
  run.summary = simulate(model, integration, duration, 1, state, observer);
  run.energy = energy.result();
  const Pair after = momentum(model, state);
  watch.conclude({after.y - before.y, after.z - before.z});
  return run;
}

CaseResult judged(const WatchedRun& run) {
  CaseResult result;
  result.steps = run.summary.steps;
  result.halved_steps = run.summary.halved_steps;
  result.error = run.impulse_error;
  result.energy = run.energy;
  result.note = run.summary.message;
  const bool sound = run.finite && std::isfinite(run.impulse_error);
  result.outcome = !sound ? Outcome::wrong : run.summary.complete ? Outcome::converged : Outcome::ended;
  if (!sound) result.note = "numbers that are not finite";
  return result;
}

SceneParameters coach_on_rigid_track() {
  SceneParameters scene;
  scene.name = "stability";
  scene.contact.mode = ContactMode::online;
  scene.track_kind = TrackKind::rigid;
  scene.integration.duration = 0.3;
  return scene;
}

VsiModel sprung_wheelset() {
  VsiModel model = build_model(coach_on_rigid_track());
  const double R0 = model.geometry->pair().dimensions().nominal_radius;
  DofIndices heave;
  heave.fill(held);
  heave[2] = 0;
  const std::vector<RigidBody> bodies{{"wheelset", 1500.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}},
                                      {"mass", 8500.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -2.0 * R0}}};
  const std::vector<Suspension> spring{{0, 1, {0.0, 0.0, -1.5 * R0}, {0.0, 0.0, 1.2e6}, {0.0, 0.0, 1e4}}};
  model.vehicle = assemble_vehicle({"sprung wheelset", bodies, spring, {0}, {heave, heave}, R0, 10.0});
  model.vehicle_x = {0.0};
  return model;
}

SceneParameters coach_on_bridge() {
  SceneParameters scene = coach_on_rigid_track();
  scene.track_kind = TrackKind::flexible;
  scene.track.length_before = 60.0;
  scene.track.length_after = 60.0;
  scene.spans.resize(1);
  scene.spans[0].length = 20.0;
  scene.spans[0].elements = 10;
  scene.train.start = 5.0;
  return scene;
}

}  // namespace railtab::stability
