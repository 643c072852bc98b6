// The Manchester benchmark's wheelset rolling with friction, cases A2.1 and A2.2: creepages and creep forces with the
// shipped creep table against the program CONTACT at CONTACT's own wheelset positions and speeds [Shackleton2008].
//
// CONTACT's patch is what it is, railtab's is the ellipse of the overlap: where CONTACT's is far from an ellipse, the
// difference is printed, not bounded.

#include <gtest/gtest.h>

#include <string>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "manchester_wheelset.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

namespace railtab {
namespace {

using Eigen::Vector3d;

constexpr double speed = 2.0;  // m/s
constexpr double friction = 0.3;

struct Rolling {
  PatchCreepage creepage;  // of a right wheel, wheel against rail, by (V + |Ω| r)/2
  double fx, fy;           // on the wheel, of friction times the normal force
  double fx_of_run;        // the same of all patches by wheel_force(), as a run has it: creepage by V
};

// The wheel's largest patch at a pose of the right wheel, rotating at `pitch_rate` about its axle.
Rolling rolling(const ContactGeometry& geometry, const NormalContactModel& model, const CreepLaw& law,
                const WheelsetPose& pose, double pitch_rate) {
  const WheelRailPair& pair = geometry.pair();
  const ContactPatches patches = geometry.patches(pose);
  const PatchLoads loads = patch_loads(model, geometry, pose, patches);
  const PatchLoad& load =
      *std::max_element(loads.begin(), loads.begin() + patches.count,
                        [](const PatchLoad& a, const PatchLoad& b) { return a.elastic_force < b.elastic_force; });
  const ContactPatch& p = load.contact;
  const Vector3d normal(0.0, -std::sin(p.angle), std::cos(p.angle));
  const Vector3d arm =
      Vector3d(p.x, p.y_rail - (pose.y - pair.rail_offset()), p.z_rail - (pose.z - pair.nominal_radius())) +
      p.penetration * normal;
  const Vector3d axle(-std::sin(pose.yaw), std::cos(pose.yaw) * std::cos(pose.roll),
                      std::cos(pose.yaw) * std::sin(pose.roll));
  const RelativeMotion motion{Vector3d(speed, 0.0, 0.0), pitch_rate * axle};
  Rolling result{};
  result.creepage =
      patch_creepage(motion, arm, ContactAxes(p.angle), 0.5 * (speed + std::abs(pitch_rate) * p.rolling_radius));
  const double bound = friction * load.elastic_force;
  const double a = load.hertz.a1 * std::cbrt(load.elastic_force);
  const double b = load.hertz.b1 * std::cbrt(load.elastic_force);
  const CreepForce force = creep_force(
      law, load.hertz.ratio, normalised_creepage(result.creepage, a, b, model.material.shear_modulus(), bound));
  result.fx = force.x;
  result.fy = force.y;

  WheelContactModel run;
  run.geometry = &geometry;
  run.normal = model;
  run.creep_law = law;
  run.friction = friction;
  run.speed = speed;
  WheelsetMotion wheelset;
  wheelset.displacement << 0.0, pose.y, pose.z, pose.roll, 0.0, pose.yaw;
  wheelset.velocity[4] = pitch_rate + speed / pair.nominal_radius();  // against nominal rolling
  result.fx_of_run = -wheel_force(run, WheelSide::right, wheelset, {}, patches).rail_x / bound;
  return result;
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
    const Rolling own = rolling(geometry, model, law, pose, value("pitch_rate", row));
    // CONTACT gives the rail against the wheel, and forces on the rail; the left side is mirrored onto the right.
    const double bound = friction * value("normal_force", row);
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
    EXPECT_NEAR(own.fx_of_run, own.fx, 0.02);
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

}  // namespace
}  // namespace railtab
