// A sprung mass that crosses a simple beam, against a semi-analytic solution [YangYau1997].

#include <gtest/gtest.h>

#include <cmath>

#include "../reference_table.hpp"
#include "beam_crossing.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"

namespace railtab {
namespace {

using testing::crossed_length;
using testing::CrossingHistory;
using testing::largest;
using testing::largest_difference;

constexpr double speed = 100.0 / 3.6;

struct Idealisation {
  int elements;
  double wheelset_mass;  // kg
  double E;              // of the contact [Pa]
};
// A wheelset that is light (1 kg against 5750 kg) on a contact so stiff that its compression varies by less than 1e-8 m
// stands for the reference's massless rigid wheel.
constexpr Idealisation as_reference{50, 1.0, 2.1e13};
// For the order in the time step: few elements, a heavier wheelset and a softer contact, so that the steps resolve
// every frequency of the model (what a step does not resolve does not converge with its order yet).
constexpr Idealisation resolvable{2, 200.0, 2.1e10};

// One sprung mass on a wheelset that is held in all but z.
VsiModel sprung_mass_on_beam(const Idealisation& ideal) {
  VsiModel model;
  const std::vector<RigidBody> bodies{{"mass", 5750.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}},
                                      {"wheelset", ideal.wheelset_mass, {1.0, 1.0, 1.0}, {0.0, 0.0, -0.46}}};
  const std::vector<Suspension> suspension{{0, 1, {0.0, 0.0, -0.7}, {0.0, 0.0, 1595e3}, {0.0, 0.0, 0.0}}};
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle({"sprung mass", bodies, suspension, {1}, {all_but_z, all_but_z}, 0.46, 10.0});
  model.vehicle_x = {0.0};
  model.structure = share(build_simple_beam(
      {.length = crossed_length, .E = 2.87e9, .I = 2.90, .mass = 2303.0, .elements = ideal.elements}));
  model.geometry = std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
  model.contact.geometry = model.geometry.get();
  model.contact.friction = 0.0;
  model.contact.speed = speed;
  model.contact.normal.material.E = ideal.E;
  return model;
}

CrossingHistory cross(const VsiModel& model, double time_step, int record_every) {
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  integration.tolerance = 1e-9;
  return testing::cross_beam(model, integration, record_every, 0);
}

TEST(SprungMassOnBeam, FollowsTheSemiAnalyticSolution) {
  auto reference = testing::read_reference("sprung_mass_on_beam.csv");
  const CrossingHistory h = cross(sprung_mass_on_beam(as_reference), 5e-4, 8);
  const double u = largest_difference(h.u_mid, reference["u_mid"]) / largest(reference["u_mid"]);
  const double a = largest_difference(h.a_sprung, reference["a_sprung"]) / largest(reference["a_sprung"]);
  std::printf("midspan displacement: %.4f %% of the peak; sprung-mass acceleration: %.4f %% of the peak\n", 100 * u,
              100 * a);
  EXPECT_LT(u, 1e-3);
  EXPECT_LT(a, 5e-3);
}

TEST(SprungMassOnBeam, ConvergesWithSecondOrderInTheTimeStep) {
  const VsiModel model = sprung_mass_on_beam(resolvable);
  const CrossingHistory coarse = cross(model, 1e-4, 10);
  const CrossingHistory medium = cross(model, 5e-5, 20);
  const CrossingHistory fine = cross(model, 2.5e-5, 40);
  const double order_u =
      std::log2(largest_difference(coarse.u_mid, medium.u_mid) / largest_difference(medium.u_mid, fine.u_mid));
  const double order_a = std::log2(largest_difference(coarse.a_sprung, medium.a_sprung) /
                                   largest_difference(medium.a_sprung, fine.a_sprung));
  std::printf("observed order: displacement %.3f, acceleration of the sprung mass %.3f\n", order_u, order_a);
  EXPECT_NEAR(order_u, 2.0, 0.05);
  EXPECT_NEAR(order_a, 2.0, 0.05);
}

}  // namespace
}  // namespace railtab
