// A wheelset that bounces on rails without friction or damping, with contact forces from a table of the loaded contact:
// its energy stays.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "../measured.hpp"
#include "hunting_model.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"

namespace railtab::hunting {
namespace {

/// S1002 on 60E1 1:40 in a gauge widened by 3.6 mm: the centred wheels roll where the contact does not jump.
ContactSearch wide_gauge() {
  PairDimensions dimensions;
  dimensions.track_gauge += 3.6e-3;
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                     dimensions));
}

ContactGeometry loaded_tread(const ContactSearch& search) {
  LoadedSweepOptions options;
  options.lateral = {-0.5e-3, 0.5e-3};
  options.roll = {-1e-3, 1e-3};
  options.yaw = 1e-3;
  options.roll_spacing = 0.1;
  options.yaw_nodes = 2;
  options.levels = 13;
  options.largest_load = 600e3;
  options.force_error = 2e-2;
  options.light_error = 5e-2;
  options.contact.elements.across_narrowest = 12;
  return ContactGeometry(search, std::make_shared<const LoadedTable>(sweep_loaded(search, options)));
}

TEST(LoadedBounce, KeepsItsEnergyOverAHundredThousandSteps) {
  constexpr double speed = 50.0, height = 3e-4;  // m/s, m
  constexpr int steps = 100'000;
  VsiModel model = wheelset({}, speed);
  DofIndices none;
  none.fill(held);
  model.vehicle = assemble_vehicle(
      {"bouncing mass",
       {{"frame", 1.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}}, {"mass", 11000.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}}},
       {},
       {1},
       {none, {held, held, 0, held, held, held}},
       R0,
       10.0});
  const ContactSearch search = wide_gauge();
  model.geometry = std::make_shared<const ContactGeometry>(loaded_tread(search));
  model.contact.geometry = model.geometry.get();
  model.contact.constant_ellipse.reset();
  model.contact.gravitational_stiffness = GravitationalStiffness::included;
  model.contact.friction = 0.0;
  const int z = model.vehicle.dof[1][2];
  const double mass = model.vehicle.mass(z, z), g = model.vehicle.static_load[z] / mass;

  VsiState state(model);
  const LoadedTable& table = *model.geometry->loaded();
  const double low = search.touch_height(0.0, 0.0, 0.0);
  state.vehicle[0].displacement[z] = low - height;
  state.vehicle[0].acceleration[z] = g;

  double deepest = 0.0, largest = 0.0;
  long outside = 0, landings = 0;
  bool in_air = true;
  RunObserver observer;
  observer.energy = [&](const EnergyBalance& balance) {
    largest = std::max(largest, std::abs(balance.gain()) / (mass * g * height));
  };
  observer.record = [&](const StepRecord& record) {
    const double depth = record.bodies.at(1).displacement[2] - low;
    deepest = std::max(deepest, depth);
    if (record.wheels[0].Q > 0.0 && in_air) ++landings;
    in_air = !(record.wheels[0].Q > 0.0);
    if (depth > 0.0 && table.lookup(0.0, low + depth, 0.0, 0.0).table_share < 1.0) ++outside;
  };
  IntegrationParameters integration;
  integration.time_step = 1e-4;
  integration.alpha = 0.0;
  integration.tolerance = 1e-10;  // of Newton: what it leaves would add up
  integration.contact_force = ContactForceRule::energy;
  const RunSummary run = simulate(model, integration, steps * integration.time_step, 1, state, observer);
  ASSERT_TRUE(run.complete) << run.message;
  std::printf("%d steps, %ld landings, to %.3f mm: energy changes by up to %.1e of the fall's\n", steps, landings,
              1e3 * deepest, largest);
  testing::measured("loaded.bounce", largest);
  EXPECT_EQ(outside, 0);
  EXPECT_GT(landings, 200);
  EXPECT_LT(largest, 1e-5);
}

}  // namespace
}  // namespace railtab::hunting
