#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "../measured.hpp"
#include "../reference_table.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tablegen/creep_layout.hpp"
#include "railtab/tablegen/creep_verification.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab {
namespace {

const TableCreep& shipped() {
  static const TableCreep law = std::get<TableCreep>(creep_law("table", 0.28));
  return law;
}

TEST(ShippedCreepTable, AgreesWithTheExactSolutionBetweenItsNodes) {
  CreepVerificationOptions options;
  options.samples = 400;
  options.seed = 17;
  options.timing = false;
  const CreepVerification v = verify_creep_table(shipped(), options);
  std::printf("force mean %.5f p99 %.5f max %.5f, moment mean %.5f p99 %.5f max %.5f\n", v.table.force.mean,
              v.table.force.p99, v.table.force.max, v.table.moment.mean, v.table.moment.p99, v.table.moment.max);
  EXPECT_EQ(v.outside, 0);
  EXPECT_LT(v.table.force.mean, 0.0006);
  EXPECT_LT(v.table.force.max, 0.02);
  EXPECT_LT(v.table.moment.mean, 0.0005);
  EXPECT_LT(v.table.moment.max, 0.02);
  // and beats every other law by far
  for (const CreepLawErrors& law : v.laws) EXPECT_GT(law.force.mean, 10.0 * v.table.force.mean) << law.name;
}

TEST(ShippedCreepTable, AgreesWithContact) {
  // CONTACT at 120 x 120 elements is itself some 0.0013 away from the limit of small ones.
  auto t = testing::read_reference("creep_exact.csv");
  double sum = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    const CreepForce f = creep_force(shipped(), t["ratio"][i], {t["ux"][i], t["uy"][i], t["phi"][i]});
    const double error = std::hypot(f.x - t["fx"][i], f.y - t["fy"][i]);
    sum += error;
    largest = std::max(largest, error);
  }
  const double mean = sum / static_cast<double>(t["ratio"].size());
  testing::measured("creep_table.contact.mean", mean);
  testing::measured("creep_table.contact.max", largest);
  EXPECT_LT(mean, 0.0025);
  EXPECT_LT(largest, 0.02);
}

TEST(ShippedCreepTable, IsNearTheExactSolutionWhereInterpolationIsHard) {
  auto t = testing::read_reference("creep_hard_cases.csv");
  double force = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    const CreepForce f = creep_force(shipped(), t["ratio"][i], {t["ux"][i], t["uy"][i], t["phi"][i]});
    force = std::max(force, std::hypot(f.x - t["fx"][i], f.y - t["fy"][i]));
    moment = std::max(moment, std::abs(f.moment - t["mz"][i]));
  }
  testing::measured("creep_table.hard.force", force);
  testing::measured("creep_table.hard.moment", moment);
  EXPECT_EQ(t["ratio"].size(), 41U);
  EXPECT_LT(force, 0.02);
  EXPECT_LT(moment, 0.02);
}

TEST(ShippedCreepTable, FollowsLinearTheoryAtSmallCreepage) {
  auto t = testing::read_reference("creep_cij.csv");
  int checked = 0;
  for (std::size_t i = 0; i < t["ratio"].size(); ++i) {
    if (t["nu"][i] != 0.28 || t["ratio"][i] < 0.1 || t["ratio"][i] > 2.0) continue;
    const CreepLookup f = shipped().table->lookup(t["ratio"][i], {0.0, 0.0, 0.0});
    // The limit of the extrapolated 40 x 40 elements, see docs/theory/rolling_contact.md, section 5.
    EXPECT_NEAR(-f.derivative[0][0] / t["c11"][i], 1.0, 0.006) << t["ratio"][i];
    EXPECT_NEAR(-f.derivative[1][1] / t["c22"][i], 1.0, 0.006) << t["ratio"][i];
    EXPECT_NEAR(-f.derivative[1][2] / t["c23"][i], 1.0, 0.01) << t["ratio"][i];
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

TEST(TableCreep, IsFiniteAndSaturatesEverywhere) {
  const double huge = std::numeric_limits<double>::max();
  for (const double ratio : {1e-9, 1e-4, 1e-3, 0.01, 1.0, 700.0, 1e3, 1e4, 1e9}) {
    const double arm = std::max(std::sqrt(ratio), 1.0 / std::sqrt(ratio));
    for (const double size : {0.0, 1e-300, 1e-9, 1e-3, 1.0, 1e3, 1e30, 1e200, huge}) {
      for (const Creepage& d : {Creepage{1, 0, 0}, Creepage{0, 1, 0}, Creepage{0, 0, 1}, Creepage{-1, 0.3, -0.6}}) {
        const CreepForce f = creep_force(shipped(), ratio, {size * d.x, size * d.y, size * d.spin});
        ASSERT_TRUE(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.moment)) << ratio << ' ' << size;
        // Polach adds a lateral force of spin to the full force of the creepages.
        const bool table = shipped().share(ratio, {size * d.x, size * d.y, size * d.spin}) == 1.0;
        EXPECT_LE(std::hypot(f.x, f.y), table ? 1.02 : 2.0) << ratio << ' ' << size;
        EXPECT_LE(std::abs(f.moment), arm) << ratio << ' ' << size;
        if (size == 0.0) {
          EXPECT_EQ(std::hypot(f.x, f.y, f.moment), 0.0);
        }
      }
    }
  }
}

TEST(TableCreep, FadesIntoPolachWithoutAJump) {
  const Creepage u{0.02, -0.01, 0.003};
  for (const double border : {1e-3, 1.25e-3, 800.0, 1e3}) {
    const CreepForce below = creep_force(shipped(), border * (1 - 1e-9), u);
    const CreepForce above = creep_force(shipped(), border * (1 + 1e-9), u);
    EXPECT_NEAR(below.x, above.x, 1e-6);
    EXPECT_NEAR(below.y, above.y, 1e-6);
    EXPECT_NEAR(below.moment, above.moment, 1e-5);
  }
  const CreepForce outside = creep_force(shipped(), 2e3, u), polach = creep_force(PolachCreep{}, 2e3, u);
  EXPECT_EQ(outside.x, polach.x);
  EXPECT_EQ(outside.moment, polach.moment);
  EXPECT_EQ(shipped().share(2e3, u), 0.0);
  EXPECT_EQ(shipped().share(1.0, u), 1.0);
}

TEST(TableCreep, IsForItsOwnPoissonsRatio) {
  EXPECT_NO_THROW(static_cast<void>(creep_law("table", 0.2805)));
  EXPECT_THROW(static_cast<void>(creep_law("table", 0.25)), InputError);
  EXPECT_THROW(static_cast<void>(creep_law("table", 0.28, "absent.h5")), InputError);
}

}  // namespace
}  // namespace railtab
