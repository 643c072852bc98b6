// Coaches with bump stops, dampers with blow-off and dry friction in runs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../measured.hpp"
#include "../moments_at_rails.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double gust_peak = 60e3, gust_time = 1.0;  // N on the car body to the right, s

/// A vehicle of the library on rigid track, met by a gust of 1 s from t = 0.1 s.
SceneParameters coach_in_gust(const std::string& vehicle, double radius, double peak = gust_peak) {
  SceneParameters scene;
  scene.train.vehicle = vehicle;
  scene.train.speed = 40.0;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.contact.dimensions.nominal_radius = radius;
  scene.track_kind = TrackKind::rigid;
  LoadParameters load;
  load.load[1] = peak;
  load.start = 0.1;
  load.gust_duration = gust_time;
  scene.loads.push_back(load);
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 1.2;
  return scene;
}

struct CoachRun {
  RunSummary summary;
  std::vector<double> y, time;    // lateral displacement of the car body at every record [m], [s]
  std::vector<double> mobilised;  // of every friction element the largest share of its limit
  std::vector<double> state;      // at the end
  EnergyBalance energy;
};

VsiState at_rest(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  return state;
}

CoachRun run(const VsiModel& model, const IntegrationParameters& integration, double duration, int every) {
  VsiState state = at_rest(model);
  CoachRun result;
  RunObserver observer;
  observer.energy = [&](const EnergyBalance& balance) { result.energy = balance; };
  const ForceElements& elements = model.vehicle.elements;
  result.mobilised.resize(elements.element.size());
  observer.record = [&](StepRecord& record) {
    result.y.push_back(record.bodies[0].displacement[1]);
    result.time.push_back(record.time);
    if (elements.empty()) return;
    const Eigen::VectorXd x = elements.rows * state.vehicle[0].displacement;
    for (std::size_t e = 0; e < elements.element.size(); ++e) {
      if (elements.element[e].kind != ForceElementKind::friction) continue;
      const double force = std::abs(state.friction[0][static_cast<Eigen::Index>(e)]);
      result.mobilised[e] = std::max(result.mobilised[e], force / elements.element[e].limit(x).force);
    }
  };
  result.summary = simulate(model, integration, duration, every, state, observer);
  EXPECT_TRUE(result.summary.complete) << result.summary.message;
  result.state = packed(state);
  return result;
}

const char* const all_elements = RAILTAB_SOURCE_DIR "/tests/reference/coach_with_all_elements.toml";

struct OrderCase {
  const char* name;  // of the measured numbers
  std::string vehicle;
  ContactForceRule rule;
};
class OrderInTheStep : public ::testing::TestWithParam<OrderCase> {};

// Stops, yaw and lateral dampers with blow-off in series, and those with side bearers and wedges: differences between
// steps that are halved fall by four. Second order is due with dry friction as well, since its force does not jump: it
// reverses over an elastic travel, and a reversal within a step leaves an error of k_f·O(Δt²).
TEST_P(OrderInTheStep, IsTwo) {
  const OrderCase& of = GetParam();
  const SceneParameters scene = coach_in_gust(of.vehicle, 0.4575);
  const VsiModel model = build_model(scene);
  std::vector<CoachRun> runs;
  for (const int parts : {1, 2, 4}) {
    IntegrationParameters integration = scene.integration;
    integration.contact_force = of.rule;
    integration.time_step = 2e-3 / parts;
    integration.tolerance = 1e-8;
    runs.push_back(run(model, integration, 0.9, parts));
  }
  ASSERT_TRUE(runs.back().summary.stops.has_value());
  double difference[2] = {}, largest = 0.0;
  for (std::size_t i = 0; i < runs[0].y.size(); ++i) {
    largest = std::max(largest, std::abs(runs[2].y[i]));
    for (std::size_t r = 0; r < 2; ++r)
      difference[r] = std::max(difference[r], std::abs(runs[r].y[i] - runs[r + 1].y[i]));
  }
  const double order = std::log2(difference[0] / difference[1]);
  std::printf("%s: y to %.1f mm, differences %.2e and %.2e m, order %.2f\n", of.name, 1e3 * largest, difference[0],
              difference[1], order);
  testing::measured(std::string("force_elements.") + of.name + ".order", order);
  testing::measured(std::string("force_elements.") + of.name + ".step_error_um", 1e6 * difference[1]);
  EXPECT_GT(order, 1.7);
  EXPECT_LT(order, 2.4);
  // every friction element slides
  for (std::size_t e = 0; e < model.vehicle.elements.element.size(); ++e) {
    const ForceElement& element = model.vehicle.elements.element[e];
    if (element.kind != ForceElementKind::friction) continue;
    EXPECT_GT(runs[2].mobilised[e], 0.999) << element.name;
  }
}

INSTANTIATE_TEST_SUITE_P(ForceElements, OrderInTheStep,
                         ::testing::Values(OrderCase{"emu", "chinese-emu-car", ContactForceRule::endpoint},
                                           OrderCase{"all", all_elements, ContactForceRule::endpoint},
                                           OrderCase{"all_energy", all_elements, ContactForceRule::energy}));

// A run that is resumed from the numbers of a checkpoint is the uninterrupted one to the last bit, stops engaged and
// wedges sliding.
TEST(ForceElements, ResumeFromACheckpointToTheLastBit) {
  for (const auto& [vehicle, radius] : {std::pair("chinese-emu-car", 0.4575), std::pair("freight-21t", 0.42)}) {
    const SceneParameters scene = coach_in_gust(vehicle, radius);
    const VsiModel model = build_model(scene);
    IntegrationParameters integration = scene.integration;
    integration.reinitialise_every = 250;
    VsiState state = at_rest(model);
    std::vector<double> checkpoint;
    RunObserver observer;
    observer.checkpoint = [&](long step, std::span<const double> numbers) {
      if (step == 500) checkpoint.assign(numbers.begin(), numbers.end());
    };
    ASSERT_TRUE(simulate(model, integration, 0.6, 1000, state, observer).complete);
    VsiState resumed(model);
    unpack(checkpoint, resumed);
    ASSERT_TRUE(simulate(model, integration, 0.6, 1000, resumed, {}).complete);
    EXPECT_EQ(packed(resumed), packed(state)) << vehicle;
    double friction = 0.0;
    for (const Eigen::VectorXd& forces : state.friction) friction = std::max(friction, forces.cwiseAbs().maxCoeff());
    EXPECT_TRUE(state.stops.first.found() || friction > 1e3) << vehicle;
  }
}

// The moment at which the car body has moved aside by the free travel is the one that the summary has.
TEST(ForceElements, ManchesterCoachReachesItsLateralStop) {
  const SceneParameters scene = coach_in_gust("manchester-coach", 0.46, 60e3);
  const VsiModel model = build_model(scene);
  VsiState state = at_rest(model);
  constexpr double free_travel = 0.025;
  double reached = -1.0, furthest = 0.0;
  RunObserver observer;
  const Eigen::MatrixXd& rows = model.vehicle.elements.rows;
  observer.record = [&](StepRecord& record) {
    const double x = (rows * state.vehicle[0].displacement).cwiseAbs().maxCoeff();
    furthest = std::max(furthest, x);
    if (reached < 0.0 && x > free_travel) reached = record.time;
  };
  const RunSummary summary = simulate(model, scene.integration, 1.2, 1, state, observer);
  ASSERT_TRUE(summary.complete) << summary.message;
  ASSERT_TRUE(summary.stops.has_value());
  std::printf("Manchester coach: lateral stop engaged at t = %.3f s, travel to %.1f mm, %.2f kN (%s)\n",
              summary.stops->first_time, 1e3 * furthest, 1e-3 * summary.stops->largest_force,
              summary.stops->largest_name.c_str());
  EXPECT_EQ(summary.stops->first_time, reached);
  EXPECT_NE(summary.stops->first_name.find("coach-1: secondary suspension along y, bogie-"), std::string::npos);
  EXPECT_NEAR(summary.stops->largest_force, model.vehicle.elements.element[0].curve.at(furthest).force, 1e-6);

  // without them it goes farther
  SceneParameters linear = scene;
  linear.train.force_elements = ForceElementChoice::linear;
  const VsiModel without = build_model(linear);
  EXPECT_TRUE(without.vehicle.elements.empty());
  const CoachRun far = run(without, scene.integration, 1.2, 1);
  const CoachRun near = run(model, scene.integration, 1.2, 1);
  EXPECT_GT(*std::max_element(far.y.begin(), far.y.end()), 1.05 * *std::max_element(near.y.begin(), near.y.end()));
  EXPECT_FALSE(far.summary.stops.has_value());
}

// A stop that nothing reaches changes nothing, not even the last bit.
TEST(ForceElements, StopsThatAreNotReachedChangeNothing) {
  SceneParameters scene = coach_in_gust("manchester-coach", 0.46, 5e3);
  const VsiModel with = build_model(scene);
  EXPECT_EQ(with.vehicle.elements.element.size(), 4U);
  scene.train.force_elements = ForceElementChoice::linear;
  const VsiModel without = build_model(scene);
  EXPECT_EQ(run(with, scene.integration, 0.3, 1).y, run(without, scene.integration, 0.3, 1).y);
}

// A constant wind that leans the coach on its stops: equilibrium of the moments about the rails, and the elongations of
// the stops carry what the springs do not.
TEST(ForceElements, RestOnTheStops) {
  SceneParameters scene = coach_in_gust("manchester-coach", 0.46, 35e3);
  scene.loads[0].gust_duration = 0.0;
  scene.loads[0].start = 0.0;
  const VsiModel model = build_model(scene);
  const VsiState state = at_rest(model);
  const ForceElements& elements = model.vehicle.elements;
  const Eigen::VectorXd x = elements.rows * state.vehicle[0].displacement;
  ASSERT_GT(x.cwiseAbs().minCoeff(), 0.025);
  const Eigen::VectorXd force = elements.force(x, 0.0 * x, state.friction[0]);
  // K u = contact forces + weight + wind − rowsᵀ f
  Eigen::VectorXd residual = model.vehicle.stiffness * state.vehicle[0].displacement - state.vehicle[0].contact_load -
                             model.vehicle.static_load;
  residual[model.vehicle.dof[0][1]] -= 35e3;
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_GT(std::abs(force.sum()), 1e3);
}

// The moment of the wheel loads about the rails, with the stops engaged, is that of the wind and of the weights that
// have moved aside.
TEST(ForceElements, MomentsBalanceOnTheStops) {
  SceneParameters scene = coach_in_gust("manchester-coach", 0.46, 35e3);
  scene.loads[0].gust_duration = 0.0;
  scene.loads[0].start = 0.0;
  const VsiModel model = build_model(scene);
  const VsiState state = at_rest(model);
  const double moment = testing::moment_at_rails(model, state), weights = testing::moment_of_weights(model, state);
  const double expected = 35e3 * 1.8 + weights;
  EXPECT_GT(weights, 0.2 * expected);
  std::printf("moments on the stops: %.3f %% off\n", 100.0 * (moment / expected - 1.0));
  EXPECT_NEAR(moment, expected, 1e-3 * expected);
}

// A freight wagon with wedges whose wheels follow the rails: the car body moves as on Hertz's contacts, which add
// little. Steps converge with order two once they are short beside the reversals of the friction.
TEST(ForceElements, WedgesWithWheelsThatFollowTheRails) {
  SceneParameters scene = coach_in_gust("freight-21t", 0.42);
  scene.loads[0].load = {};
  scene.loads[0].load[2] = 200e3;
  scene.loads[0].gust_duration = 0.4;
  scene.contact.dimensions.nominal_radius = 0.42;
  const auto heave = [&](NormalContact normal, double time_step) {
    scene.contact.normal = normal;
    const VsiModel model = build_model(scene);
    EXPECT_FALSE(model.vehicle.elements.empty());
    VsiState state = at_rest(model);
    std::vector<double> z;
    RunObserver observer;
    observer.record = [&](StepRecord& record) { z.push_back(record.bodies[0].displacement[2] * 1e3); };
    IntegrationParameters integration = scene.integration;
    integration.time_step = time_step;
    integration.tolerance = 1e-8;
    const int every = static_cast<int>(std::lround(1e-3 / time_step));
    EXPECT_TRUE(simulate(model, integration, 0.8, every, state, observer).complete);
    return z;
  };
  const auto difference = [](const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs((a[i] - a[0]) - (b[i] - b[0])));
    return largest;
  };
  const std::vector<double> rigid = heave(NormalContact::rigid, 1e-3), hertz = heave(NormalContact::hertz, 1e-3);
  const std::vector<double> coarse = heave(NormalContact::rigid, 1.25e-4), fine = heave(NormalContact::rigid, 6.25e-5),
                            finest = heave(NormalContact::rigid, 3.125e-5);
  const double most = *std::max_element(rigid.begin(), rigid.end());
  const double order = std::log2(difference(coarse, fine) / difference(fine, finest));
  std::printf("wagon with wedges: z to %.2f mm, rigid wheels differ by %.3f mm, order in the step %.2f\n", most,
              difference(rigid, hertz), order);
  EXPECT_GT(most, 5.0);
  EXPECT_LT(difference(rigid, hertz), 0.02 * most);
  EXPECT_LT(difference(rigid, finest), 0.01 * most);
  EXPECT_GT(order, 1.7);
  EXPECT_LT(order, 2.4);
}

// Newmark's steps with forces that keep their energy: what stops and dampers take is accounted for. The contacts'
// share, which is known apart, is left out.
TEST(ForceElements, EnergyOfACoachIsAccountedFor) {
  for (const auto& [name, vehicle] : {std::pair<std::string, std::string>{"emu", "chinese-emu-car"},
                                      std::pair<std::string, std::string>{"all", all_elements}}) {
    const SceneParameters scene = coach_in_gust(vehicle, 0.4575);
    const VsiModel model = build_model(scene);
    IntegrationParameters integration = scene.integration;
    integration.alpha = 0.0;
    integration.contact_force = ContactForceRule::energy;
    const CoachRun r = run(model, integration, 0.9, 1);
    ASSERT_TRUE(r.summary.stops.has_value());
    const double created = r.energy.gain() - r.energy.contact_gain;
    std::printf("%s: wind brought %.1f J, %.1f J dissipated, %.2e J created besides the contacts' %.2e J\n",
                name.c_str(), r.energy.load_work, r.energy.dissipated, created, r.energy.contact_gain);
    EXPECT_GT(r.energy.load_work, 100.0);
    testing::measured("force_elements." + name + ".energy_created_ppm", 1e6 * std::abs(created) / r.energy.load_work);
    EXPECT_LT(std::abs(created), 1e-6 * r.energy.load_work);
  }
}

}  // namespace
}  // namespace railtab
