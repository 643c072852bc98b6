// Loads that cross a simple beam, against closed-form and semi-analytic solutions [YangYau1997]; wheels follow the beam
// rigidly.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "../reference_table.hpp"
#include "beam_crossing.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"

namespace railtab {
namespace {

using testing::crossed_length;

constexpr double beam_mass = 2303.0;

// A wheel, and on it a sprung mass where `sprung` > 0.
struct Load {
  double wheel, sprung, stiffness, damping;
};

VsiModel load_on_beam(const Load& load, double speed) {
  VsiModel model;
  std::vector<RigidBody> bodies{{"wheelset", load.wheel, {1.0, 1.0, 1.0}, {0.0, 0.0, -0.46}}};
  std::vector<Suspension> suspension;
  const DofIndices all_but_z{held, held, 0, held, held, held};
  std::vector<DofIndices> dofs{all_but_z};
  if (load.sprung > 0.0) {
    bodies.push_back({"mass", load.sprung, {1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}});
    suspension.push_back({0, 1, {0.0, 0.0, -0.7}, {0.0, 0.0, load.stiffness}, {0.0, 0.0, load.damping}});
    dofs.push_back(all_but_z);
  }
  model.vehicle = assemble_vehicle({"load", bodies, suspension, {0}, dofs, 0.46, 10.0});
  model.vehicle_x = {0.0};
  model.structure =
      share(build_simple_beam({.length = crossed_length, .E = 2.87e9, .I = 2.90, .mass = beam_mass, .elements = 40}));
  model.contact.speed = speed;
  model.normal_contact = NormalContact::rigid;
  return model;
}

// Crosses the beam in `steps` steps.
testing::CrossingHistory cross(const VsiModel& model, long steps, int record_every) {
  IntegrationParameters integration;
  integration.time_step = crossed_length / model.contact.speed / static_cast<double>(steps);
  integration.alpha = 0.0;
  return testing::cross_beam(model, integration, record_every, model.vehicle.bodies.size() - 1);
}

// Largest difference, of the reference's largest value, without the last point: there the load leaves the beam.
double difference(const std::vector<double>& a, const std::vector<double>& reference) {
  return testing::largest_difference(a, reference, 1) / testing::largest(reference);
}

// A mass on a spring of 1 N/m and a wheel of 1 g: its weight, but for 2 mN.
TEST(MovingLoad, Force) {
  auto reference = testing::read_reference("moving_force_on_beam.csv");
  const VsiModel model = load_on_beam({1e-3, 56407.5 / 9.81, 1.0, 0.0}, 100.0 / 3.6);
  const testing::CrossingHistory h = cross(model, 3600, 36);
  const double u = difference(h.u_mid, reference["u_mid"]);
  std::printf("moving force: midspan displacement %.4f %% of the peak\n", 100 * u);
  EXPECT_LT(u, 1e-3);
}

struct MassCase {
  const char* name;
  double mass_ratio;   // of the beam
  double speed_ratio;  // of the critical speed π/L·sqrt(EI/m)
};

class MovingMass : public ::testing::TestWithParam<MassCase> {};

TEST_P(MovingMass, FollowsTheModalSolution) {
  const MassCase& c = GetParam();
  auto reference = testing::read_reference(std::string("moving_mass_") + c.name + ".csv");
  const double speed = crossed_length / reference["t"].back();
  EXPECT_NEAR(speed / (M_PI / crossed_length * std::sqrt(2.87e9 * 2.90 / beam_mass)), c.speed_ratio,
              1e-3 * c.speed_ratio);
  const VsiModel model = load_on_beam({c.mass_ratio * beam_mass * crossed_length, 0.0, 0.0, 0.0}, speed);
  const testing::CrossingHistory h = cross(model, 2000, 20);
  const double u = difference(h.u_mid, reference["u_mid"]);
  const double force = difference(h.force, reference["force"]);
  std::printf("moving mass %s: midspan displacement %.4f %%, force %.3f %% of the peak\n", c.name, 100 * u,
              100 * force);
  // The force is printed only: a sum of 40 modes gives the curvature under the mass, which it has in it, slowly.
  EXPECT_LT(u, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Cases, MovingMass,
                         ::testing::Values(MassCase{"yang_yau", 5750.0 / (beam_mass * crossed_length), 0.11628},
                                           MassCase{"half", 0.5, 0.25}, MassCase{"fifth", 0.2, 0.5}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(MovingLoad, SprungMass) {
  auto reference = testing::read_reference("sprung_mass_on_beam.csv");
  const VsiModel model = load_on_beam({1e-3, 5750.0, 1595e3, 0.0}, 100.0 / 3.6);
  const testing::CrossingHistory h = cross(model, 3600, 16);
  const double u = difference(h.u_mid, reference["u_mid"]);
  const double a = difference(h.a_sprung, reference["a_sprung"]);
  std::printf("sprung mass: midspan displacement %.4f %%, acceleration %.4f %% of the peak\n", 100 * u, 100 * a);
  EXPECT_LT(u, 1e-3);
  EXPECT_LT(a, 1e-3);
}

// The wheel enters the beam with a jump of its acceleration, which a time step cannot follow: accelerations and forces
// come closer with the first order of the step, 0.33, 0.16 and 0.09 % for 1800, 3600 and 7200 steps.
TEST(MovingLoad, SprungMassOnUnsprungMass) {
  auto reference = testing::read_reference("sprung_unsprung_mass_on_beam.csv");
  const VsiModel model = load_on_beam({500.0, 5750.0, 1595e3, 10e3}, 100.0 / 3.6);
  const testing::CrossingHistory h = cross(model, 3600, 36);
  const double u = difference(h.u_mid, reference["u_mid"]);
  const double a = difference(h.a_sprung, reference["a_sprung"]);
  std::printf(
      "sprung on unsprung mass: midspan displacement %.4f %%, acceleration %.4f %%, force %.4f %% of the peak\n",
      100 * u, 100 * a, 100 * difference(h.force, reference["force"]));
  EXPECT_LT(u, 1e-3);
  EXPECT_LT(a, 2e-3);
}

}  // namespace
}  // namespace railtab
