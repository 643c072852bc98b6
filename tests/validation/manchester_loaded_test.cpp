// The Manchester benchmark's wheelset loaded with 10 kN per wheel, cases A1.1 and A1.2, against the program CONTACT
// (non-Hertzian half-space theory) at CONTACT's own wheelset positions [Shackleton2008]. All 21
// positions of both wheels count, also those of conformal and of two-point contact.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "manchester_wheelset.hpp"

namespace railtab {
namespace {

TEST(ManchesterLoaded, NormalForceOfAllPositionsAgainstContact) {
  const ManchesterWheelset wheelset;
  const ContactGeometry& geometry = wheelset.geometry();
  const NormalContactModel& model = wheelset.model();

  const auto reference = testing::read_reference("manchester_loaded.csv");
  const auto value = [&](const char* column, std::size_t row) { return reference.at(column)[row]; };
  const std::size_t rows = reference.at("side").size();
  double approach = 0.0, worst = 0.0, squares = 0.0, worst_published = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    const double side = value("side", row);
    const WheelsetPose pose{side * value("y_ws", row) * 1e-3, value("z_ws", row) * 1e-3, side * value("roll_ws", row),
                            side * value("yaw_ws", row)};
    const ContactPatches patches = geometry.patches(pose);
    const PatchLoads loads = patch_loads(model, geometry, pose, patches);
    const double reference_force = value("normal_force", row);
    double force = 0.0, published = 0.0, deepest = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
      const ContactPatch& p = patches.patch[i];
      force += loads[i].elastic_force;
      deepest = std::max(deepest, p.penetration);
      if (p.penetration <= 0.0) continue;
      const HertzContact point =
          hertz_contact(0.5 * p.curv_rolling, std::max(0.5 * (p.curv_wheel + p.curv_rail), 1e-6), model.material);
      published += point.stiffness * std::pow(p.penetration, 1.5);
    }
    const double error = force / reference_force - 1.0;
    approach = std::max(approach, std::abs(deepest / (value("approach", row) * 1e-3) - 1.0));
    worst = std::max(worst, std::abs(error));
    worst_published = std::max(worst_published, std::abs(published / reference_force - 1.0));
    squares += error * error;
    EXPECT_LT(std::abs(error), 0.09) << "case A" << value("case", row) << ", side " << side
                                     << ", y = " << value("y_ws", row) << " mm";
  }
  const double rms = std::sqrt(squares / static_cast<double>(rows));
  testing::measured("manchester.loaded.rms_percent", 100 * rms);
  testing::measured("manchester.loaded.largest_percent", 100 * worst);
  testing::measured("manchester.loaded.largest_at_point_percent", 100 * worst_published);
  testing::measured("manchester.loaded.penetration_percent", 100 * approach);
  EXPECT_EQ(rows, 84u);
  EXPECT_LT(rms, 0.015);
  EXPECT_LT(approach, 0.01);
  EXPECT_LT(4.0 * worst, worst_published);
}

}  // namespace
}  // namespace railtab
