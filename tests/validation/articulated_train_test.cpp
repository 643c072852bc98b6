// An articulated train of ten vehicles on shared bogies (docs/examples/articulated) crosses a span of 20 m at
// resonance, against an own two-dimensional model (tests/reference/articulated_train.py) and against its axle loads as
// moving forces.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "railtab/runtime/moving_load/train_passage.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/vehicle/consist.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double span = 20.0, EI = 9.7e9, mass = 15e3;  // m, N m², kg/m
constexpr double bogie_distance = 18.7;                 // m

double resonance_speed() { return bogie_distance * std::numbers::pi / 2.0 / (span * span) * std::sqrt(EI / mass); }

VsiModel train_on_beam() {
  const std::string folder = RAILTAB_SOURCE_DIR "/docs/examples/articulated/";
  const std::vector<ConsistVehicle> train = read_consist({{folder + "power-car.toml", 1, false},
                                                          {folder + "end-coach.toml", 1, false},
                                                          {folder + "coach.toml", 6, false},
                                                          {folder + "end-coach.toml", 1, true},
                                                          {folder + "power-car.toml", 1, true}},
                                                         {});
  VsiModel model;
  model.vehicle = build_consist(train, MotionPlane::vertical, {standard_gravity, GeometricStiffness::omitted},
                                ForceElementChoice::linear);
  model.vehicle_x = {-model.vehicle.bodies[static_cast<std::size_t>(model.vehicle.wheelsets[0])].position.x()};
  model.normal_contact = NormalContact::rigid;
  model.contact.speed = resonance_speed();
  model.structure = share(build_simple_beam({.length = span, .E = EI, .I = 1.0, .mass = mass, .elements = 16}));
  return model;
}

double largest(const std::vector<double>& v) {
  double m = 0.0;
  for (const double x : v) m = std::max(m, std::abs(x));
  return m;
}

// Root mean square of the difference over that of the reference.
double difference(const std::vector<double>& found, const std::vector<double>& reference) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < std::min(found.size(), reference.size()); ++i) {
    error += std::pow(found[i] - reference[i], 2);
    size += std::pow(reference[i], 2);
  }
  return std::sqrt(error / size);
}

TEST(ArticulatedTrain, CrossesABeamAtResonanceAsTheOwnModelDoes) {
  const VsiModel model = train_on_beam();
  auto reference = testing::read_reference("articulated_train.csv");
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  std::vector<std::size_t> cars;
  for (std::size_t b = 0; b < model.vehicle.bodies.size(); ++b) {
    if (model.vehicle.bodies[b].name == "car-body") cars.push_back(b);
  }
  ASSERT_EQ(cars.size(), 10U);
  std::vector<double> u, first, fifth;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    u.push_back(record.nodes.at(0).displacement[2]);
    first.push_back(record.bodies.at(cars[0]).acceleration[2]);
    fifth.push_back(record.bodies.at(cars[4]).acceleration[2]);
  };
  IntegrationParameters integration;
  integration.time_step = 1e-3;
  integration.alpha = 0.0;
  const std::size_t points = reference["t"].size();
  ASSERT_TRUE(simulate(model, integration, reference["t"].back(), 8, state, observer).complete);
  ASSERT_EQ(u.size(), points);

  const double of_u = difference(u, reference["u_mid"]), of_first = difference(first, reference["a_first"]),
               of_fifth = difference(fifth, reference["a_fifth"]);
  const double peak = largest(u) / largest(reference["u_mid"]) - 1.0;
  const double reduction = 1.0 - largest(u) / largest(reference["u_mid_forces"]);
  std::printf(
      "rms difference: midspan %.4f %%, car bodies %.3f %% and %.3f %%; peak %+.4f %%; below moving forces by "
      "%.2f %%\n",
      100 * of_u, 100 * of_first, 100 * of_fifth, 100 * peak, 100 * reduction);
  testing::measured("articulated.midspan_rms", 100 * of_u);
  testing::measured("articulated.peak", 100 * peak);
  testing::measured("articulated.below_moving_forces", 100 * reduction);
  EXPECT_LT(of_u, 2e-3);
  EXPECT_LT(of_first, 2e-3);
  EXPECT_LT(of_fifth, 2e-3);
  EXPECT_LT(std::abs(peak), 1e-3);
  // at resonance the vehicles take energy out of the deck
  EXPECT_GT(reduction, 0.05);
  EXPECT_LT(reduction, 0.30);
}

TEST(ArticulatedTrain, AsMovingForcesIsThatOfTheOwnModel) {
  const VsiModel model = train_on_beam();
  AxleTrain axles;
  axles.name = "articulated train";
  for (int w = 0; w < model.wheelsets(); ++w) {
    axles.behind.push_back(model.wheelset_x(0, 0.0) - model.wheelset_x(w, 0.0));
    axles.load.push_back(2.0 * static_wheel_load(model.vehicle, w));
  }
  BridgeParameters bridge;
  bridge.length = span;
  bridge.mass = mass;
  bridge.E = EI;
  bridge.Iy = 1.0;
  bridge.damping_ratio = 0.0;
  const ModalDeck deck = simply_supported_deck(bridge);
  const PassagePeaks peaks = train_passage(deck, modal_force(deck, axles), resonance_speed());
  auto reference = testing::read_reference("articulated_train.csv");
  const double expected = largest(reference["u_mid_forces"]);  // at midspan, between its steps of 8 ms
  std::printf("largest displacement %.6e m, own model %.6e m\n", peaks.displacement.value, expected);
  EXPECT_NEAR(peaks.displacement.value / expected, 1.0, 1e-3);
}

}  // namespace
}  // namespace railtab
