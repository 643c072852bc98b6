// A table of the loaded contact: its derivatives against differences, its forces against the half-space solution.

#include "railtab/tables/loaded_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>

#include "loaded_table_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/loaded_verification.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {
namespace {

/// Poses well inside the table, lowered by 10 to 80 µm.
class Poses {
 public:
  explicit Poses(double climb = 0.0) : climb_(climb) {}

  WheelsetPose next() {
    const double y0 = at(-2.6e-3, -0.9e-3), reduced_roll = at(-8e-4, 8e-4), yaw = at(-3.5e-3, 3.5e-3);
    constexpr double height = 0.75;  // above the rail, at which a roll leaves the contact about in its place [m]
    const double y = y0 + height / (1.0 + height * climb_) * reduced_roll, roll = reduced_roll - climb_ * y;
    return {y, s1002_on_60e1().touch_height(y, roll, yaw) + at(1e-5, 8e-5), roll, yaw};
  }

 private:
  double at(double low, double high) { return low + (high - low) * uniform_(random_); }
  double climb_;
  std::mt19937_64 random_{20261122};
  std::uniform_real_distribution<double> uniform_;
};

LoadedLookup look(const LoadedTable& table, const WheelsetPose& p) { return table.lookup(p.y, p.z, p.roll, p.yaw); }

WheelsetPose moved(const WheelsetPose& p, int coordinate, double by) {
  return {p.y + (coordinate == 0 ? by : 0.0), p.z + (coordinate == 1 ? by : 0.0), p.roll + (coordinate == 2 ? by : 0.0),
          p.yaw + (coordinate == 3 ? by : 0.0)};
}

void expect_derivatives_of_the_energy(const LoadedTable& table) {
  Poses poses(table.data().climb);
  int compared = 0;
  for (int n = 0; n < 200; ++n) {
    const WheelsetPose pose = poses.next();
    LoadedSlopes slopes;
    const LoadedLookup found = table.lookup(pose.y, pose.z, pose.roll, pose.yaw, slopes);
    ASSERT_GT(found.table_share, 0.0);
    ASSERT_GT(found.energy, 0.0);
    ASSERT_EQ(found.parts, 1U);
    constexpr double step = 2e-9;
    for (int j = 0; j < 4; ++j) {
      const LoadedLookup plus = look(table, moved(pose, j, step)), minus = look(table, moved(pose, j, -step));
      EXPECT_NEAR((plus.energy - minus.energy) / (2.0 * step), found.force[j], 1e-6 * found.force.norm());
      const Eigen::Vector4d column = (plus.force - minus.force) / (2.0 * step);
      // A difference across the border of a cell is no derivative: stiffness jumps there.
      if ((column - slopes.stiffness.col(j)).norm() > 1e-5 * slopes.stiffness.norm()) continue;
      ++compared;
      const auto a = plus.part[0].values(), b = minus.part[0].values(), value = found.part[0].values();
      for (std::size_t q = 0; q < LoadedPart::of_one; ++q) {
        EXPECT_NEAR((a[q] - b[q]) / (2.0 * step), slopes.part[0][q][j],
                    1e-5 * std::abs(slopes.part[0][q][j]) + 1e-6 * std::abs(value[q]) / 1e-5)
            << "quantity " << q << " along " << j;
      }
    }
  }
  EXPECT_GT(compared, 790);  // of 800
}

TEST(LoadedTable, ForcesStiffnessAndPartsHaveTheDerivativesOfTheEnergy) {
  expect_derivatives_of_the_energy(LoadedTable(tread_table()));
}

// Columns of Z are summed in pairs, and those of four nodes of roll and of yaw by code of their own.
TEST(LoadedTable, DerivativesAreRightWhateverTheNumberOfNodes) {
  for (const int yaw_nodes : {3, 4}) {
    for (const double roll_spacing : {5e-4, 1e-3}) {
      SCOPED_TRACE(fmt::format("{} nodes of yaw, roll every {} rad", yaw_nodes, roll_spacing));
      expect_derivatives_of_the_energy(LoadedTable(tread_table_of(yaw_nodes, roll_spacing)));
    }
  }
}

// From first touch, which the level is guessed from, down to the last level.
TEST(LoadedTable, EnergyGrowsFromFirstTouchToTheLastLevel) {
  const LoadedTable table(tread_table());
  Poses poses;
  for (int n = 0; n < 50; ++n) {
    WheelsetPose pose = poses.next();
    double above = pose.z - 1e-4, below = pose.z;
    for (int halving = 0; halving < 60; ++halving) {
      pose.z = 0.5 * (above + below);
      (look(table, pose).energy > 0.0 ? below : above) = pose.z;
    }
    EXPECT_LT(below - above, 1e-16);
    const double touch = below;
    EXPECT_LT(look(table, {pose.y, touch + 1e-9, pose.roll, pose.yaw}).energy, 1e-10);
    double energy = 0.0, z = touch;
    for (double share = 1.0; share > 0.0 && z < touch + 1e-3; z += 1e-6) {
      const LoadedLookup found = look(table, {pose.y, z + 1e-6, pose.roll, pose.yaw});
      share = found.table_share;
      if (share == 0.0) break;
      EXPECT_GT(found.energy, energy) << "at " << z - touch << " m below first touch";
      energy = found.energy;
    }
    EXPECT_GT(std::pow(energy, 0.2), 0.9 * table.data().largest_level);
    EXPECT_EQ(look(table, {pose.y, touch - 1e-6, pose.roll, pose.yaw}).energy, 0.0);
  }
}

// Squares of pressures are interpolated with weights whose sum is one: a pressure at every other lateral node only, and
// at those between only, add up to it everywhere.
TEST(LoadedTable, SquaresOfPressuresAreLinear) {
  constexpr float pressure = 536870912.0F;
  const auto every_other = [&](std::size_t begin) {
    LoadedTableData data = tread_table();
    float* part = data.part.data();
    for (std::size_t node = 0; node < data.pressed.size(); ++node) {
      const bool has = node / static_cast<std::size_t>(data.levels) % 2 == begin;
      const auto parts = static_cast<std::size_t>(std::popcount(data.pressed[node]));
      for (std::size_t k = 0; k < parts * data.columns(); ++k, part += LoadedPart::quantities) {
        part[LoadedPart::quantities - 1] = has ? pressure : 0.0F;
      }
    }
    return LoadedTable(data);
  };
  const LoadedTable even = every_other(0), odd = every_other(1);
  Poses poses;
  for (int n = 0; n < 100; ++n) {
    const WheelsetPose pose = poses.next();
    const LoadedLookup a = look(even, pose), b = look(odd, pose);
    ASSERT_EQ(a.parts, 1U);
    const double w = std::pow(a.energy, 0.2);
    EXPECT_NEAR(std::hypot(a.part[0].pressure, b.part[0].pressure) / (w * static_cast<double>(pressure)), 1.0, 1e-9);
  }
}

void expect_the_half_space_solution(const LoadedTable& table) {
  Poses poses(table.data().climb);
  for (int n = 0; n < 25; ++n) {
    const WheelsetPose pose = poses.next();
    const LoadedLookup found = look(table, pose);
    LoadedContactOptions options;
    options.elements.across_narrowest = 40;
    const LoadedContact exact = loaded_contact(s1002_on_60e1(), pose, options);
    const WheelsetCentre centre = wheelset_centre(s1002_on_60e1().pair(), pose);
    const Eigen::Vector3d moment = exact.on_rail.moment_about({0.0, centre.y, centre.z});
    EXPECT_NEAR(found.energy, exact.elastic_energy, 6e-3 * exact.elastic_energy);
    EXPECT_NEAR(found.force[0], exact.on_rail.force.y(), 6e-3 * exact.normal_force);
    EXPECT_NEAR(found.force[1], exact.on_rail.force.z(), 6e-3 * exact.normal_force);
    EXPECT_NEAR(found.force[2], moment.x(), 6e-3 * std::abs(moment.x()));
    const LoadedPart& part = found.part[0];
    const ContactBand& band = exact.bands.front();
    EXPECT_NEAR(part.angle, band.angle, 5e-4);
    EXPECT_NEAR(part.a, band.a, 0.03 * band.a);
    EXPECT_NEAR(part.b, band.b, 0.03 * band.b);
    EXPECT_NEAR(part.s_rail, band.s_rail, 0.05 * band.b);
    EXPECT_NEAR(part.pressure, exact.largest_pressure, 0.04 * exact.largest_pressure);
  }
}

TEST(LoadedTable, AgreesWithTheHalfSpaceSolution) { expect_the_half_space_solution(LoadedTable(tread_table())); }

// At a shift of -2 mm the nodes of 0.75 rad/m lie about a roll of 1.5 mrad, which is beyond those of the other table.
TEST(LoadedTable, FollowsAWheelsetThatClimbs) {
  LoadedSweepOptions options = tread_options();
  options.climb = 0.75;
  const LoadedTable table(sweep_loaded(s1002_on_60e1(), options)), other(tread_table());
  expect_derivatives_of_the_energy(table);
  expect_the_half_space_solution(table);
  const double y = -2e-3, roll = 1.5e-3, z = s1002_on_60e1().touch_height(y, roll, 0.0) + 5e-5;
  EXPECT_EQ(table.lookup(y, z, roll, 0.0).table_share, 1.0);
  EXPECT_EQ(other.lookup(y, z, roll, 0.0).table_share, 0.0);
}

TEST(LoadedTable, ForcesDoNoWorkOnClosedPaths) {
  const LoadedTable table(tread_table());
  Poses poses;
  for (int n = 0; n < 20; ++n) {
    const WheelsetPose centre = poses.next();
    const auto at = [&](double angle) {
      const double c = std::cos(angle), s = std::sin(angle + 0.1 * n);
      return WheelsetPose{centre.y + 1e-4 * c, centre.z - 1e-5 + 2e-5 * s, centre.roll + 1e-5 * s,
                          centre.yaw + 4e-4 * c * s};
    };
    constexpr int steps = 4000;
    const auto coordinates = [](const WheelsetPose& p) { return Eigen::Vector4d(p.y, p.z, p.roll, p.yaw); };
    double work = 0.0, amount = 0.0;
    WheelsetPose before = at(0.0);
    for (int i = 1; i <= steps; ++i) {
      const WheelsetPose next = at(2.0 * std::numbers::pi * i / steps);
      ASSERT_GT(look(table, next).table_share, 0.0);
      const double step =
          0.5 * (look(table, before).force + look(table, next).force).dot(coordinates(next) - coordinates(before));
      work += step;
      amount += std::abs(step);
      before = next;
    }
    EXPECT_GT(amount, 0.05);
    EXPECT_LT(std::abs(work), 1e-5 * amount);  // of the trapezoidal rule
  }
}

TEST(LoadedTable, ForcesHaveNoStepsAlongLines) {
  const LoadedTable table(tread_table());
  Poses poses;
  for (int n = 0; n < 40; ++n) {
    const WheelsetPose from = poses.next(), to = poses.next();
    const auto force = [&](double t) {
      return look(table, {from.y + t * (to.y - from.y), from.z + t * (to.z - from.z),
                          from.roll + t * (to.roll - from.roll), from.yaw + t * (to.yaw - from.yaw)})
          .force;
    };
    constexpr int points = 500;
    double low = 0.0, high = 1.0, largest = 0.0;
    for (int i = 0; i < points; ++i) {
      const double t = static_cast<double>(i) / points, next = t + 1.0 / points;
      const double change = (force(next) - force(t)).head<2>().norm();
      if (change > largest) {
        largest = change;
        low = t;
        high = next;
      }
    }
    // the half with the greater change, down to rounding of the place
    while (high - low > 1e-13) {
      const double middle = 0.5 * (low + high);
      ((force(middle) - force(low)).head<2>().norm() > (force(high) - force(middle)).head<2>().norm() ? high : low) =
          middle;
    }
    EXPECT_LT((force(high) - force(low)).head<2>().norm(), 1e-2) << "of " << largest << " N";
  }
}

TEST(LoadedTable, KnowsWhereItEnds) {
  const LoadedTable table(tread_table());
  const auto touch = [](double y) { return s1002_on_60e1().touch_height(y, 0.0, 0.0); };
  const double y = -2e-3;
  const LoadedLookup above = table.lookup(y, touch(y) - 1e-6, 0.0, 0.0);
  EXPECT_EQ(above.table_share, 1.0);
  EXPECT_EQ(above.energy, 0.0);
  EXPECT_EQ(above.parts, 0U);
  EXPECT_EQ(table.lookup(-3.1e-3, touch(-3.1e-3) + 5e-5, 0.0, 0.0).table_share, 0.0);
  EXPECT_EQ(table.lookup(y, touch(y) + 5e-5, 1.1e-3, 0.0).table_share, 0.0);
  EXPECT_EQ(table.lookup(y, touch(y) + 5e-5, 0.0, 4.1e-3).table_share, 0.0);
  EXPECT_EQ(table.lookup(y, touch(y) + 3e-4, 0.0, 0.0).table_share, 0.0);
  // smoothly
  double before = 1.0;
  for (double at = -2.8e-3; at > -3.0e-3; at -= 1e-6) {
    const double share = table.lookup(at, touch(at) + 5e-5, 0.0, 0.0).table_share;
    EXPECT_LE(share, before);
    EXPECT_LT(before - share, 0.02);
    before = share;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(LoadedTable, IsEvenInYaw) {
  const LoadedTable table(tread_table());
  Poses poses;
  const WheelsetPose pose = poses.next();
  const LoadedLookup found = look(table, pose), other = table.lookup(pose.y, pose.z, pose.roll, -pose.yaw);
  EXPECT_EQ(found.energy, other.energy);
  EXPECT_EQ(found.force[3], -other.force[3]);
  EXPECT_EQ(found.part[0].arm_x, -other.part[0].arm_x);
  EXPECT_EQ(found.part[0].arm_z, other.part[0].arm_z);
}

TEST(LoadedTable, RejectsArraysThatDoNotFit) {
  const auto broken = [](auto change) {
    LoadedTableData data = tread_table();
    change(data);
    EXPECT_THROW(LoadedTable{std::move(data)}, InputError);
  };
  broken([](LoadedTableData& d) { std::swap(d.lateral[0], d.lateral[1]); });
  broken([](LoadedTableData& d) { d.height.pop_back(); });
  broken([](LoadedTableData& d) { d.touch.push_back(0.0); });
  broken([](LoadedTableData& d) { d.shift.clear(); });
  broken([](LoadedTableData& d) { d.pressed.front() = 1U << 20; });
  broken([](LoadedTableData& d) { d.part.resize(d.part.size() / 2); });
  broken([](LoadedTableData& d) { d.levels = 2; });
  broken([](LoadedTableData& d) { d.climb = std::nan(""); });
  broken([](LoadedTableData& d) { d.largest_level = std::nan(""); });
  broken([](LoadedTableData& d) { d.cut.assign(20, 0.0); });
}

// A table of shifts at which the wheel is beside the rail: positions are not drawn for ever.
TEST(LoadedVerification, EndsWhereTheWheelMissesTheRail) {
  LoadedTableData data = tread_table();
  for (std::size_t i = 0; i < data.shift.size(); i += 2) data.shift[i] += 1.0;
  EXPECT_THROW(static_cast<void>(verify_loaded_table(s1002_on_60e1(), LoadedTable(data), {}, {})), ComputationError);
}

// Were roll drawn over ±1.5 mrad, two poses of three would lie beside a table of 0.5 to 1.5 mrad. Some do, which are
// shifted beyond its end as far as roll moves it.
TEST(LoadedVerification, DrawsRollWithinAnUnevenRange) {
  LoadedSweepOptions options = tread_options();
  options.roll = {5e-4, 1.5e-3};
  options.levels = 9;
  LoadedVerificationOptions few;
  few.samples = 100;
  few.approach = {5e-6, 40e-6};
  const LoadedTable table(sweep_loaded(s1002_on_60e1(), options));
  EXPECT_GT(verify_loaded_table(s1002_on_60e1(), table, few).answered, 60);
}

TEST(LoadedSweep, GoesOnFromTheColumnsItIsGiven) {
  LoadedSweepOptions options = tread_options();
  options.lateral = {-2.5e-3, -1.5e-3};
  options.levels = 7;
  LoadedColumnStore store;
  std::vector<LoadedSweepColumn> kept;
  store.keep = [&](const LoadedSweepColumn& column) { kept.push_back(column); };
  const LoadedTableData whole = sweep_loaded(s1002_on_60e1(), options, store);
  ASSERT_GT(kept.size(), 12U);
  LoadedColumnStore resumed;
  resumed.known.assign(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(kept.size() / 2));
  std::size_t more = 0;
  resumed.keep = [&](const LoadedSweepColumn&) { ++more; };
  const LoadedTableData again = sweep_loaded(s1002_on_60e1(), options, resumed);
  EXPECT_EQ(more, kept.size() - kept.size() / 2);
  EXPECT_EQ(again.lateral, whole.lateral);
  EXPECT_EQ(again.height, whole.height);
  EXPECT_EQ(again.part, whole.part);
  EXPECT_EQ(again.statistics, whole.statistics);
}

TEST(LoadedSweep, RejectsOptionsOutOfRange) {
  const auto broken = [](auto change) {
    LoadedSweepOptions options = tread_options();
    change(options);
    EXPECT_THROW(static_cast<void>(sweep_loaded(s1002_on_60e1(), options)), InputError);
  };
  broken([](LoadedSweepOptions& o) { o.lateral = {1e-3, -1e-3}; });
  broken([](LoadedSweepOptions& o) { o.yaw = -1e-3; });
  broken([](LoadedSweepOptions& o) { o.levels = 4; });
  broken([](LoadedSweepOptions& o) { o.roll_spacing = 0.0; });
  broken([](LoadedSweepOptions& o) { o.largest_load = 0.0; });
  broken([](LoadedSweepOptions& o) { o.climb = -0.5; });
}

TEST(ContactJumps, OfTheStandardPairAreThree) {
  // The jumps lie at 0.214, 5.02 and 6.605 mm (wide tread, root, flange), the contact's places 6 mm and more apart.
  const std::vector<ContactJump> jumps = contact_jumps(s1002_on_60e1(), {-8e-3, 8e-3}, 0.0, 0.0);
  ASSERT_EQ(jumps.size(), 3U);
  EXPECT_NEAR(jumps[0].y, 0.214e-3, 5e-6);
  EXPECT_NEAR(jumps[1].y, 5.02e-3, 2e-5);
  EXPECT_NEAR(jumps[2].y, 6.605e-3, 2e-5);
  for (const ContactJump& jump : jumps) {
    const double cut = widest_gap(s1002_on_60e1(), jump);
    EXPECT_GT(cut, std::min(jump.s_below, jump.s_above));
    EXPECT_LT(cut, std::max(jump.s_below, jump.s_above));
  }
}

TEST(LateralWarp, GoesThroughTheJumpsWithAContinuousSlope) {
  const LateralWarp warp({0.0, 5e-3, 6.6e-3}, {3.6e-3, 7.6e-3, 9.0e-3}, 0.0);
  EXPECT_NEAR(warp.at(0.0).y, 3.6e-3, 1e-15);
  EXPECT_NEAR(warp.at(5e-3).y, 7.6e-3, 1e-15);
  EXPECT_NEAR(warp.at(6.6e-3).y, 9.0e-3, 1e-15);
  EXPECT_NEAR(warp.at(-1e-3).y, 2.6e-3, 1e-15);
  for (double y0 = -1e-3; y0 < 8e-3; y0 += 1.3e-4) {
    constexpr double step = 1e-8;
    EXPECT_NEAR((warp.at(y0 + step).y - warp.at(y0 - step).y) / (2.0 * step), warp.at(y0).slope, 1e-4);
    EXPECT_GT(warp.at(y0).slope, 0.5);
  }
  EXPECT_NEAR(LateralWarp({}, {}, 2e-3).at(1e-3).y, 3e-3, 1e-15);
}

// S1002 with 1 mm worn off the tread and 0.4 mm off the root.
const ContactSearch& hollow_on_60e1() {
  static const ContactSearch search = [] {
    ProfileKnots wheel = standard_profile(ProfileKind::wheel, "S1002", 0.0);
    for (std::size_t i = 0; i < wheel.y.size(); ++i) {
      const double tread = (wheel.y[i] - 0.002) / 0.014, root = (wheel.y[i] + 0.033) / 0.006;
      wheel.z[i] -= 1e-3 * std::exp(-tread * tread) + 0.4e-3 * std::exp(-root * root);
    }
    return ContactSearch(
        WheelRailPair(ProfileCurve(spline_through_points(ProfileKind::wheel, "hollow", wheel.y, wheel.z)),
                      ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), PairDimensions{}));
  }();
  return search;
}

TEST(ContactJumps, AreFollowedWhereTheySplitAndMerge) {
  const std::vector<ContactJump> whole{{-1e-3, 79e-3, 49e-3}, {6.5e-3, 45e-3, 30e-3}};
  const std::vector<ContactJump> split{{-4e-3, 78e-3, 48e-3}, {4.0e-3, 44e-3, 39e-3}, {4.1e-3, 39e-3, 30e-3}};
  const std::vector<std::optional<double>> after = same_jumps(whole, split), before = same_jumps(split, whole);
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after[0], -4e-3);
  EXPECT_EQ(after[1], 4.1e-3);  // the wider part
  ASSERT_EQ(before.size(), 3U);
  EXPECT_EQ(before[0], -1e-3);
  EXPECT_FALSE(before[1].has_value());
  EXPECT_EQ(before[2], 6.5e-3);
  EXPECT_FALSE(same_jumps(whole, {{1e-3, 48e-3, 46e-3}})[0].has_value());  // elsewhere on the rail
}

// The root's jump of the hollow wheel from 45 to 30 mm along the rail is at a roll of -5 mrad two jumps, 0.1 mm apart.
TEST(LoadedSweep, FollowsAJumpThatSplitsWithRoll) {
  const ContactSearch& search = hollow_on_60e1();
  ASSERT_EQ(contact_jumps(search, {6e-3, 7e-3}, 0.0, 0.0).size(), 1U);
  ASSERT_EQ(contact_jumps(search, {3.7e-3, 4.4e-3}, -5e-3, 0.0).size(), 2U);
  LoadedSweepOptions options;
  options.lateral = {6.4e-3, 6.6e-3};
  options.roll = {-5e-3, 0.0};
  options.yaw = 0.0;
  options.roll_spacing = 0.1;
  options.levels = 5;
  options.largest_load = 50e3;
  options.force_error = options.light_error = 0.1;
  options.least_interval = 2e-5;
  options.contact.elements.across_narrowest = 10;
  const LoadedTableData data = sweep_loaded(search, options);
  const double jump = contact_jumps(search, options.lateral, 0.0, 0.0).front().y;
  ASSERT_EQ(data.parts(), 2U);
  const auto node = std::find(data.lateral.begin(), data.lateral.end(), jump) - data.lateral.begin();
  ASSERT_LT(node, std::ssize(data.lateral));
  for (std::size_t k = 0; k < data.columns(); ++k) {
    const double y = data.shift[2 * (static_cast<std::size_t>(node) * data.columns() + k)];
    const auto place = [&](double at) { return search.first_touch(at, data.roll[k], 0.0).s_rail; };
    EXPECT_GT(place(y - 1e-8) - place(y + 1e-8), 8e-3) << "at roll " << data.roll[k];
  }
}

// From a shift of 5.1 mm on, at roll 0, the contact of an LMA-type wheel reaches a strip of greater curvature; on the
// tread it does not, nor does that of S1002.
TEST(LoadedSweep, HalvesIntervalsOfRollWherePressuresBeginToRise) {
  const ContactSearch lma(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "LMA-type", 0.0)),
                                        ProfileCurve(standard_profile(ProfileKind::rail, "CHN60", 1.0 / 40.0)),
                                        PairDimensions{.flange_back = 1.353, .nominal_radius = 0.4575}));
  LoadedSweepOptions options;
  options.roll = {-1e-3, 1e-3};
  options.yaw = 2e-3;
  options.yaw_nodes = 2;
  options.levels = 9;
  options.largest_load = 50e3;
  options.force_error = options.light_error = 0.1;
  options.contact.elements.across_narrowest = 14;
  const std::vector<double> whole{-1e-3, 0.0, 1e-3}, halved{-1e-3, -5e-4, 0.0, 5e-4, 1e-3};
  const Interval tread{-3e-3, -2.7e-3};
  options.lateral = tread;
  EXPECT_EQ(sweep_loaded(s1002_on_60e1(), options).roll, whole);
  EXPECT_EQ(sweep_loaded(lma, options).roll, whole);
  options.lateral = {4.9e-3, 5.2e-3};
  std::vector<LoadedSweepColumn> kept;
  const LoadedTableData data = sweep_loaded(
      lma, options, {.known = {}, .keep = [&](const LoadedSweepColumn& column) { kept.push_back(column); }});
  EXPECT_EQ(data.roll, halved);
  kept.resize(kept.size() / 2);
  EXPECT_EQ(sweep_loaded(lma, options, {.known = kept, .keep = {}}).height, data.height);

  const LoadedTable table(data);
  for (const double y0 : {4.95e-3, 5.05e-3, 5.15e-3}) {
    for (const double roll : {-2.5e-4, 2.5e-4}) {
      const double y = y0 + 0.4575 * roll;
      const LoadedContact exact = contact_at_load(lma, {.y = y, .roll = roll}, 10e3, options.contact).contact;
      const LoadedLookup found = table.lookup(y, exact.pose.z, roll, 0.0);
      EXPECT_NEAR(found.largest_pressure() / exact.largest_pressure, 1.0, 0.05) << "y0 " << y0 << ", roll " << roll;
    }
  }
}

// A table that its own generation has found to be wrong is read only where it is asked for.
TEST(LoadedTable, IsNotUsedUnaskedWhereItsCertifiedErrorIsLarge) {
  GeometrySweepOptions options;
  options.lateral = {-0.003, -0.002};
  options.yaw = options.roll = {0.0, 0.0};
  GeometryTableData data = sweep_geometry(s1002_on_60e1(), options);
  data.loaded = tread_table();
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("railtab_certified_{}.h5", getpid());
  for (const double error : {0.01, 0.3}) {
    data.loaded->statistics = {{"certified.error.force.p99", error}};
    write_geometry_table(file, data);
    ContactParameters contact;
    contact.table = file;
    const ContactGeometry automatic = scene_geometry(contact);
    EXPECT_EQ(automatic.loaded() != nullptr, error == 0.01);
    EXPECT_EQ(automatic.unused_loaded_error(), error == 0.01 ? 0.0 : error);
    EXPECT_EQ(read_contact_table(file).geometry.loaded() != nullptr, error == 0.01);
    contact.elastic = ElasticContact::half_space;
    const ContactGeometry asked = scene_geometry(contact);
    EXPECT_NE(asked.loaded(), nullptr);
    EXPECT_EQ(asked.unused_loaded_error(), 0.0);
  }
  std::filesystem::remove(file);
}

// Below the table's deepest level the force of its margin falls before that of the patches rises.
TEST(LoadedTable, ALoadIsCarriedAtTheLeastLowering) {
  LoadedTableData data = tread_table();
  data.contact_modulus *= 0.6;  // softer patches, so that forces fall
  const ContactGeometry geometry(s1002_on_60e1(), std::make_shared<LoadedTable>(data));
  const NormalContactModel normal = table_material(geometry);
  int falling = 0;
  for (double y = -2.7e-3; y < -0.8e-3; y += 0.1e-3) {
    WheelsetPose touch{y, s1002_on_60e1().touch_height(y, 0.0, 0.0), 0.0, 0.0};
    const auto force = [&](double lowering) {
      return frictionless_force(geometry, {y, touch.z + lowering, 0.0, 0.0}, normal)[1];
    };
    // the peak of the force before it first falls, and a load that is carried there and deeper
    double lowering = 2e-5, peak = 0.0;
    while (lowering < 3e-4 && force(lowering) >= peak) {
      peak = force(lowering);
      lowering *= 1.001;
    }
    if (lowering >= 3e-4) continue;
    for (const double share : {0.9, 0.95}) {
      ++falling;
      const auto found = lowering_under_load(geometry, touch, share * peak, normal);
      ASSERT_TRUE(found);
      EXPECT_LT(*found, lowering) << "y = " << y << " m, load = " << share * peak << " N";
      EXPECT_NEAR(force(*found), share * peak, 1e-3);
    }
  }
  EXPECT_GT(falling, 30);
}

}  // namespace
}  // namespace railtab
