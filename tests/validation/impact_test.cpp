// Energy of contacts that part and meet again: a wheelset that bounces on rails without friction or damping.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "../measured.hpp"
#include "hunting_model.hpp"
#include "kinked_track.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"

namespace railtab::hunting {
namespace {

// The wheelset with the load of an axle, free to heave only, on cones and crowns: two Hertz springs of constant
// stiffness.
VsiModel bouncing_mass() {
  constexpr double speed = 50.0;  // m/s
  VsiModel model = wheelset({}, speed);
  DofIndices none;
  none.fill(held);
  const DofIndices heave{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle(
      {"bouncing mass",
       {{"frame", 1.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}}, {"mass", 11000.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}}},
       {},
       {1},
       {none, heave},
       R0,
       10.0});
  model.contact.constant_ellipse.reset();
  model.contact.gravitational_stiffness = GravitationalStiffness::included;
  model.contact.friction = 0.0;
  return model;
}

struct Bouncing {
  std::vector<double> change;  ///< of the energy at each impact, relative to that before
  double largest = 0.0;        ///< of these
  double total = 0.0;          ///< energy in the last flight less that of the fall [J]
  EnergyBalance balance;       ///< then
  ContactEnergy contacts;      ///< what the run's summary says
  double most_made = 0.0;      ///< of the energy in one impact, by amount [J]
};

// Height of the wheelset at which the wheels touch: z, down.
double touch_height(const VsiModel& model) {
  double low = -1e-3, high = 1e-3;
  while (high - low > 1e-15) {
    const double middle = 0.5 * (low + high);
    (model.geometry->patches({.z = middle}).count > 0 ? high : low) = middle;
  }
  return low;
}

// Falls from `height` [m] until it has met the rails `impacts` times; energies are taken in flight.
Bouncing bounce(std::optional<ContactForceRule> rule, double alpha, double time_step, double height, int impacts,
                double impact_step = IntegrationParameters{}.impact_step) {
  const VsiModel model = bouncing_mass();
  const int z = model.vehicle.dof[1][2];
  const double mass = model.vehicle.mass(z, z);
  const double g = model.vehicle.static_load[z] / mass;
  const double touch = touch_height(model);
  VsiState state(model);
  state.vehicle[0].displacement[z] = touch - height;
  state.vehicle[0].acceleration[z] = g;

  Bouncing result;
  const double fall = mass * g * height;
  double energy = fall;
  bool was_loaded = false;
  RunObserver observer;
  observer.contact_energy = true;
  observer.energy = [&](const EnergyBalance& balance) { result.balance = balance; };
  observer.record = [&](const StepRecord& record) {
    const bool loaded = record.wheels[0].Q + record.wheels[1].Q > 0.0;
    if (was_loaded && !loaded) {
      const MotionRecord& motion = record.bodies.at(1);
      const double now =
          0.5 * mass * motion.velocity[2] * motion.velocity[2] - mass * g * (motion.displacement[2] - touch);
      result.change.push_back(now / energy - 1.0);
      if (std::abs(now - energy) > std::abs(result.most_made)) result.most_made = now - energy;
      energy = now;
    }
    was_loaded = loaded;
  };
  observer.stop = [&] { return static_cast<int>(result.change.size()) == impacts; };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = alpha;
  integration.contact_force = rule;
  integration.impact_step = impact_step;
  const RunSummary run = simulate(model, integration, 5.0, 1, state, observer);
  if (!run.interrupted) throw std::runtime_error("too few impacts: " + run.message);
  for (const double change : result.change) result.largest = std::max(result.largest, std::abs(change));
  result.total = energy - fall;
  result.contacts = run.contact_energy.value();
  return result;
}

TEST(Impact, KeepsItsEnergyWithinOnePercentAtOneMillisecond) {
  for (const double height : {1e-3, 5e-3, 2e-2}) {
    for (const double alpha : {0.0, -0.05, -0.1}) {
      const auto largest = [&](std::optional<ContactForceRule> rule) {
        return bounce(rule, alpha, 1e-3, height, 8).largest;
      };
      const double endpoint = largest(ContactForceRule::endpoint), energy = largest(ContactForceRule::energy);
      const double automatic = largest(std::nullopt);
      std::printf(
          "fall of %2.0f mm, alpha %5.2f, 1 ms: energy changes by up to %6.3f %% per impact, automatic rule %6.3f %%, "
          "endpoint rule %.2f %%\n",
          1e3 * height, alpha, 100 * energy, 100 * automatic, 100 * endpoint);
      const std::string name = fmt::format("impact.{:g}mm.{:g}", 1e3 * height, 100 * std::abs(alpha));
      testing::measured(name + ".energy", 100 * energy);
      testing::measured(name + ".automatic", 100 * automatic);
      testing::measured(name + ".endpoint", 100 * endpoint);
      EXPECT_LT(energy, 0.01);
      EXPECT_LT(automatic, 0.01);
      EXPECT_GT(endpoint, 0.01);  // the question is worth asking
    }
  }
}

// What is left is HHT's damping (with alpha = 0 nothing, but for the stiffness that varies with the depth).
TEST(Impact, RemainderVanishesFasterThanTheSquareOfTheTimeStep) {
  for (const std::optional<ContactForceRule> rule : {std::optional(ContactForceRule::energy), {}}) {
    for (const double alpha : {-0.05, -0.1, -0.3}) {
      const auto loss = [&](double dt) { return bounce(rule, alpha, dt, 1e-3, 8, dt).largest; };
      const double coarse = loss(1e-3), fine = loss(2.5e-4);
      const double order = 0.5 * std::log2(coarse / fine);
      std::printf("%s, alpha %5.2f: %.2e of the energy per impact at 1 ms, %.2e at 0.25 ms, order %.2f\n",
                  rule ? "energy" : "automatic", alpha, coarse, fine, order);
      testing::measured(fmt::format("impact.order.{}{:g}", rule ? "" : "automatic.", 100 * std::abs(alpha)), order);
      EXPECT_GT(order, 2.0);
      EXPECT_LT(order, 4.5);
    }
  }
}

double largest_load(SceneParameters scene, const Irregularity& irregularity, double time_step, double impact_step) {
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.integration.time_step = time_step;
  scene.integration.impact_step = impact_step;
  scene.output.every = 1000;  // peaks are of all steps
  VsiModel model = build_model(scene);
  model.irregularity = irregularity;
  const RunSummary summary = run_scene(scene, model, {});
  EXPECT_TRUE(summary.complete);
  return summary.wheel_extremes.largest_Q.value;
}

// A coach set off across flexible rails: flanges climb them, and wheels fall back. Long steps have the peak of short
// ones where those of the impact are divided. Where they are not, those of 1 ms are far above it; those of 0.5 ms
// differ by a percent or less, by chance.
TEST(Impact, AHardLandingHasItsPeakInLongSteps) {
  SceneParameters scene;
  scene.train.speed = 200.0 / 3.6;
  scene.train.initial_lateral_shift = 8.5e-3;
  scene.train.initial_yaw = 10e-3;
  scene.track.length_before = 36.0;
  scene.track.length_after = 60.0;
  scene.integration.duration = 0.03;  // past the peak
  const double truth = largest_load(scene, {}, 3.125e-5, 3.125e-5);
  for (const double step : {5e-4, 1e-3}) {
    const double divided = largest_load(scene, {}, step, IntegrationParameters{}.impact_step);
    const double whole = largest_load(scene, {}, step, step);
    std::printf("off the rails' sides, steps of %g ms: %.1f kN, not divided %.1f kN; steps of 1/32 ms: %.1f kN\n",
                1e3 * step, 1e-3 * divided, 1e-3 * whole, 1e-3 * truth);
    EXPECT_NEAR(divided, truth, 0.01 * truth);
    if (step == 1e-3) {
      EXPECT_GT(whole, 1.3 * truth) << "the question is worth asking";
    }
  }
}

// Treads fall upon flexible track behind a hump: 8 mm high, 3 m long, at 300 km/h.
TEST(Impact, ATreadThatFallsOnFlexibleTrackHasItsPeakInLongSteps) {
  SceneParameters scene;
  scene.train.speed = 300.0 / 3.6;
  scene.track.length_before = 36.0;
  scene.track.length_after = 40.0;
  scene.integration.duration = 0.065;  // past the peak
  const double truth = largest_load(scene, hump(), 1.5625e-5, 1.5625e-5);
  // The load of a wheel that lands between sleepers depends on the rail's inertia there.
  SceneParameters finer = scene;
  finer.track.elements_per_bay = 8;
  const double fine_mesh = largest_load(finer, hump(), 3.125e-5, 3.125e-5);
  std::printf("behind a hump: %.1f kN, on eight elements per bay %.1f kN\n", 1e-3 * truth, 1e-3 * fine_mesh);
  testing::measured("impact.hump.one_element", 100.0 * std::abs(truth / fine_mesh - 1.0));
  EXPECT_NEAR(truth, fine_mesh, 0.02 * fine_mesh);
  for (const double step : {5e-4, 1e-3}) {
    for (const double impact_step : {2.5e-4, 1.25e-4, 6.25e-5, IntegrationParameters{}.impact_step}) {
      const double peak = largest_load(scene, hump(), step, impact_step);
      const double error = std::abs(peak / truth - 1.0);
      std::printf("behind a hump, steps of %g ms, %g ms at impacts: %.1f kN; steps of 1/64 ms: %.1f kN\n", 1e3 * step,
                  1e3 * impact_step, 1e-3 * peak, 1e-3 * truth);
      testing::measured(fmt::format("impact.hump.{:g}.{:g}us", 1e3 * step, 1e6 * impact_step), 100.0 * error);
      if (impact_step == 2.5e-4) {
        EXPECT_GT(error, 0.1);  // the question is worth asking
      } else if (impact_step == IntegrationParameters{}.impact_step) {
        EXPECT_LT(error, 0.015);
      }
    }
  }
}

// Wheels that run upon a ramp of 2 mm in 0.2 m and stay on their rails, at 250 km/h.
TEST(Impact, AHitWithoutFlightHasItsPeakInLongSteps) {
  SceneParameters scene;
  scene.train.speed = 250.0 / 3.6;
  scene.train.start = 4.0;
  scene.track.length_before = 40.0;
  scene.track.length_after = 40.0;
  scene.integration.duration = 0.03;  // past the peak
  const Irregularity ramp =
      both_rails(0.0, 0.05, 600, [](double x) { return -2e-3 * std::clamp((x - 5.0) / 0.2, 0.0, 1.0) * (x < 25.0); });
  const double truth = largest_load(scene, ramp, 1.5625e-5, 1.5625e-5);
  for (const double step : {2.5e-4, 5e-4, 1e-3, 2e-3}) {
    const double divided = largest_load(scene, ramp, step, IntegrationParameters{}.impact_step);
    const double whole = largest_load(scene, ramp, step, step);
    std::printf("onto a ramp, steps of %g ms: %.1f kN, not divided %.1f kN; steps of 1/64 ms: %.1f kN\n", 1e3 * step,
                1e-3 * divided, 1e-3 * whole, 1e-3 * truth);
    testing::measured(fmt::format("impact.ramp.{:g}ms", 1e3 * step), 100.0 * (divided / truth - 1.0));
    testing::measured(fmt::format("impact.ramp.{:g}ms.whole", 1e3 * step), 100.0 * (whole / truth - 1.0));
    EXPECT_NEAR(divided, truth, 0.02 * truth);
    if (step == 5e-4) {
      EXPECT_GT(whole, 1.1 * truth);  // the question is worth asking
    }
  }
}

// Where the state says which unknowns of the structure contacts load, no other one has a load: through flights, divided
// steps and both rules of contact forces.
TEST(Impact, TheStateKnowsWhereContactsLoadTheStructure) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.train.speed = 300.0 / 3.6;
  scene.track.length_before = 36.0;
  scene.track.length_after = 40.0;
  scene.integration.duration = 0.08;
  VsiModel model = build_model(scene);
  model.irregularity = hump();
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  int known = 0, looked_for = 0;
  std::size_t most = 0;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    const LinearMotion& motion = now.structure.whole();
    LinearMotion unknown = motion;
    unknown.loaded.reset();
    const DofRange all{0, motion.displacement.size()};
    std::vector<int> loaded, said;
    find_loaded(unknown, all, loaded);
    find_loaded(motion, all, said);
    ++(motion.loaded ? known : looked_for);
    most = std::max(most, said.size());
    std::sort(said.begin(), said.end());
    EXPECT_TRUE(std::includes(said.begin(), said.end(), loaded.begin(), loaded.end())) << now.time;
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 1, state, observer).complete);
  std::printf("loads of the structure: known after %d steps, looked for after %d\n", known, looked_for);
  EXPECT_GT(known, 40);
  EXPECT_GT(looked_for, 2) << "contacts that keep their energy load what they have left";
  EXPECT_LT(most, static_cast<std::size_t>(24 * 2 * model.wheelsets()));
}

// Checkpoints in flight, in an impact, and while its forces still keep their energy: from each the run goes on to the
// last bit.
TEST(Impact, ARunResumedFromAnImpactIsTheUninterruptedOne) {
  const VsiModel model = bouncing_mass();
  const int z = model.vehicle.dof[1][2];
  VsiState state(model);
  state.vehicle[0].displacement[z] = touch_height(model) - 1e-3;
  IntegrationParameters integration;
  integration.reinitialise_every = 7;
  std::vector<std::pair<long, std::vector<double>>> checkpoints;
  RunObserver observer;
  observer.checkpoint = [&](long step, std::span<const double> numbers) {
    checkpoints.emplace_back(step, std::vector<double>(numbers.begin(), numbers.end()));
  };
  constexpr double duration = 0.12;
  ASSERT_TRUE(simulate(model, integration, duration, 1, state, observer).complete);
  const std::vector<double> end = packed(state);
  int in_impact = 0;
  observer.checkpoint = [](long, std::span<const double>) {};
  for (const auto& [step, numbers] : checkpoints) {
    VsiState resumed(model);
    unpack(numbers, resumed);
    in_impact += resumed.time < resumed.energy_until ? 1 : 0;
    static_cast<void>(simulate(model, integration, duration, 1, resumed, observer));
    EXPECT_EQ(packed(resumed), end) << "from step " << step;
  }
  std::printf("%zu checkpoints, %d of them while contacts keep their energy\n", checkpoints.size(), in_impact);
  EXPECT_GT(in_impact, 5);
  EXPECT_LT(in_impact, static_cast<int>(checkpoints.size()) - 2);
}

// Rolling over rough track without impacts, from before t = 0 on as runs do: no step takes the other rule.
TEST(Impact, WithoutOneTheRuleIsThatOfTheEnd) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.track.length_before = 30.0;
  scene.track.length_after = 20.0;
  scene.spectrum = SpectrumParameters{.fade_in = 0.0};
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 0.03;
  const VsiModel model = build_model(scene);
  VsiState state(model);
  state.time = -0.03;
  ASSERT_TRUE(steady_start(model, state).converged);
  ASSERT_TRUE(simulate(model, scene.integration, 0.03, 1, state, {}).complete);
  EXPECT_EQ(state.energy_until, std::numeric_limits<double>::lowest());
}

// The account of a run against the energies of the flights.
TEST(Impact, EnergyAccountFindsWhatTheImpactsMade) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    const Bouncing b = bounce(rule, 0.0, 1e-3, 5e-3, 8);
    std::printf("%s: gain by the account %+.4f J, of it in the contacts %+.4f J; by the flights %+.4f J\n",
                rule == ContactForceRule::energy ? "energy" : "endpoint", b.balance.gain(), b.balance.contact_gain,
                b.total);
    EXPECT_NEAR(b.balance.gain(), b.total, 1e-6 * b.balance.energy());
    EXPECT_NEAR(b.balance.contact_gain, b.total, 1e-6 * b.balance.energy());
    if (rule == ContactForceRule::energy) {
      EXPECT_NEAR(b.balance.stiffness_work, b.total, 1e-6 * b.balance.energy());
    }
    EXPECT_EQ(b.contacts.gain, b.balance.contact_gain);
    EXPECT_EQ(b.contacts.stiffness_work, b.balance.stiffness_work);
    EXPECT_EQ(b.contacts.impacts, 8);
    std::printf("  most in an impact by the summary %+.4f J of %.2f J, by the flights %+.4f J; in a step %+.4f J\n",
                b.contacts.largest_impact, b.contacts.largest_impact_stored, b.most_made, b.contacts.largest_step);
    EXPECT_NEAR(b.contacts.largest_impact, b.most_made, 1e-6 * b.balance.energy());
    // The springs take up what the mass falls with, and what it falls further while they yield or has gained before;
    // less by what it has lost before.
    const double fall = 11000.0 * 9.81 * 5e-3;
    const double before = std::abs(b.total) + std::abs(b.most_made);
    EXPECT_GT(b.contacts.largest_impact_stored, 0.99 * (fall - before));
    EXPECT_LT(b.contacts.largest_impact_stored, 1.1 * fall);
    EXPECT_EQ(b.balance.dissipated, 0.0);
    EXPECT_EQ(b.balance.traction_work, 0.0);
  }
}

}  // namespace
}  // namespace railtab::hunting
