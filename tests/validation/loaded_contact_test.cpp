// The half-space solution of a wheel on its rail, with friction, against the program CONTACT: the loaded Manchester
// wheelset [Shackleton2008] and a sample of random rolling cases. The profiles are the built-in ones; CONTACT's are
// splines through points, which rounds the joints of arcs. All cases are in loaded_contact_study.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "manchester_wheelset.hpp"
#include "railtab/tablegen/loaded_rolling.hpp"

namespace railtab {
namespace {

LoadedContactOptions options_of(const ManchesterWheelset& wheelset) {
  LoadedContactOptions options;
  options.wheel = options.rail = wheelset.model().material;
  return options;
}

// All 21 positions of both wheels and both cases, those of conformal and of two-point contact included. At y = 5 mm the
// right wheel has two bands 7 mm apart, which CONTACT couples in part only (it blends from 4 to 8 mm to no coupling):
// its force lies between that of the coupled and that of separate bands.
TEST(LoadedContactAgainstContact, NormalForceOfTheManchesterWheelset) {
  const ManchesterWheelset wheelset;
  const LoadedContactOptions options = options_of(wheelset);
  const auto reference = testing::read_reference("manchester_loaded.csv");
  const auto value = [&](const char* column, std::size_t row) { return reference.at(column)[row]; };
  double worst = 0.0, squares = 0.0, least = 0.0;
  int two_bands = 0;
  const std::size_t rows = reference.at("side").size();
  for (std::size_t row = 0; row < rows; ++row) {
    const double side = value("side", row);
    const WheelsetPose pose{side * value("y_ws", row) * 1e-3, value("z_ws", row) * 1e-3, side * value("roll_ws", row),
                            side * value("yaw_ws", row)};
    const LoadedContact c = loaded_contact(wheelset.search(), pose, options);
    ASSERT_TRUE(c.converged);
    const double error = c.normal_force / value("normal_force", row) - 1.0;
    if (c.bands.size() > 1) {
      ++two_bands;
      least = std::min(least, error);
      EXPECT_LT(error, -0.02);
      EXPECT_GT(error, -0.06);
      continue;
    }
    worst = std::max(worst, std::abs(error));
    squares += error * error;
    EXPECT_LT(std::abs(error), 0.01) << "case A" << value("case", row) << ", side " << side
                                     << ", y = " << value("y_ws", row) << " mm";
  }
  const double rms = std::sqrt(squares / static_cast<double>(rows));
  testing::measured("loaded_contact.manchester.rms_percent", 100 * rms);
  testing::measured("loaded_contact.manchester.largest_percent", 100 * worst);
  testing::measured("loaded_contact.manchester.two_bands_percent", 100 * least);
  EXPECT_EQ(rows, 84u);
  EXPECT_EQ(two_bands, 2);
  EXPECT_LT(rms, 0.004);
}

struct RollingCase {
  ContactAtLoad found;
  LoadedRolling curved, planar;
};

class RollingCases : public ::testing::Test {
 protected:
  static constexpr double friction = 0.3;

  [[nodiscard]] double value(const char* column, std::size_t row) const { return reference_.at(column)[row]; }
  [[nodiscard]] std::size_t rows() const { return reference_.at("case").size(); }
  [[nodiscard]] double angle(std::size_t row) const { return std::abs(value("delta", row)); }

  [[nodiscard]] RollingCase solve(std::size_t row) const {
    const WheelsetPose pose{value("y", row), 0.0, value("roll", row), value("yaw", row)};
    LoadedRollingOptions curved, planar;
    curved.speed = planar.speed = 30.0;
    planar.slip = LoadedRollingOptions::SlipField::planar;
    const RelativeMotion motion = running_motion(pose, curved.speed, value("pitch_rate", row));
    const WheelRailPair& pair = wheelset_.search().pair();
    const ContactAtLoad found = contact_at_load(
        wheelset_.search(), pose, value("load", row), options_,
        [&](const LoadedContact& c) { return loaded_rolling(pair, c, options_, motion, curved).on_rail.force.z(); });
    EXPECT_TRUE(found.converged) << "case " << value("case", row);
    return {found, loaded_rolling(pair, found.contact, options_, motion, curved),
            loaded_rolling(pair, found.contact, options_, motion, planar)};
  }

  [[nodiscard]] double approach_error(const RollingCase& c, std::size_t row) const {
    const WheelsetPose& pose = c.found.contact.pose;
    const double touch = wheelset_.search().touch_height(pose.y, pose.roll, pose.yaw);
    return std::abs((pose.z - touch) / value("approach", row) - 1.0);
  }

  ManchesterWheelset wheelset_;
  LoadedContactOptions options_ = options_of(wheelset_);
  std::map<std::string, std::vector<double>> reference_ = testing::read_reference("loaded_contact.csv");
};

// One band on the tread: approach, pressure, and the creep force where the rigid slip is that of CONTACT's planar
// reference. What the curved surface changes of it shows in the next test.
TEST_F(RollingCases, OnTheTread) {
  double approach = 0.0, force = 0.0, sum = 0.0, pressure = 0.0;
  int count = 0;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (angle(row) > 0.13 || value("bands", row) > 1.5) continue;
    const RollingCase c = solve(row);
    double x = 0.0, y = 0.0;
    for (const BandFriction& band : c.planar.bands) {
      x += band.x / (friction * c.found.contact.normal_force);
      y += band.y / (friction * c.found.contact.normal_force);
    }
    const double bound = friction * value("fn", row);
    const double error = std::hypot(x + value("tx", row) / bound, y + value("ts", row) / bound);
    approach = std::max(approach, approach_error(c, row));
    pressure = std::max(pressure, std::abs(c.found.contact.largest_pressure / value("pmax", row) - 1.0));
    force = std::max(force, error);
    sum += error;
    ++count;
    EXPECT_LT(error, 0.02) << "case " << value("case", row);
  }
  testing::measured("loaded_contact.sample.tread.approach_percent", 100 * approach);
  testing::measured("loaded_contact.sample.tread.pressure_percent", 100 * pressure);
  testing::measured("loaded_contact.sample.tread.force", force);
  EXPECT_GT(count, 20);
  EXPECT_LT(approach, 0.003);
  EXPECT_LT(pressure, 0.05);
  EXPECT_LT(sum / count, 0.003);
}

// Where CONTACT was run with its curved reference too: the true rigid slip agrees with that, not with the planar one.
TEST_F(RollingCases, InTheRootAndWithSeveralBands) {
  double curved = 0.0, planar = 0.0;
  int count = 0;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (angle(row) > 0.5 || std::isnan(value("d4_fx", row))) continue;
    const RollingCase c = solve(row);
    const Eigen::Vector3d force = c.found.contact.on_rail.force + c.curved.on_rail.force;
    const double bound = friction * value("fn", row);
    const double d4 = std::hypot(force.x() - value("d4_fx", row), force.y() - value("d4_fy", row)) / bound;
    curved += d4;
    planar += std::hypot(force.x() - value("fx", row), force.y() - value("fy", row)) / bound;
    ++count;
    EXPECT_LT(d4, 0.02) << "case " << value("case", row);
    EXPECT_LT(approach_error(c, row), 0.03) << "case " << value("case", row);
  }
  testing::measured("loaded_contact.sample.root.force_d4", curved / count);
  EXPECT_GT(count, 8);
  EXPECT_LT(curved / count, 0.008);
  EXPECT_LT(3.0 * curved, planar);
}

// On the flange the creep force agrees in contact axes. The direction of CONTACT's normal does not: see
// docs/validation/loaded_contact.md.
TEST_F(RollingCases, OnTheFlange) {
  int count = 0;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (angle(row) <= 0.5) continue;
    const RollingCase c = solve(row);
    ASSERT_EQ(c.planar.bands.size(), 1u);
    const double scale = friction * c.found.contact.normal_force, bound = friction * value("fn", row);
    EXPECT_LT(std::hypot(c.planar.bands[0].x / scale + value("tx", row) / bound,
                         c.planar.bands[0].y / scale + value("ts", row) / bound),
              0.03)
        << "case " << value("case", row);
    EXPECT_LT(std::abs(c.found.contact.largest_pressure / value("pmax", row) - 1.0), 0.05);
    ++count;
  }
  EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace railtab
