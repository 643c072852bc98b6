// Linear critical speed: eigenvalues of the vehicle on its contacts, against closed forms and time simulation.

#include "railtab/runtime/stability/linear_stability.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "hunting_model.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vehicle/vehicle_data.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::hunting {
namespace {

// Routh's boundary of Eq. 18 in closed form (hunting_test.cpp).
constexpr double critical_speed_of_eq_18 = 234.956;  // km/h

TEST(LinearCriticalSpeed, IsThatOfTheEquationsOfMotion) {
  const LinearCriticalSpeed found = linear_critical_speed(wheelset({}, 50.0), {.low = 20.0, .high = 120.0});
  ASSERT_TRUE(found.critical);
  const double v = 3.6 * found.critical->speed;
  std::printf("linear critical speed %.4f km/h, Eq. 18: %.3f km/h; %.3f Hz\n", v, critical_speed_of_eq_18,
              found.critical->frequency);
  testing::measured("stability.critical_speed", v);
  EXPECT_NEAR(v / critical_speed_of_eq_18, 1.0, 1e-3);
}

TEST(LinearCriticalSpeed, IsThatOfTimeSimulationWithEachAssumptionLifted) {
  Assumptions assume;
  assume.roll = Roll::free;
  assume.spin = Spin::included;
  assume.gravitational_stiffness = GravitationalStiffness::included;
  assume.gyroscopic_moments = GyroscopicMoments::included;
  const double simulated = critical_speed(assume, 255.0);
  const LinearCriticalSpeed found = linear_critical_speed(wheelset(assume, 50.0), {.low = 20.0, .high = 120.0});
  ASSERT_TRUE(found.critical);
  std::printf("linear critical speed %.4f km/h, simulated %.4f km/h\n", 3.6 * found.critical->speed, simulated);
  EXPECT_NEAR(3.6 * found.critical->speed / simulated, 1.0, 1e-3);
}

TEST(LinearCriticalSpeed, WavelengthAndDecrementAreThoseOfEq18) {
  auto reference = testing::read_reference("hunting_eigenvalues.csv");
  for (std::size_t i = 0; i < reference["V_kmh"].size(); ++i) {
    const double kmh = reference["V_kmh"][i];
    if (kmh < 150.0 || std::fmod(kmh, 50.0) != 0.0) continue;
    const LeastStableMotion least = least_stable_motion(wheelset({}, kmh / 3.6), kmh / 3.6);
    EXPECT_NEAR(kmh / 3.6 / least.frequency / reference["wavelength_m"][i], 1.0, 1e-3) << kmh;
    EXPECT_NEAR(-least.growth / least.frequency, reference["logdec"][i], 2e-3) << kmh;
  }
}

// A library vehicle on rails at 1:40, as scenes have it.
VsiModel on_s1002(const std::string& vehicle) {
  SceneParameters scene;
  scene.train.vehicle = vehicle;
  scene.contact.mode = ContactMode::online;
  scene.contact.rail_inclination = 1.0 / 40.0;
  scene.contact.dimensions.nominal_radius = library_vehicle(vehicle).parts.nominal_radius;
  return stability_model(scene);
}

// Rate [1/s] at which the lateral motion of the first wheelset grows in a simulation from a shift of 1 µm, so small
// that the contact keeps its derivatives: from the largest motions of two intervals after the other motions have
// decayed.
double simulated_growth(VsiModel model, double speed) {
  model.contact.speed = speed;
  model.contact.damping = 0.0;
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) throw std::runtime_error("no equilibrium");
  const int first = model.vehicle.dof[static_cast<std::size_t>(model.vehicle.wheelsets.front())][1];
  const double rest = state.vehicle[0].displacement[first];
  const LinearShape least = lateral_shapes(model, speed).front();
  const Eigen::VectorXcd shape = 1e-6 / std::abs(least.displacement[first]) * least.displacement;
  state.vehicle[0].displacement += shape.real();
  state.vehicle[0].velocity += (least.value * shape).real();
  constexpr double settled = 3.0, interval = 2.0;  // s
  double before = 0.0, after = 0.0;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    if (now.time < settled) return;
    double& largest = now.time < settled + interval ? before : after;
    largest = std::max(largest, std::abs(now.vehicle[0].displacement[first] - rest));
  };
  IntegrationParameters integration;
  integration.time_step = 1e-3;
  integration.alpha = 0.0;
  integration.tolerance = 1e-10;
  const RunSummary run = simulate(model, integration, settled + 2.0 * interval, 1000000, state, observer);
  if (!run.complete) throw std::runtime_error(run.message);
  return std::log(after / before) / interval;
}

// Numbers of docs/validation/vehicles.csv, of a coach without and one with dampers in series: the speed at which
// simulated motions neither grow nor decay.
TEST(LinearCriticalSpeed, OfLibraryVehiclesIsThatOfTimeSimulation) {
  for (const char* vehicle : {"manchester-coach", "ice3-like-coach"}) {
    const VsiModel model = on_s1002(vehicle);
    const LinearCriticalSpeed found = linear_critical_speed(model, {.low = 60.0, .high = 90.0});
    ASSERT_TRUE(found.critical) << vehicle;
    const double v = found.critical->speed;
    const double below = simulated_growth(model, 0.99 * v), above = simulated_growth(model, 1.01 * v);
    std::printf("%s: %.2f km/h; simulated growth %.4f, %.4f 1/s, by eigenvalues %.4f, %.4f 1/s\n", vehicle, 3.6 * v,
                below, above, least_stable_motion(model, 0.99 * v).growth, least_stable_motion(model, 1.01 * v).growth);
    ASSERT_LT(below, 0.0) << vehicle;
    ASSERT_GT(above, 0.0) << vehicle;
    const double simulated = v * (0.99 + 0.02 * below / (below - above));
    EXPECT_NEAR(simulated / v, 1.0, 1e-3) << vehicle;
    EXPECT_FALSE(growing_motion(model, 0.99 * v)) << vehicle;
    const std::optional<LeastStableMotion> growing = growing_motion(model, 1.01 * v);
    ASSERT_TRUE(growing) << vehicle;
    EXPECT_EQ(growing->growth, least_stable_motion(model, 1.01 * v).growth) << vehicle;
  }
}

// Motions that no damper meets, as a side frame's between two wheelsets, have growth rates of rounding.
TEST(LinearCriticalSpeed, IsNotThatOfUndampedMotions) {
  for (const char* wagon : {"freight-21t", "freight-21t-empty", "freight-25t"}) {
    const LinearCriticalSpeed found = linear_critical_speed(on_s1002(wagon), {.low = 4.0, .high = 20.0});
    ASSERT_TRUE(found.critical) << wagon;
    EXPECT_LT(found.critical->frequency, 2.0) << wagon;
    EXPECT_GT(found.critical->speed, 5.0) << wagon;
    EXPECT_FALSE(growing_motion(on_s1002(wagon), 0.99 * found.critical->speed)) << wagon;
  }
}

// Yaw dampers are what lets a coach run fast.
TEST(LinearCriticalSpeed, OfACoachDependsOnItsYawDampers) {
  const auto critical = [](bool yaw_dampers) {
    VehicleData data = library_vehicle("ice3-like-coach");
    if (!yaw_dampers) {
      std::erase_if(data.parts.suspension, [](const railtab::Suspension& unit) { return unit.name == "yaw damper"; });
    }
    VsiModel model;
    model.vehicle = build_vehicle(data, MotionPlane::spatial);
    model.vehicle_x = {0.0};
    model.geometry = std::make_shared<const ContactGeometry>(
        ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                    ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
    model.contact.geometry = model.geometry.get();
    const SpeedSearch search{.low = 10.0, .high = 170.0, .step = 10.0, .tolerance = 0.5};
    const LinearCriticalSpeed found = linear_critical_speed(model, search, 0.17);
    return 3.6 * (found.critical ? found.critical->speed : search.high);
  };
  const double with = critical(true), without = critical(false);
  std::printf("ice3-like-coach, conicity 0.17: %.1f km/h, without yaw dampers %.1f km/h\n", with, without);
  EXPECT_GT(with, 1.3 * without);
  EXPECT_GT(with, 330.0);
}

}  // namespace
}  // namespace railtab::hunting
