// The Manchester benchmark's wheelset (S1002 on UIC60 at 1:40), geometric contact points: cases A1.1 (lateral shift)
// and A1.2 (lateral shift and yaw) against the program CONTACT [Shackleton2008], see the headers of the CSV files.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

// The reference's rail frame starts at the point file's origin, this far to the gauge side of the crown [m].
constexpr double rail_origin_shift = 5.95e-6;
constexpr double mm = 1e-3;
constexpr std::array jump{0.25, 4.85, 6.25};  // lateral shifts at which the right wheel's contact jumps [mm]

const ContactSearch& search() {
  static const ContactSearch s(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                             ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                             PairDimensions{}));
  return s;
}

std::vector<std::vector<double>> read_reference(const std::string& name) {
  std::ifstream file(std::filesystem::path(RAILTAB_REFERENCE_DIR) / name);
  std::vector<std::vector<double>> rows;
  std::string line;
  bool titles = true;
  while (std::getline(file, line)) {
    if (line.starts_with('#')) continue;
    if (titles) {
      titles = false;
      continue;
    }
    std::istringstream fields(line);
    std::string field;
    rows.emplace_back();
    while (std::getline(fields, field, ',')) rows.back().push_back(std::stod(field));
  }
  return rows;
}

struct ContactPosition {
  double y_rail, y_wheel, angle, radius, x;
};

// The touching point of one wheel of a wheelset, in the reference's axes (left side not mirrored).
ContactPosition touching(double y, double roll, double yaw, double side) {
  const ContactSearch& s = search();
  const TouchPoint touch = s.first_touch(side * y, side * roll, side * yaw);
  const WheelsetPose pose{side * y, touch.z_touch, side * roll, side * yaw};
  const ContactPatch p = patch_of_pair(s.pair(), pose, PoseTrigonometry(pose), {touch.s_wheel, touch.s_rail});
  return {side * (p.y_rail + rail_origin_shift), side * p.y_wheel, side * p.angle, p.rolling_radius, p.x};
}

// Steps of 0.1 mm in which the touching branch changes: from step k to k + 1 the wheel's contact moves by over 1 mm.
template <class Position>
std::vector<int> jumps(Position y_wheel, int steps) {
  std::vector<int> found;
  for (int k = 0; k + 1 < steps; ++k) {
    if (std::abs(y_wheel(k + 1) - y_wheel(k)) > 1.0 * mm) found.push_back(k);
  }
  return found;
}

// The reference's point is the centre of pressure of a patch about 0.1 mm wide: it leaves the geometric point where the
// lateral curvature of the pair changes within the patch (joints of the profiles' segments).
bool at_joint(double y_wheel) {
  const ProfileCurve& wheel = search().pair().wheel();
  const double s = wheel.s_at_y(y_wheel);
  return std::abs(wheel.at(s + 0.1 * mm).curvature() - wheel.at(s - 0.1 * mm).curvature()) > 20.0;
}

TEST(ManchesterRigid, CaseA11ContactPointsOfBothWheels) {
  const auto rows = read_reference("manchester_a11_rigid.csv");
  ASSERT_EQ(rows.size(), 101u);
  int beside_jump = 0;
  int joints = 0;
  double position = 0.0, angle = 0.0, radius = 0.0;  // largest differences away from jumps and joints
  double joint_position = 0.0, joint_angle = 0.0;
  for (const auto& r : rows) {
    // The steps on both sides of the three jumps: there the patch of a second contact begins to share the force.
    if (std::any_of(jump.begin(), jump.end(), [&](double y) { return std::abs(r[0] - y) < 0.06; })) {
      ++beside_jump;
      continue;
    }
    const ContactPosition right = touching(r[0] * mm, r[1], 0.0, 1.0);
    const ContactPosition left = touching(r[0] * mm, r[1], 0.0, -1.0);
    SCOPED_TRACE(r[0]);
    const bool joint = at_joint(right.y_wheel);
    joints += joint ? 1 : 0;
    const double share = joint ? 3.0 : 1.0;
    if (joint) {
      joint_position = std::max(std::abs(right.y_rail - r[10] * mm), std::abs(right.y_wheel - r[12] * mm));
      joint_angle = std::max(joint_angle, std::abs(right.angle - r[8]));
    }
    if (!joint) {
      const auto grow = [](double& largest, double a, double b) { largest = std::max(largest, std::abs(a - b)); };
      grow(position, left.y_rail, r[9] * mm);
      grow(position, right.y_rail, r[10] * mm);
      grow(position, left.y_wheel, r[11] * mm);
      grow(position, right.y_wheel, r[12] * mm);
      grow(angle, left.angle, r[7]);
      grow(angle, right.angle, r[8]);
      grow(radius, left.radius, r[5] * mm);
      grow(radius, right.radius, r[6] * mm);
    }
    EXPECT_NEAR(left.radius, r[5] * mm, 0.005 * mm);
    EXPECT_NEAR(right.radius, r[6] * mm, share * 0.005 * mm);
    EXPECT_NEAR(left.angle, r[7], 0.5e-3);
    EXPECT_NEAR(right.angle, r[8], share * 0.5e-3);
    EXPECT_NEAR(left.y_rail, r[9] * mm, 0.01 * mm);
    EXPECT_NEAR(right.y_rail, r[10] * mm, 0.01 * mm);
    EXPECT_NEAR(left.y_wheel, r[11] * mm, 0.01 * mm);
    EXPECT_NEAR(right.y_wheel, r[12] * mm, 0.01 * mm);
  }
  testing::measured("manchester.a11.position_mm", position / mm);
  testing::measured("manchester.a11.angle_mrad", 1e3 * angle);
  testing::measured("manchester.a11.radius_mm", radius / mm);
  testing::measured("manchester.a11.joint_position_mm", joint_position / mm);
  testing::measured("manchester.a11.joint_angle_mrad", 1e3 * joint_angle);
  EXPECT_EQ(beside_jump, 6);
  EXPECT_LE(joints, 2);
}

TEST(ManchesterRigid, CaseA11RollAndJumpsOfTheFreeWheelset) {
  const auto rows = read_reference("manchester_a11_rigid.csv");
  std::vector<double> y_wheel;
  double roll = 0.0;
  for (const auto& r : rows) {
    const RigidPosition position = rigid_position(search(), r[0] * mm, 0.0);
    ASSERT_TRUE(position.converged);
    if (r[1] != 0.0) roll = std::max(roll, std::abs(position.roll / r[1] - 1.0));
    EXPECT_NEAR(position.roll, r[1], 0.01 * std::abs(r[1]) + 1e-9) << r[0];
    // In flange contact 0.001 mm of gauge clearance is 0.003 mm of height.
    EXPECT_NEAR(position.z, r[2] * mm, (r[0] > 6.25 ? 0.010 : 0.001) * mm) << r[0];
    y_wheel.push_back(touching(r[0] * mm, position.roll, 0.0, 1.0).y_wheel);
  }
  const int steps = static_cast<int>(rows.size());
  const auto own = jumps([&](int k) { return y_wheel[static_cast<std::size_t>(k)]; }, steps);
  const auto reference = jumps([&](int k) { return rows[static_cast<std::size_t>(k)][12] * mm; }, steps);
  testing::measured("manchester.a11.roll_percent", 100 * roll);
  EXPECT_EQ(own, reference);
  EXPECT_EQ(own, (std::vector<int>{2, 48, 62}));
}

TEST(ManchesterRigid, CaseA12ContactPointsWithYaw) {
  const auto rows = read_reference("manchester_a12_rigid.csv");
  ASSERT_EQ(rows.size(), 42u);
  double position = 0.0, shift = 0.0, flange_shift = 0.0, angle = 0.0;
  for (const auto& r : rows) {
    const double side = r[0];
    const ContactPosition p = touching(r[1] * mm, r[3], r[2], side);
    SCOPED_TRACE(::testing::Message() << "y " << r[1] << " mm, side " << side);
    const bool flange = std::abs(r[10]) > 0.7;
    position = std::max({position, std::abs(p.y_rail - r[6] * mm), std::abs(p.y_wheel - r[8] * mm)});
    angle = std::max(angle, std::abs(p.angle - r[10]));
    double& largest = flange ? flange_shift : shift;
    largest = std::max(largest, std::abs(p.x - r[5] * mm));
    EXPECT_NEAR(p.x, r[5] * mm, (flange ? 0.1 : 0.02) * mm);
    EXPECT_NEAR(p.y_rail, r[6] * mm, 0.01 * mm);
    EXPECT_NEAR(p.y_wheel, r[8] * mm, 0.01 * mm);
    EXPECT_NEAR(p.angle, r[10], 0.5e-3);
    EXPECT_NEAR(p.radius, r[11] * mm, 0.005 * mm);
  }
  testing::measured("manchester.a12.position_mm", position / mm);
  testing::measured("manchester.a12.shift_mm", shift / mm);
  testing::measured("manchester.a12.flange_shift_mm", flange_shift / mm);
  testing::measured("manchester.a12.angle_mrad", 1e3 * angle);
}

}  // namespace
}  // namespace railtab
