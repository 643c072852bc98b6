// Kinematic oscillation of a free wheelset on cones, against Klingel's formula.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {
namespace {

constexpr double speed = 0.5;       // m/s: inertia does not matter
constexpr double amplitude = 1e-5;  // m

enum class Roll { held, free };

// Each rail a rigid bar on a soft vertical spring. With roll held, a lateral shift on cones presses one wheel down and
// lifts the other; soft rails keep both loads equal, as Klingel's kinematics assume.
StructureModel soft_rails() {
  constexpr double stiffness = 1e6;  // N/m, against 1e9 of the contact
  StructureModel structure;
  structure.mass.resize(2, 2);
  structure.stiffness.resize(2, 2);
  structure.damping.resize(2, 2);
  for (int side = 0; side < 2; ++side) {
    structure.mass.insert(side, side) = 100.0;
    structure.stiffness.insert(side, side) = stiffness;
    RailLine& rail = structure.rail[static_cast<std::size_t>(side)];
    rail.x = {-100.0, 100.0};
    rail.dof.assign(2, {held, held, side, held, held, held});
  }
  return structure;
}

VsiModel wheelset_on_cones(Roll roll) {
  VsiModel model;
  const std::vector<RigidBody> bodies{{"wheelset", 10000.0, {800.0, 100.0, 800.0}, {0.0, 0.0, -0.46}}};
  const DofIndices held_dofs{held, 0, 0, roll == Roll::held ? held : 0, 0, 0};
  model.vehicle = assemble_vehicle({"wheelset", bodies, {}, {0}, {held_dofs}, 0.46, 10.0});
  model.vehicle_x = {0.0};
  if (roll == Roll::held) model.structure = share(soft_rails());
  model.geometry = std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
  model.contact.geometry = model.geometry.get();
  model.contact.creep_law = LinearCreep{.nu = 0.28};
  model.contact.speed = speed;
  return model;
}

// Modulus of the pole pair s of y'' - 2 Re(s) y' + |s|² y = 0 that the equally spaced samples obey (least squares on
// y[n+1] = p y[n] + q y[n-1], z = exp(s dx)).
double pole_modulus(const std::vector<double>& y, double dx) {
  const auto n = static_cast<Eigen::Index>(y.size()) - 2;
  Eigen::MatrixXd a(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    a.row(i) << y[k + 1], y[k];
    b[i] = y[k + 2];
  }
  const Eigen::Vector2d pq = least_squares_solution(a, b);
  const std::complex<double> root = std::sqrt(std::complex<double>(pq[0] * pq[0] / 4.0 + pq[1]));
  const std::complex<double> s1 = std::log(pq[0] / 2.0 + root) / dx;
  const std::complex<double> s2 = std::log(pq[0] / 2.0 - root) / dx;
  return std::sqrt(std::abs(s1 * s2));
}

struct Oscillation {
  double wavelength;  // m
  double conicity;    // half the rolling radius difference over the lateral shift
};

Oscillation measured_oscillation(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  state.vehicle[0].displacement[model.vehicle.dof[0][1]] += amplitude;
  std::vector<double> y, difference;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    y.push_back(record.bodies.at(0).displacement[1]);
    difference.push_back(record.wheels.at(1).rolling_radius - record.wheels.at(0).rolling_radius);
  };
  IntegrationParameters integration;
  integration.time_step = 0.02;
  integration.alpha = 0.0;
  integration.tolerance = 1e-9;
  const RunSummary summary = simulate(model, integration, 60.0, 25, state, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  // The start is left out: there yaw, roll and lateral motion find each other.
  y.erase(y.begin(), y.begin() + 2);
  difference.erase(difference.begin(), difference.begin() + 2);
  const auto at = static_cast<std::size_t>(std::max_element(y.begin() + 10, y.end()) - y.begin());
  return {2.0 * std::numbers::pi / pole_modulus(y, 25 * 0.02 * speed), difference[at] / (2.0 * y[at])};
}

struct ConeContact {
  double gamma, L, r0, rail_radius;  // contact angle, half contact distance, rolling radius, rail crown radius
};

ConeContact contact_at_rest(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  const ContactPatch& patch = state.contact.contact.at(1).patches.patch[0];
  return {std::tan(-patch.angle), model.geometry->pair().rail_offset() + patch.y_rail, patch.rolling_radius,
          1.0 / patch.curv_rail};
}

// |s|² of the linear kinematic equations is gamma_e/(r0 L), whatever lateral stiffness the contact normals add:
// Klingel's wavelength is 2π/|s|.
TEST(Klingel, WavelengthWithRollHeld) {
  const VsiModel model = wheelset_on_cones(Roll::held);
  const ConeContact c = contact_at_rest(model);
  const double klingel = 2.0 * std::numbers::pi * std::sqrt(c.r0 * c.L / c.gamma);
  const double measured = measured_oscillation(model).wavelength;
  std::printf("roll held: %.5f m, Klingel %.5f m, difference %.4f %%\n", measured, klingel,
              100 * (measured / klingel - 1));
  EXPECT_NEAR(measured / klingel, 1.0, 1e-3);
}

// With roll free the wheelset rolls by phi = -y gamma/(L - r0 gamma) as it shifts. Its treads then move sideways by
// y - r0 phi, not by y: it is there that lateral creepage is to vanish, so that the square of Klingel's wavelength with
// the equivalent conicity (which counts in y) grows by 1 + r0 gamma/(L - r0 gamma).
TEST(Klingel, WavelengthWithRollFree) {
  const VsiModel model = wheelset_on_cones(Roll::free);
  const ConeContact c = contact_at_rest(model);
  const double equivalent = c.gamma * (c.L + c.rail_radius * c.gamma) / (c.L - c.r0 * c.gamma);
  const double klingel = 2.0 * std::numbers::pi * std::sqrt(c.r0 * c.L / equivalent);
  const double roll_rate = 1.0 + c.r0 * c.gamma / (c.L - c.r0 * c.gamma);
  const double with_roll_rate = klingel * std::sqrt(roll_rate);
  const auto [measured, conicity] = measured_oscillation(model);
  std::printf("roll free: %.5f m, conicity %.6f, formula %.6f, difference %.4f %%\n", measured, conicity, equivalent,
              100 * (conicity / equivalent - 1));
  std::printf("  Klingel %.5f m, difference %.4f %%; with the roll rate's part of lateral creepage %.5f m, %.4f %%\n",
              klingel, 100 * (measured / klingel - 1), with_roll_rate, 100 * (measured / with_roll_rate - 1));
  EXPECT_NEAR(conicity / equivalent, 1.0, 2e-3);
  EXPECT_NEAR(measured / with_roll_rate, 1.0, 2e-3);
}

}  // namespace
}  // namespace railtab
