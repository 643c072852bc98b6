// The Manchester benchmark's wheelset under 10 kN per wheel, cases A1.1 and A1.2, in its own equilibrium: ellipses
// at the centre of each overlap against CONTACT's solution for the true interpenetration [Shackleton2008]; see the
// header of the CSV file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "manchester_wheelset.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;

// Largest differences of one group of positions.
struct Differences {
  double penetration = 0.0, normal_force = 0.0;  // relative
  double position = 0.0, height = 0.0;           // [m]
  int count = 0;

  void add(const LoadedWheel& wheel, double pen, double fn, double y_rail, double z) {
    const auto grow = [](double& largest, double difference) { largest = std::max(largest, std::abs(difference)); };
    grow(penetration, wheel.penetration / pen - 1.0);
    grow(normal_force, wheel.normal_force / fn - 1.0);
    grow(position, wheel.y_rail - y_rail);
    grow(height, wheel.z - z);
    ++count;
  }
  void record(const std::string& name) const {
    testing::measured(name + ".count", count);
    testing::measured(name + ".penetration_percent", 100 * penetration);
    testing::measured(name + ".force_percent", 100 * normal_force);
    testing::measured(name + ".position_mm", position / mm);
    testing::measured(name + ".height_um", 1e6 * height);
  }
};

// Shifts at which the elastic patch reaches across a jump of the geometric contact (0.2 to 0.3 mm and 4.85 mm): its
// centre of pressure depends on the whole of both contacts.
bool beside_jump(double y, double side) { return y < 1.1 * mm || (side > 0 && std::abs(y - 5 * mm) < 0.1 * mm); }

TEST(ManchesterEquilibrium, WheelsetInEquilibriumAgainstContact) {
  const auto r = testing::read_reference("manchester_loaded.csv");
  ASSERT_EQ(r.at("normal_force").size(), 84U);
  const ManchesterWheelset wheelset;
  Differences tread, flange, jump;
  for (std::size_t i = 0; i < r.at("normal_force").size(); ++i) {
    const double y = r.at("y_ws")[i] * mm;
    const double side = r.at("side")[i];
    const LoadedWheel wheel = wheelset.wheel(y, r.at("roll_ws")[i], r.at("yaw_ws")[i], side);
    const double vertical = wheel.normal_force * std::cos(wheel.angle);
    if (wheel.patches == 1) {
      EXPECT_NEAR(vertical, ManchesterWheelset::load, 1e-6 * ManchesterWheelset::load);
    }
    Differences& group = beside_jump(y, side) ? jump : std::abs(wheel.angle) > 0.7 ? flange : tread;
    group.add(wheel, r.at("approach")[i] * mm, r.at("normal_force")[i], r.at("ycp_r")[i] * mm, r.at("z_ws")[i] * mm);
  }
  tread.record("manchester.equilibrium.tread");
  flange.record("manchester.equilibrium.flange");
  jump.record("manchester.equilibrium.jump");
  EXPECT_EQ(tread.count + flange.count + jump.count, 84);
  EXPECT_EQ(flange.count, 16);
  EXPECT_EQ(jump.count, 14);
  EXPECT_LT(tread.penetration, 0.012);
  EXPECT_LT(tread.normal_force, 0.0005);
  EXPECT_LT(tread.position, 0.05 * mm);
  EXPECT_LT(tread.height, 0.5e-3 * mm);
  EXPECT_LT(flange.penetration, 0.015);
  EXPECT_LT(flange.normal_force, 0.012);
  EXPECT_LT(flange.position, 0.03 * mm);
  EXPECT_LT(flange.height, 2e-3 * mm);
  EXPECT_LT(jump.penetration, 0.03);
  EXPECT_LT(jump.normal_force, 0.004);
  EXPECT_LT(jump.position, 1.5 * mm);
  EXPECT_LT(jump.height, 1e-3 * mm);
}

}  // namespace
}  // namespace railtab
