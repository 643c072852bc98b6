// Linear critical speed: eigenvalues of the vehicle on its contacts, against closed forms and time simulation.

#include "railtab/runtime/stability/linear_stability.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "hunting_model.hpp"
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
