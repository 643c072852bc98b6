// Trains of unlike vehicles on shared bogies (docs/examples/articulated) with contact forces on every wheel: static
// loads, equilibrium under wind, and a train that is turned.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "../folder_fixture.hpp"
#include "../measured.hpp"
#include "../moments_at_rails.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

using TurnedVehicle = testing::InFolder;

constexpr double wind = 20e3;  // N on every car body, to the right

const std::filesystem::path files = std::filesystem::path(RAILTAB_SOURCE_DIR) / "docs/examples/articulated";

ConsistEntry entry(const char* vehicle, int count = 1, bool turned = false) {
  return {(files / vehicle).string(), count, turned};
}

// Eighteen wheelsets, three of the bogies shared.
std::vector<ConsistEntry> whole_train() {
  return {entry("power-car.toml"), entry("end-coach.toml"), entry("coach.toml", 2), entry("end-coach.toml", 1, true),
          entry("power-car.toml", 1, true)};
}

SceneParameters train_on_rigid_track(std::vector<ConsistEntry> consist, double force, double gust = 0.0) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.track_kind = TrackKind::rigid;
  scene.train.speed = 40.0;
  scene.train.consist = std::move(consist);
  if (force == 0.0) return scene;
  LoadParameters load;
  load.load[1] = force;
  load.gust_duration = gust;
  scene.loads.push_back(load);
  return scene;
}

VsiState at_rest(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  return state;
}

std::vector<double> wheel_loads(const VsiModel& model, const VsiState& state) {
  std::vector<double> Q;
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
    Q.push_back(state.contact.end_force[rail_unknown(wheel) + 1]);
  }
  return Q;
}

// Σ F h of a force on every car body.
double overturning_moment(const VehicleModel& vehicle, double force) {
  double moment = 0.0;
  for (const VehicleBody& body : vehicle.bodies) {
    if (body.name == "car-body") moment -= force * body.position.z();
  }
  return moment;
}

// Every car body stands by halves on the bogies at its ends, every bogie on its two wheelsets. Rolling moves a few
// newtons between the two.
TEST(ConsistOnContacts, WheelLoadsAreThoseOfTheMasses) {
  const VsiModel model = build_model(train_on_rigid_track(whole_train(), 0.0));
  constexpr double power = 54e3, end = 28e3, coach = 26e3, bogie = 3e3, wheelset = 2e3;  // kg
  const double bogies[] = {power / 2,         power / 2, end / 2,   (end + coach) / 2, coach,
                           (coach + end) / 2, end / 2,   power / 2, power / 2};
  const std::vector<double> Q = wheel_loads(model, at_rest(model));
  ASSERT_EQ(Q.size(), 36U);
  double worst = 0.0;
  for (std::size_t wheel = 0; wheel < Q.size(); ++wheel) {
    const double expected = standard_gravity * ((bogies[wheel / 4] + bogie) / 2 + wheelset) / 2;
    worst = std::max(worst, std::abs(Q[wheel] / expected - 1.0));
    EXPECT_NEAR(static_wheel_load(model.vehicle, static_cast<int>(wheel / 2)), expected, 1e-9 * expected) << wheel;
  }
  std::printf("articulated train: static wheel loads within %.1e of the masses\n", worst);
  testing::measured("articulated.static_ppm", 1e6 * worst);
  EXPECT_LT(worst, 1e-4);
}

TEST(ConsistOnContacts, MomentsBalanceUnderConstantWind) {
  const VsiModel model = build_model(train_on_rigid_track(whole_train(), wind));
  const VsiState state = at_rest(model);
  const double leaning = testing::moment_of_weights(model, state);
  const double expected = overturning_moment(model.vehicle, wind) + leaning;
  const double percent = 100 * (testing::moment_at_rails(model, state) / expected - 1);
  std::printf("articulated train under wind: moment %.1f kN m, of it leaning %.1f, %.4f %% off\n", 1e-3 * expected,
              1e-3 * leaning, percent);
  testing::measured("articulated.wind_percent", percent);
  EXPECT_GT(leaning, 0.1 * expected);
  EXPECT_LT(std::abs(percent), 0.5);
}

TEST(ConsistOnContacts, MomentsBalanceInAGust) {
  constexpr double gust = 2.0;
  const VsiModel model = build_model(train_on_rigid_track(whole_train(), wind, gust));
  VsiState state = at_rest(model);
  const double overturning = overturning_moment(model.vehicle, wind);
  double off = 0.0, largest = 0.0, smallest_Q = 1e9;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    const double share = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * now.time / gust));
    const double expected =
        share * overturning + testing::moment_of_weights(model, now) + testing::moment_of_inertia_forces(model, now);
    const double found = testing::moment_at_rails(model, now);
    off = std::max(off, std::abs(found - expected));
    largest = std::max(largest, std::abs(found));
    for (const double Q : wheel_loads(model, now)) smallest_Q = std::min(smallest_Q, Q);
  };
  IntegrationParameters integration;
  integration.time_step = 1e-3;
  const RunSummary summary = simulate(model, integration, gust, 10000, state, observer);
  ASSERT_TRUE(summary.complete) << summary.message;
  std::printf("articulated train in a gust: moment to %.1f kN m, %.3f %% off, wheels down to %.1f kN\n", 1e-3 * largest,
              100 * off / largest, 1e-3 * smallest_Q);
  testing::measured("articulated.gust_percent", 100 * off / largest);
  EXPECT_LT(off, 5e-3 * largest);
}

// A bogie's wheels of each side, in the order of wheel_loads().
std::vector<double> bogie_sides(const std::vector<double>& Q) {
  std::vector<double> sums;
  for (std::size_t wheel = 0; wheel + 3 < Q.size(); wheel += 4) {
    sums.push_back(Q[wheel] + Q[wheel + 2]);
    sums.push_back(Q[wheel + 1] + Q[wheel + 3]);
  }
  return sums;
}

// A train listed from its other end, every vehicle turned, in wind from its other side: bogies carry what they did, in
// the opposite order. Their wheelsets share it otherwise, since creep forces steer the leading one.
TEST(ConsistOnContacts, AReversedTrainCarriesTheSameLoadsFromTheRear) {
  const std::vector<ConsistEntry> train{entry("power-car.toml"), entry("end-coach.toml"), entry("coach.toml"),
                                        entry("end-coach.toml", 1, true)};
  const std::vector<ConsistEntry> turned{entry("end-coach.toml"), entry("coach.toml", 1, true),
                                         entry("end-coach.toml", 1, true), entry("power-car.toml", 1, true)};
  const auto largest_difference = [&](double force) {
    const VsiModel forward = build_model(train_on_rigid_track(train, force));
    const VsiModel backward = build_model(train_on_rigid_track(turned, -force));
    const std::vector<double> Q = bogie_sides(wheel_loads(forward, at_rest(forward)));
    std::vector<double> same = bogie_sides(wheel_loads(backward, at_rest(backward)));
    std::reverse(same.begin(), same.end());
    EXPECT_EQ(Q.size(), 12U);
    double worst = 0.0;
    for (std::size_t i = 0; i < Q.size(); ++i) worst = std::max(worst, std::abs(Q[i] / same[i] - 1.0));
    return worst;
  };
  const double at_rest_only = largest_difference(0.0), in_wind = largest_difference(wind);
  std::printf("reversed train: sides of bogies within %.1e, in wind %.1e\n", at_rest_only, in_wind);
  testing::measured("articulated.reversed_percent", 100 * in_wind);
  EXPECT_LT(at_rest_only, 1e-4);
  EXPECT_LT(in_wind, 1e-3);
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

// An end coach whose file is written the other way round is the one that the train turns: in a gust, the same motion.
TEST_F(TurnedVehicle, RunsAsItsFileWrittenTheOtherWayRound) {
  for (const char* file : {"power-car.toml", "coupler.toml", "coach.toml", "jacobs-bogie.toml"}) {
    std::filesystem::copy_file(files / file, folder_ / file);
  }
  std::string rear = text_of(files / "end-coach.toml");
  replace(rear, "x = -1.5725", "x = 1.5725");
  replace(rear, "x = 7.7775", "x = -7.7775");
  replace(rear, "x = [9.2775, 6.2775]", "x = [-6.2775, -9.2775]");
  replace(rear, "joint_front = \"coupler.toml\"", "joint_rear = \"coupler.toml\"");
  replace(rear, "joint_rear = \"jacobs-bogie.toml\"", "joint_front = \"jacobs-bogie.toml\"");
  write("rear-coach.toml", rear);
  write("end-coach.toml", text_of(files / "end-coach.toml"));
  const auto run = [&](const ConsistEntry& last) {
    const std::vector<ConsistEntry> train{
        {(folder_ / "power-car.toml").string(), 1, false}, {(folder_ / "end-coach.toml").string(), 1, false}, last};
    const VsiModel model = build_model(train_on_rigid_track(train, wind, 0.5));
    VsiState state = at_rest(model);
    IntegrationParameters integration;
    integration.tolerance = 1e-7;
    EXPECT_TRUE(simulate(model, integration, 0.5, 1000, state, {}).complete);
    return wheel_loads(model, state);
  };
  const std::vector<double> turned = run({(folder_ / "end-coach.toml").string(), 1, true});
  const std::vector<double> written = run({(folder_ / "rear-coach.toml").string(), 1, false});
  ASSERT_EQ(turned.size(), written.size());
  for (std::size_t wheel = 0; wheel < turned.size(); ++wheel) {
    EXPECT_NEAR(turned[wheel], written[wheel], 1e-3) << wheel;  // N
  }
  EXPECT_GT(std::abs(turned[2 * 8] - turned[2 * 8 + 1]), 100.0);
}

}  // namespace
}  // namespace railtab
