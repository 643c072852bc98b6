// The Manchester benchmark's wheelset rolling with friction, cases A2.1 and A2.2: creepages and creep forces with the
// shipped creep table against the program CONTACT at CONTACT's own wheelset positions and speeds [Shackleton2008].
//
// CONTACT's patch is what it is, railtab's is the ellipse of the overlap: where CONTACT's is far from an ellipse, the
// difference is printed, not bounded.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "manchester_rolling.hpp"
#include "manchester_run.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

namespace railtab {
namespace {

// Longitudinal creep force of all patches by wheel_force(), as a run has it: creepage by V. Of friction times the
// normal force `bound`, on the wheel.
double fx_of_run(const ContactGeometry& geometry, const NormalContactModel& model, const CreepLaw& law,
                 const WheelsetPose& pose, double pitch_rate, double bound) {
  WheelContactModel run;
  run.geometry = &geometry;
  run.normal = model;
  run.creep_law = law;
  run.friction = manchester_friction;
  run.speed = manchester_speed;
  WheelsetMotion wheelset;
  wheelset.displacement << 0.0, pose.y, pose.z, pose.roll, 0.0, pose.yaw;
  wheelset.velocity[4] = pitch_rate + manchester_speed / geometry.pair().nominal_radius();  // against nominal rolling
  return -wheel_force(run, WheelSide::right, wheelset, {}, geometry.patches(pose)).rail_x / bound;
}

struct Largest {
  double creepage = 0.0, spin = 0.0, force = 0.0, direction = 0.0;
  void take(double c, double s, double f, double d) {
    creepage = std::max(creepage, c);
    spin = std::max(spin, s);
    force = std::max(force, f);
    direction = std::max(direction, d);
  }
};

TEST(ManchesterRolling, CreepagesAndCreepForcesOfBothCases) {
  const ManchesterWheelset wheelset;
  const ContactGeometry& geometry = wheelset.geometry();
  const NormalContactModel& model = wheelset.model();
  const CreepLaw law = creep_law("table", model.material.nu);

  const auto reference = testing::read_reference("manchester_rolling.csv");
  const auto value = [&](const char* column, std::size_t row) { return reference.at(column)[row]; };
  const std::size_t rows = reference.at("side").size();
  Largest elliptic, others;
  int left_out = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const double side = value("side", row);
    const WheelsetPose pose{side * value("y_ws", row) * 1e-3, value("z_ws", row) * 1e-3, side * value("roll_ws", row),
                            side * value("yaw_ws", row)};
    const RollingWheel own = rolling_wheel(geometry, model, law, pose, value("pitch_rate", row), pose.yaw);
    // CONTACT gives the rail against the wheel, and forces on the rail; the left side is mirrored onto the right.
    const double bound = manchester_friction * value("normal_force", row);
    const double fx = -value("fx", row) / bound, fy = -side * value("fs", row) / bound;
    const double creepage = std::max(std::abs(own.creepage.x + value("creepage_x", row)),
                                     std::abs(own.creepage.y + side * value("creepage_s", row)));
    const double spin = std::abs(own.creepage.spin + 1e3 * side * value("spin", row));
    const double force = std::hypot(own.fx - fx, own.fy - fy);
    const double direction =
        std::abs(std::atan2(own.fx * fy - own.fy * fx, own.fx * fx + own.fy * fy)) * 180.0 / std::numbers::pi;
    const double ellipse = std::numbers::pi * value("half_x", row) * value("half_s", row);
    const bool close_to_ellipse = std::abs(value("area", row) / ellipse - 1.0) < 0.1;
    (close_to_ellipse ? elliptic : others).take(creepage, spin, force, direction);
    if (!close_to_ellipse) {
      ++left_out;
      continue;
    }
    SCOPED_TRACE(::testing::Message() << "case A" << value("case", row) << ", side " << side
                                      << ", y = " << value("y_ws", row) << " mm");
    EXPECT_LE(creepage, 3e-4);
    EXPECT_LE(spin, 4e-3);
    EXPECT_LE(force, 0.05);
    EXPECT_LE(direction, 3.0);
    EXPECT_NEAR(fx_of_run(geometry, model, law, pose, value("pitch_rate", row), manchester_friction * own.normal_force),
                own.fx, 0.02);
  }
  const auto record = [](const std::string& name, const Largest& largest) {
    testing::measured(name + ".creepage", largest.creepage);
    testing::measured(name + ".spin", largest.spin);
    testing::measured(name + ".force", largest.force);
    testing::measured(name + ".direction", largest.direction);
  };
  record("manchester.rolling", elliptic);
  record("manchester.rolling.others", others);
  testing::measured("manchester.rolling.others.count", left_out);
  EXPECT_LE(left_out, 10);
}

// A run brings the wheelset to the height and roll of CONTACT's kinematic solution, on tread, root and flange. Its own
// loads differ by some per cent from CONTACT's 10 kN per wheel, a change of the penetration by about a micrometre.
TEST(ManchesterRolling, RunsSettleWhereContactHasTheWheelset) {
  const auto reference = testing::read_reference("manchester_rolling.csv");
  const ManchesterWheelset wheelset;
  int found = 0;
  for (std::size_t row = 0; row < reference.at("side").size(); ++row) {
    const double y_mm = reference.at("y_ws")[row];
    const bool chosen = y_mm == 2.0 || y_mm == 6.0 || y_mm == 9.0;
    if (!chosen || reference.at("side")[row] < 0.0) continue;
    const HeldRun run(wheelset, 1e-3 * y_mm, reference.at("yaw_ws")[row]);
    SCOPED_TRACE(::testing::Message() << "case A" << reference.at("case")[row] << ", y = " << y_mm << " mm");
    EXPECT_NEAR(run.rest.motion.displacement[1], 1e-3 * y_mm, 1e-7);
    EXPECT_NEAR(run.rest.motion.displacement[2], 1e-3 * reference.at("z_ws")[row], 1.5e-6);
    EXPECT_NEAR(run.rest.motion.displacement[3], reference.at("roll_ws")[row], 3e-6);
    ++found;
  }
  EXPECT_EQ(found, 6);
}

}  // namespace
}  // namespace railtab
