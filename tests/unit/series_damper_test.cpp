// Dampers in series with a stiffness (Maxwell elements) against their closed forms.
#include "railtab/runtime/vehicle/series_damper.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>

#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {
namespace {

using Complex = std::complex<double>;

constexpr double m = 1000.0, k = 4e5, c = 2e4, series = 6e5;  // 3.2 Hz, c ω about as stiff as the series spring

/// A mass above a wheelset that is held, on a spring beside a damper in series with a stiffness.
VehicleModel mass_on_series_damper(double damping = c, double series_stiffness = series, double stiffness = k) {
  VehicleDescription parts;
  parts.name = "mass";
  parts.bodies = {{"car-body", m, {100.0, 100.0, 100.0}, {0.0, 0.0, -1.0}},
                  {"wheelset-1", 100.0, {10.0, 10.0, 10.0}, {0.0, 0.0, -0.46}}};
  Suspension unit{0, 1, {0.0, 0.0, -0.46}, {0.0, 0.0, stiffness}, {0.0, 0.0, damping}};
  unit.series_stiffness = {0.0, 0.0, series_stiffness};
  parts.suspension = {unit};
  parts.wheelsets = {1};
  parts.held_dofs.assign(2, DofIndices{held, held, held, held, held, held});
  parts.held_dofs[0][2] = 0;
  return assemble_vehicle(parts);
}

TEST(SeriesDamper, HasOneRowWithoutMass) {
  const VehicleModel vehicle = mass_on_series_damper();
  ASSERT_EQ(vehicle.dofs(), 2);
  EXPECT_EQ(vehicle.mass(1, 1), 0.0);
  EXPECT_EQ(vehicle.stiffness(0, 0), k);
  EXPECT_EQ(vehicle.stiffness(0, 1), 0.0);
  EXPECT_EQ(vehicle.stiffness(1, 1), series);
  EXPECT_EQ(vehicle.static_load[1], 0.0);
}

/// Dynamic stiffness k + k_s·iωc/(k_s + iωc), the inner row condensed.
TEST(SeriesDamper, HasTheDynamicStiffnessOfAMaxwellElement) {
  const VehicleModel vehicle = mass_on_series_damper();
  for (const double omega : {1e-3, 1.0, 20.0, 30.0, 500.0, 1e6}) {
    const Complex s(0.0, omega);
    const Eigen::Matrix2cd D = vehicle.stiffness.cast<Complex>() + s * vehicle.damping.cast<Complex>();
    const Complex condensed = D(0, 0) - D(0, 1) * D(1, 0) / D(1, 1);
    const Complex closed = k + series * s * c / (series + s * c);
    EXPECT_LT(std::abs(condensed - closed), 1e-9 * std::abs(closed)) << omega;
  }
}

/// An air-spring with reservoir by the state of its gas, with the parameters that docs/theory/vehicle.md makes of it:
/// the pressures p_b = n p/V_b (A x − Q) and p_r = n p/V_r Q above that at rest, the volume Q that has passed the
/// orifice, R dQ/dt = p_b − p_r, and the force A p_b + (p − p_a) dA/dz x.
TEST(SeriesDamper, IsAnAirSpringWithReservoir) {
  constexpr double n = 1.3, p = 5e5, ambient = 1e5, area = 0.25, area_slope = 0.3;  // -, Pa, Pa, m², m
  constexpr double bellows = 0.05, reservoir = 0.04, resistance = 3e5;              // m³, m³, Pa s/m³
  constexpr double both = bellows + reservoir, share = reservoir / both;
  constexpr double stiffness = n * p * area * area / both + (p - ambient) * area_slope;
  constexpr double series_stiffness = n * p * area * area * share / bellows;
  constexpr double damping = area * area * resistance * share * share;
  const VehicleModel vehicle = mass_on_series_damper(damping, series_stiffness, stiffness);
  for (const double omega : {1e-2, 1.0, 5.0, 20.0, 200.0, 1e4}) {
    const Complex s(0.0, omega);
    Eigen::Matrix3cd gas;  // of p_b, p_r, Q per x
    gas << 1.0, 0.0, n * p / bellows, 0.0, 1.0, -n * p / reservoir, 1.0, -1.0, -resistance * s;
    const Eigen::Vector3cd per_x = gas.fullPivLu().solve(Eigen::Vector3cd(n * p / bellows * area, 0.0, 0.0));
    const Complex of_gas = area * per_x[0] + (p - ambient) * area_slope;
    const Eigen::Matrix2cd D = vehicle.stiffness.cast<Complex>() + s * vehicle.damping.cast<Complex>();
    const Complex of_element = D(0, 0) - D(0, 1) * D(1, 0) / D(1, 1);
    EXPECT_LT(std::abs(of_element - of_gas), 1e-9 * std::abs(of_gas)) << omega;
  }
}

/// Two bodies with offsets: the element acts between its points and does no work in motions of the whole vehicle.
TEST(SeriesDamper, RestsWhereTheWholeVehicleMoves) {
  VehicleDescription parts;
  parts.name = "two";
  parts.bodies = {{"car-body", m, {100.0, 100.0, 100.0}, {0.0, 0.2, -1.5}},
                  {"wheelset-1", 100.0, {10.0, 10.0, 10.0}, {0.0, 0.0, -0.46}}};
  Suspension unit{0, 1, {0.0, -0.7, -0.9}, {1e5, 1e5, 1e5}, {1e3, 2e3, 3e3}, {1e6, 1e6, 1e6}};
  unit.series_stiffness = {1e6, 2e6, 3e6};
  parts.suspension = {unit};
  parts.wheelsets = {1};
  const VehicleModel vehicle = assemble_vehicle(parts);
  ASSERT_EQ(vehicle.dofs(), 15);
  const Eigen::Vector3d angles[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Eigen::Vector3d& theta : angles) {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(15);
    for (int b = 0; b < 2; ++b) {
      v.segment<3>(6 * b) = theta.cross(vehicle.bodies[static_cast<std::size_t>(b)].position);
      v.segment(6 * b + 3, 3) = theta;
    }
    EXPECT_LT((vehicle.damping * v).norm(), 1e-9 * vehicle.damping.norm());
  }
  EXPECT_LT((vehicle.damping * vehicle.lateral_shift).norm(), 1e-9 * vehicle.damping.norm());
}

TEST(SeriesDamper, BecomesADamperWhereItsStiffnessIsLarge) {
  const VehicleMode stiff = natural_modes(mass_on_series_damper(c, 1e12), 1).at(0);
  const VehicleMode alone = natural_modes(mass_on_series_damper(c, 0.0), 1).at(0);
  EXPECT_NEAR(stiff.frequency, alone.frequency, 1e-5 * alone.frequency);
  EXPECT_NEAR(stiff.damping, alone.damping, 1e-5);
  EXPECT_NEAR(alone.damping, c / (2.0 * std::sqrt(k * m)), 1e-12);
}

/// m ü + k u + k_s s = 0, c (u̇ − ṡ) = k_s s as a system of first order; its exponential is the closed form.
Eigen::Matrix3d system_matrix() {
  return Eigen::Matrix3d{{0.0, 1.0, 0.0}, {-k / m, 0.0, -series / m}, {0.0, 1.0, -series / c}};
}

Eigen::Vector3d closed_form(const Eigen::Vector3d& start, double time) {
  const GeneralSpectrum eigen = general_spectrum(system_matrix());
  const Eigen::Vector3cd part = Eigen::Matrix3cd(eigen.vectors).inverse() * start.cast<Complex>();
  const Eigen::Vector3cd grown = (time * eigen.values).array().exp() * part.array();
  return (eigen.vectors * grown).real();
}

/// Largest error of the mass' displacement over two periods.
double error_of_steps(double time_step, double alpha) {
  const VehicleModel vehicle = mass_on_series_damper();
  const HhtScheme scheme{alpha, time_step};
  const VehicleResponse response(vehicle, vehicle.damping, scheme);
  const Eigen::Vector3d start(0.01, 0.0, 0.0);
  LinearMotion motion(2);
  motion.displacement[0] = start[0];
  motion.acceleration[0] = -k / m * start[0];
  Prediction prediction;
  const Eigen::VectorXd load = Eigen::VectorXd::Zero(2);
  double largest = 0.0;
  const int steps = static_cast<int>(std::lround(0.6 / time_step));
  for (int i = 1; i <= steps; ++i) {
    predict(scheme, motion, prediction);
    response.find_free_increment(scheme, load, motion, prediction);
    update(scheme, prediction, prediction.increment, motion);
    largest = std::max(largest, std::abs(motion.displacement[0] - closed_form(start, i * time_step)[0]));
  }
  return largest / start[0];
}

TEST(SeriesDamper, StepsOfSecondOrderMeetTheClosedForm) {
  for (const double alpha : {0.0, -0.05, -0.1}) {
    const double coarse = error_of_steps(2e-3, alpha), fine = error_of_steps(1e-3, alpha);
    EXPECT_LT(fine, 1e-3) << alpha;
    EXPECT_GT(coarse / fine, 3.7) << alpha;
    EXPECT_LT(coarse / fine, 4.3) << alpha;
  }
}

TEST(SeriesDamper, NaturalMotionsAreRootsOfTheClosedForm) {
  const Eigen::Vector3cd roots = general_spectrum(system_matrix()).values;
  for (const VehicleMode& mode : natural_modes(mass_on_series_damper(), 5)) {
    const double omega = 2.0 * M_PI * mode.frequency;
    const Complex s(-mode.damping * omega, omega * std::sqrt(std::max(0.0, 1.0 - mode.damping * mode.damping)));
    double nearest = 1e300;
    for (const Complex& root : roots) nearest = std::min(nearest, std::abs(root - s));
    EXPECT_LT(nearest, 1e-6 * omega) << mode.motion;
  }
}

}  // namespace
}  // namespace railtab
