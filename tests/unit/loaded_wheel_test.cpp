// Forces of a wheel by a table of the loaded contact: tangents against differences, energy, creep forces against exact
// rolling contact.

#include "railtab/runtime/contact/loaded_wheel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "contact_power.hpp"
#include "loaded_table_fixture.hpp"
#include "railtab/runtime/base/dual.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tablegen/loaded_rolling.hpp"

namespace railtab {
namespace {

const ContactGeometry& geometry() {
  static const ContactGeometry loaded(s1002_on_60e1(), std::make_shared<const LoadedTable>(tread_table()));
  return loaded;
}

WheelContactModel model_with(CreepLaw law, double damping = 0.0) {
  WheelContactModel model;
  model.geometry = &geometry();
  model.creep_law = std::move(law);
  model.damping = damping;
  model.speed = 50.0;
  return model;
}

/// A wheel on its rail, both in motion.
struct State {
  WheelSide side;
  WheelsetMotion wheelset;
  RailHeadMotion rail;

  [[nodiscard]] WheelContact contact() const {
    return wheel_contact(geometry(), relative_pose(geometry().pair(), side, wheelset, rail));
  }
};

class States {
 public:
  enum class Rails { moving, still };
  explicit States(Rails rails = Rails::moving) : rails_(rails) {}

  State next(WheelSide side) {
    State s{side, {}, {}};
    const double mirror = side == WheelSide::right ? 1.0 : -1.0, roll = at(-5e-4, 5e-4);
    s.rail.displacement << at(-1e-4, 1e-4), at(-1e-4, 1e-4), at(-2e-4, 2e-4);
    s.rail.velocity << at(-0.01, 0.01), at(-0.01, 0.01), at(-0.1, 0.1);
    s.rail.yaw = at(-2e-4, 2e-4);
    s.rail.slope = at(-2e-4, 2e-4);
    s.wheelset.displacement << 0.0, mirror * at(-2.4e-3, -1.1e-3) + 0.75 * roll, 0.0, roll, 0.0, at(-3e-3, 3e-3);
    for (Eigen::Index i = 0; i < 6; ++i) s.wheelset.velocity[i] = at(-0.05, 0.05);
    if (rails_ == Rails::still) s.rail = {};
    const WheelsetPose pose = relative_pose(geometry().pair(), side, s.wheelset, s.rail);
    s.wheelset.displacement[2] += s1002_on_60e1().touch_height(pose.y, pose.roll, pose.yaw) - pose.z + at(2e-5, 7e-5);
    return s;
  }
  double at(double low, double high) { return low + (high - low) * uniform_(random_); }

 private:
  Rails rails_;
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> uniform_;
};

Vector9 total(const WheelForce& f) {
  Vector9 v;
  v << f.wheelset, f.rail;
  return v;
}

TEST(Dual, CarriesDerivativesAlong) {
  Dual<3> x(0.7);
  x.slope[2][1] = 1.0;
  const Dual<3> f = sqrt(2.0 - x / (1.0 + x * x)) - 3.0 / (x * x + 1.0);
  const auto of = [](double v) { return std::sqrt(2.0 - v / (1.0 + v * v)) - 3.0 / (v * v + 1.0); };
  EXPECT_NEAR(f.value, of(0.7), 1e-15);
  EXPECT_NEAR(f.slope[2][1], (of(0.7 + 1e-6) - of(0.7 - 1e-6)) / 2e-6, 1e-9);
  EXPECT_EQ(f.slope[0][0], 0.0);
}

TEST(CreepForceJet, IsTheDerivativeOfEveryLaw) {
  const Creepage c{0.4, -0.3, 0.5};
  for (const CreepLaw& law : {CreepLaw(LinearCreep{}), CreepLaw(PolachCreep{}), creep_law("table", 0.28)}) {
    const CreepForceJet jet = creep_force_jet(law, 1.7, c);
    const auto difference = [&](std::size_t j) {
      constexpr double step = 1e-5;
      const auto at = [&](double by) {
        return creep_force(law, 1.7 + (j == 0) * by,
                           {c.x + (j == 1) * by, c.y + (j == 2) * by, c.spin + (j == 3) * by});
      };
      const CreepForce plus = at(step), minus = at(-step);
      return std::array{(plus.x - minus.x) / (2.0 * step), (plus.y - minus.y) / (2.0 * step),
                        (plus.moment - minus.moment) / (2.0 * step)};
    };
    for (std::size_t j = 0; j < 4; ++j) {
      const auto d = difference(j);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(jet.derivative[i][j], d[i], 2e-5) << creep_law_name(law);
    }
  }
}

TEST(LoadedWheel, OneLookUpGivesForceAndTangent) {
  States states;
  constexpr double rate = 2000.0;
  const StepRates rates{Vector6::Constant(rate), rate, nullptr};
  for (int n = 0; n < 40; ++n) {
    const State s = states.next(n % 2 == 0 ? WheelSide::right : WheelSide::left);
    WheelContactModel model = model_with(creep_law("table", 0.28), n % 3 == 0 ? 0.02 : 0.0);
    if (n % 4 == 1) model.friction_law = {.limit = 0.4, .decay = 8.0, .initial_slope = 0.7};
    const WheelContact contact = s.contact();
    const WheelForce force = wheel_force(model, s.side, s.wheelset, s.rail, contact);
    const WheelResponse found = wheel_response(model, s.side, s.wheelset, s.rail, rates);
    EXPECT_EQ(found.contact.loaded.table_share, 1.0);
    EXPECT_LT((total(found.force) - total(force)).norm(), 1e-12 * total(force).norm());
    EXPECT_NEAR(found.force.creep_power, force.creep_power, 1e-12 * std::abs(force.creep_power));
    EXPECT_NEAR(found.force.pressure, force.pressure, 1e-12 * force.pressure);
    EXPECT_EQ(found.force.outside_creep_table, force.outside_creep_table);
    const Matrix9 tangent = wheel_force_tangent(model, s.side, s.wheelset, s.rail, contact, rates);
    EXPECT_LT((found.tangent - tangent).norm(), 1e-12 * tangent.norm());
  }
}

// A table over the jump at 0.2 mm, beside which two parts of the rail bear load, and merge. Coarse: the same look-ups
// in two ways are compared, not the table with the contact.
const ContactGeometry& geometry_over_jump() {
  static const ContactGeometry geometry = [] {
    LoadedSweepOptions options = tread_options();
    options.lateral = {-0.6e-3, 1.0e-3};
    options.climb = 0.2;
    options.yaw_nodes = 4;  // with four nodes of roll as in ordinary tables
    options.force_error = 0.1;
    options.light_error = 0.1;
    options.levels = 9;
    options.contact.elements.across_narrowest = 8;
    return ContactGeometry(s1002_on_60e1(),
                           std::make_shared<const LoadedTable>(sweep_loaded(s1002_on_60e1(), options)));
  }();
  return geometry;
}

/// 53 wheels at 10 to 100 kN or so, among them some in the air, on the border of the table and outside, and rails
/// without friction.
std::vector<WheelState> mixed_wheels(const ContactGeometry& geometry, double middle) {
  States states;
  std::vector<WheelState> wheels;
  for (int n = 0; n < 53; ++n) {
    State s = states.next(n % 2 == 0 ? WheelSide::right : WheelSide::left);
    const WheelsetPose pose = relative_pose(geometry.pair(), s.side, s.wheelset, s.rail);
    const double across = middle + states.at(-5e-4, 5e-4) - pose.y;
    s.wheelset.displacement[1] += s.side == WheelSide::right ? across : -across;
    const WheelsetPose moved = relative_pose(geometry.pair(), s.side, s.wheelset, s.rail);
    s.wheelset.displacement[2] +=
        s1002_on_60e1().touch_height(moved.y, moved.roll, moved.yaw) - moved.z + states.at(2e-5, 7e-5);
    if (n % 16 == 5 || n >= 48) s.wheelset.displacement[2] -= 1e-3;
    if (n % 16 == 9) s.wheelset.displacement[5] = 3.95e-3;
    if (n % 16 == 11) s.wheelset.displacement[1] += 0.02;
    if (n % 16 == 14) s.rail.friction = 0.0;
    wheels.push_back({s.side, s.wheelset, s.rail});
  }
  return wheels;
}

void expect_same(const WheelsetPose& of, const WheelsetPose& one) {
  EXPECT_NEAR(of.y, one.y, 1e-15);
  EXPECT_NEAR(of.z, one.z, 1e-15);
  EXPECT_NEAR(of.roll, one.roll, 1e-15);
  EXPECT_NEAR(of.yaw, one.yaw, 1e-15);
}

void expect_same_contact(const WheelResponse& of, const WheelResponse& one) {
  const LoadedLookup &found = of.contact.loaded, &expected = one.contact.loaded;
  expect_same(of.contact.pose, one.contact.pose);
  EXPECT_NEAR(found.table_share, expected.table_share, 1e-12);
  EXPECT_NEAR(found.energy, expected.energy, 1e-10 * expected.energy);
  EXPECT_LE((found.force - expected.force).cwiseAbs().maxCoeff(), 1e-10 * expected.force.norm());
  ASSERT_EQ(found.parts, expected.parts);
  for (std::size_t p = 0; p < expected.parts; ++p) {
    const auto a = found.part[p].values(), b = expected.part[p].values();
    for (std::size_t q = 0; q < a.size(); ++q)
      EXPECT_NEAR(a[q], b[q], 1e-9 * std::abs(b[q]) + 1e-14) << "quantity " << q;
  }
  const LoadedMemory &memory = of.force.memory, &kept = one.force.memory;
  EXPECT_NEAR(memory.weight, kept.weight, 1e-12);
  if (kept.weight == 0.0) return;
  expect_same(memory.pose, kept.pose);
  EXPECT_NEAR(memory.energy, kept.energy, 1e-10 * kept.energy);
  EXPECT_LE((memory.force - kept.force).cwiseAbs().maxCoeff(), 1e-10 * kept.force.norm());
}

void expect_same(const WheelResponse& of, const WheelResponse& one) {
  const double size = total(one.force).norm();
  EXPECT_LE((total(of.force) - total(one.force)).norm(), 1e-10 * size);
  EXPECT_LE((of.tangent - one.tangent).norm(), 1e-9 * one.tangent.norm());
  EXPECT_NEAR(of.force.creep_power, one.force.creep_power, 1e-9 * std::abs(one.force.creep_power));
  EXPECT_NEAR(of.force.pressure, one.force.pressure, 1e-10 * one.force.pressure);
  EXPECT_EQ(of.force.outside_creep_table, one.force.outside_creep_table);
  EXPECT_LE((of.force.memory.total - one.force.memory.total).norm(), 1e-10 * size);
  EXPECT_LE((of.force.memory.rest - one.force.memory.rest).norm(), 1e-10 * size);
  EXPECT_EQ(of.contact.patches.count, one.contact.patches.count);
  ASSERT_EQ(of.contact.loaded.parts, one.contact.loaded.parts);
  EXPECT_NEAR(of.contact.loaded.energy, one.contact.loaded.energy, 1e-10 * one.contact.loaded.energy);
  for (std::size_t p = 0; p < one.contact.loaded.parts; ++p) {
    EXPECT_NEAR(of.force.normal[p], one.force.normal[p], 1e-10 * size);
  }
  expect_same_contact(of, one);
}

TEST(LoadedWheel, WheelsSideBySideAreThoseOfSingleOnes) {
  constexpr double rate = 2000.0;
  const StepRates rates{Vector6::Constant(rate), rate, nullptr};
  int alone = 0, several_parts = 0;
  for (const bool jump : {false, true}) {
    for (const CreepLaw& law : {creep_law("table", 0.28), CreepLaw(PolachCreep{})}) {
      WheelContactModel model = model_with(law);
      if (jump) model.geometry = &geometry_over_jump();
      const std::vector<WheelState> wheels = mixed_wheels(*model.geometry, jump ? 0.2e-3 : -1.75e-3);
      std::vector<WheelResponse> responses(wheels.size());
      wheel_responses(model, wheels, rates, responses);
      for (std::size_t i = 0; i < wheels.size(); ++i) {
        const WheelState& w = wheels[i];
        SCOPED_TRACE(i);
        const WheelResponse one = wheel_response(model, w.side, w.wheelset, w.rail, rates);
        alone += one.contact.loaded.table_share == 1.0 && one.contact.touches() && w.rail.friction > 0.0;
        several_parts += one.contact.loaded.parts > 1;
        expect_same(responses[i], one);
      }
      std::vector<WheelResponse> forces(8);
      std::vector<LoadedAnswer> to;
      for (WheelResponse& of : forces) to.push_back({&of.contact.pose, &of.contact.loaded, &of.force});
      constexpr std::size_t count = WheelLanes::count;
      std::uint32_t answered = 0;
      for (std::size_t first = 0; first < to.size(); first += count) {
        answered |= loaded_wheel_forces(model, std::span(wheels).subspan(first, count), std::span(to).subspan(first))
                    << first;
      }
      EXPECT_EQ(answered, 0xdfU);  // the sixth is in the air
      for (std::size_t i = 0; i < 8; ++i) {
        if ((answered >> i & 1U) == 0) continue;
        EXPECT_LE((total(forces[i].force) - total(responses[i].force)).norm(), 1e-10 * total(forces[i].force).norm());
        expect_same_contact(forces[i], responses[i]);
      }
    }
  }
  EXPECT_GT(alone, 4 * 30);
  EXPECT_LT(alone, 4 * 40);
  EXPECT_GT(several_parts, 20);
}

TEST(LoadedWheel, TangentIsTheDerivativeInATimeStep) {
  States states;
  constexpr double rate = 2000.0, step = 2e-9;
  const StepRates rates{Vector6::Constant(rate), rate, nullptr};
  int compared = 0;
  for (int n = 0; n < 40; ++n) {
    const State s = states.next(n % 2 == 0 ? WheelSide::right : WheelSide::left);
    WheelContactModel model = model_with(creep_law("table", 0.28), n % 3 == 0 ? 0.02 : 0.0);
    if (n % 4 == 1) model.friction_law = {.limit = 0.4, .decay = 8.0, .initial_slope = 0.7};
    const WheelContact contact = s.contact();
    ASSERT_EQ(contact.loaded.table_share, 1.0);
    State before = s;
    before.wheelset.displacement[1] += states.at(-1e-5, 1e-5);
    before.wheelset.displacement[2] -= states.at(0.0, 4e-5);
    const WheelContact start = before.contact();
    const ContactMemory memory =
        contact_memory(geometry().pair(), start, wheel_force(model, s.side, before.wheelset, before.rail, start));
    for (const bool mean : {false, true}) {
      StepRates in_step = rates;
      in_step.start = mean ? &memory : nullptr;
      const Matrix9 tangent = wheel_force_tangent(model, s.side, s.wheelset, s.rail, contact, in_step);
      const auto force = [&](Eigen::Index j, double by) {
        State m = s;
        (j < 6 ? m.wheelset.displacement[j] : m.rail.displacement[j - 6]) += by;
        (j < 6 ? m.wheelset.velocity[j] : m.rail.velocity[j - 6]) += rate * by;
        const WheelContact at = m.contact();
        const WheelForce f = wheel_force(model, s.side, m.wheelset, m.rail, at);
        return mean ? mean_force(model, s.side, m.wheelset, m.rail, memory, at, f) : total(f);
      };
      for (Eigen::Index j = 0; j < 9; ++j) {
        const Vector9 forward = (force(j, step) - force(j, 0.0)) / step,
                      back = (force(j, 0.0) - force(j, -step)) / step;
        if ((forward - back).norm() > 1e-3 * tangent.norm()) continue;  // the border of a cell
        ++compared;
        EXPECT_LT((0.5 * (forward + back) - tangent.col(j)).norm(),
                  1e-4 * tangent.col(j).norm() + 1e-6 * tangent.norm())
            << "along " << j << (mean ? ", mean" : "");
      }
    }
  }
  EXPECT_GT(compared, 700);  // of 720
}

// A part beside another has the slopes of all its quantities, one by itself only of those that its force follows from.
TEST(LoadedWheel, PartsBesideOthersHaveAllTheirSlopes) {
  const LoadedTable& table = *geometry_over_jump().loaded();
  constexpr double step = 2e-9;
  int compared = 0;
  for (const WheelState& s : mixed_wheels(geometry_over_jump(), 0.2e-3)) {
    const WheelsetPose pose = relative_pose(geometry_over_jump().pair(), s.side, s.wheelset, s.rail);
    const std::array<double, 4> at{pose.y, pose.z, pose.roll, pose.yaw};
    const auto look = [&](std::size_t j, double by) {
      std::array<double, 4> moved = at;
      moved[j] += by;
      return table.lookup(moved[0], moved[1], moved[2], moved[3]);
    };
    LoadedSlopes slopes;
    const LoadedLookup found = table.lookup(pose.y, pose.z, pose.roll, pose.yaw, slopes);
    if (found.table_share < 1.0 || found.parts != 2) continue;
    for (std::size_t j = 0; j < 4; ++j) {
      const LoadedLookup plus = look(j, step), minus = look(j, -step);
      const Eigen::Vector4d column = (plus.force - minus.force) / (2.0 * step);
      if (plus.parts != 2 || minus.parts != 2) continue;
      if ((column - slopes.stiffness.col(static_cast<Eigen::Index>(j))).norm() > 1e-5 * slopes.stiffness.norm()) {
        continue;  // the border of a cell
      }
      ++compared;
      for (std::size_t p = 0; p < 2; ++p) {
        const auto a = plus.part[p].values(), b = minus.part[p].values(), value = found.part[p].values();
        const auto d = slopes.part[p].values();
        for (std::size_t q = 0; q < LoadedPart::quantities; ++q) {
          EXPECT_NEAR((a[q] - b[q]) / (2.0 * step), d[q][j], 1e-4 * std::abs(d[q][j]) + 0.1 * std::abs(value[q]))
              << "part " << p << ", quantity " << q << ", along " << j;
        }
      }
    }
  }
  EXPECT_GT(compared, 30);
}

// Two parts of a contact are two ellipses where the saddle between them is low, one where it is high.
TEST(LoadedWheel, PartsMergeByTheSaddleBetweenThem) {
  WheelContactModel model = model_with(creep_law("table", 0.28));
  model.geometry = &geometry_over_jump();
  int merging = 0;
  for (const WheelState& s : mixed_wheels(geometry_over_jump(), 0.2e-3)) {
    LoadedLookup lookup =
        wheel_contact(*model.geometry, relative_pose(model.geometry->pair(), s.side, s.wheelset, s.rail)).loaded;
    if (s.side != WheelSide::right || s.rail.friction == 0.0 || lookup.table_share < 1.0 || lookup.parts != 2) continue;
    ++merging;
    const double least = std::min(lookup.part[0].peak, lookup.part[1].peak);
    const auto force = [&](double saddle) {
      lookup.part[0].saddle = saddle * least;
      return total(loaded_wheel_force(model, s.side, s.wheelset, s.rail, lookup));
    };
    const Vector9 two = force(0.0), one = force(1.0);
    EXPECT_GT((one - two).norm(), 1e-5 * two.norm());
    EXPECT_EQ((force(0.25) - two).norm(), 0.0);
    EXPECT_EQ((force(0.35) - one).norm(), 0.0);
    EXPECT_LT((force(0.3) - 0.5 * (one + two)).norm(), 1e-9 * two.norm());
    // The derivative knows of the change: by the saddle's own along the shift.
    const auto along_shift = [&](double of_saddle) -> Vector9 {
      LoadedSlopes slopes{};
      slopes.part[0].saddle[0] = of_saddle;
      return loaded_wheel_response(model, s.side, s.wheelset, s.rail, lookup, slopes, {}, nullptr).tangent.col(1);
    };
    const Vector9 found = along_shift(least) - along_shift(0.0);
    EXPECT_LT((found - 1.5 / 0.1 * (one - two)).norm(), 1e-6 * found.norm());
  }
  EXPECT_GE(merging, 5);
}

// Both halves of a Hertzian contact, cut along the rail, have their mean point at 3/8 of its semi-axis; merged, they
// have its creep force.
TEST(LoadedWheel, HalvesOfAnEllipseMergeIntoIt) {
  States states;
  const WheelContactModel model = model_with(creep_law("table", 0.28));
  for (int n = 0; n < 10; ++n) {
    const State s = states.next(WheelSide::right);
    const LoadedLookup whole =
        wheel_contact(*model.geometry, relative_pose(model.geometry->pair(), s.side, s.wheelset, s.rail)).loaded;
    ASSERT_EQ(whole.parts, 1U);
    const double a = whole.part[0].a, b = whole.part[0].b;
    LoadedPart half = whole.part[0];
    half.share *= 0.5;
    half.saddle = half.peak;                              // as where they are cut
    const double second_moment = 1.0 - 5.0 * 9.0 / 64.0;  // of a half over b²/5
    const double scale = std::pow(0.5 / std::sqrt(second_moment), 0.25);
    half.a = scale * a;
    half.b = scale * b * std::sqrt(second_moment);
    LoadedLookup halves = whole;
    halves.parts = 2;
    halves.part[0] = halves.part[1] = half;
    halves.part[0].s_rail -= 0.375 * b;
    halves.part[1].s_rail += 0.375 * b;
    const auto creep = [&](const LoadedLookup& contact) -> Vector9 {
      WheelContactModel frictionless = model;
      frictionless.friction = 0.0;
      return total(loaded_wheel_force(model, s.side, s.wheelset, s.rail, contact)) -
             total(loaded_wheel_force(frictionless, s.side, s.wheelset, s.rail, contact));
    };
    const Vector9 expected = creep(whole);
    EXPECT_LT((creep(halves) - expected).head<2>().norm(), 0.01 * expected.head<2>().norm());
  }
}

TEST(LoadedWheel, LeftIsTheMirrorImageOfRight) {
  States states;
  const WheelContactModel model = model_with(creep_law("table", 0.28), 0.02);
  for (int n = 0; n < 10; ++n) {
    const State right = states.next(WheelSide::right);
    State left = right;
    left.side = WheelSide::left;
    for (const Eigen::Index i : {1, 3, 5}) {
      left.wheelset.displacement[i] *= -1.0;
      left.wheelset.velocity[i] *= -1.0;
    }
    for (const Eigen::Index i : {0, 2}) {
      left.rail.displacement[i] *= -1.0;
      left.rail.velocity[i] *= -1.0;
    }
    left.rail.yaw *= -1.0;
    Vector9 a = total(wheel_force(model, right.side, right.wheelset, right.rail, right.contact()));
    const Vector9 b = total(wheel_force(model, left.side, left.wheelset, left.rail, left.contact()));
    for (const Eigen::Index i : {1, 3, 5, 6, 8}) a[i] *= -1.0;
    EXPECT_LT((a - b).norm(), 1e-12 * a.norm());
  }
}

// Normal forces alone have the power that they have without friction.
TEST(LoadedWheel, CreepPowerIsWhatFrictionTakesFromTheMotion) {
  States states;
  WheelContactModel model = model_with(creep_law("table", 0.28), 0.0);
  model.friction_law = {.limit = 0.4, .decay = 0.6, .initial_slope = 0.7};
  WheelContactModel smooth = model;
  smooth.friction = 0.0;
  for (int n = 0; n < 40; ++n) {
    const State s = states.next(n % 2 == 0 ? WheelSide::right : WheelSide::left);
    const auto power = [&](const WheelForce& f) { return testing::power(model, f, s.wheelset, s.rail); };
    const WheelForce force = wheel_force(model, s.side, s.wheelset, s.rail, s.contact()),
                     normal = wheel_force(smooth, s.side, s.wheelset, s.rail, s.contact());
    EXPECT_GT(force.creep_power, 0.0);
    EXPECT_NEAR(force.creep_power, power(normal) - power(force), 1e-9 * std::abs(power(force)) + 1e-5);
    EXPECT_GT(force.pressure, 2e8);
    EXPECT_EQ(force.pressure, s.contact().loaded.largest_pressure());
  }
}

TEST(LoadedWheel, MeanForceDoesTheWorkOfTheEnergysChange) {
  States states(States::Rails::still);
  WheelContactModel model = model_with(LinearCreep{});
  model.friction = 0.0;
  for (int n = 0; n < 30; ++n) {
    State end = states.next(WheelSide::right);
    State start = end;
    start.wheelset.displacement[1] += states.at(-5e-5, 5e-5);
    start.wheelset.displacement[2] -= states.at(-2e-5, 2e-4);  // lifted off in most cases
    start.wheelset.displacement[3] += states.at(-1e-5, 1e-5);
    const WheelContact from = start.contact(), to = end.contact();
    const ContactMemory memory =
        contact_memory(geometry().pair(), from, wheel_force(model, start.side, start.wheelset, start.rail, from));
    const WheelForce force = wheel_force(model, end.side, end.wheelset, end.rail, to);
    const Vector9 mean = mean_force(model, end.side, end.wheelset, end.rail, memory, to, force);
    // on the wheelset, against the energy; roll turns about the track's x, which the force's moment is about
    const Vector6 path = end.wheelset.displacement - start.wheelset.displacement;
    const double work = -mean.head<6>().dot(path);
    EXPECT_NEAR(work, to.loaded.energy - from.loaded.energy, 1e-9 * to.loaded.energy + 1e-12);
  }
}

TEST(LoadedWheel, EquivalentDescentChangesTheEnergyAsAMotionDoes) {
  States states(States::Rails::still);
  const WheelContactModel model = model_with(LinearCreep{});
  const auto energy = [](const WheelsetPose& pose) { return wheel_contact(geometry(), pose).loaded.energy; };
  for (int n = 0; n < 20; ++n) {
    const State s = states.next(WheelSide::right);
    const WheelsetPose from = relative_pose(geometry().pair(), s.side, s.wheelset, s.rail);
    const WheelContact contact = s.contact();
    const LoadedWheelForce force = wheel_force(model, s.side, s.wheelset, s.rail, contact);
    const ContactMemory memory = contact_memory(geometry().pair(), contact, force);
    ASSERT_EQ(memory.loaded.weight, 1.0);
    const auto moved = [&](double share, const WheelsetPose& by) {
      return WheelsetPose{from.y + share * by.y, from.z + share * by.z, from.roll + share * by.roll,
                          from.yaw + share * by.yaw};
    };
    constexpr double h = 1e-8;
    const auto half_change = [&](const WheelsetPose& by) {
      return 0.5 * (energy(moved(1, by)) - energy(moved(-1, by)));
    };
    const double per_metre = half_change({0, h, 0, 0}) / h;
    EXPECT_GT(per_metre, 1e3);
    for (const WheelsetPose& by :
         {WheelsetPose{0, h, 0, 0}, {h, 0, 0, 0}, {0, 0, h, 0}, {0, 0, 0, h}, {h, -h, 2 * h, h}}) {
      const double descent = equivalent_descent(memory, force.normal, from, moved(1, by));
      EXPECT_NEAR(per_metre * descent, half_change(by), 1e-5 * per_metre * h);
    }
  }
}

// Before the step the table had no part in the contact: its energy then is not known.
TEST(LoadedWheel, MeanForceOfAStepIntoTheTableIsHalfOfThatAtItsEnd) {
  States states(States::Rails::still);
  WheelContactModel model = model_with(LinearCreep{});
  const State end = states.next(WheelSide::right);
  const WheelContact to = end.contact();
  const WheelForce force = wheel_force(model, end.side, end.wheelset, end.rail, to);
  const Vector9 mean = mean_force(model, end.side, end.wheelset, end.rail, ContactMemory{}, to, force);
  EXPECT_LT((mean - 0.5 * total(force)).norm(), 1e-9 * total(force).norm());
}

TEST(LoadedWheel, CreepForcesAreThoseOfExactRollingContact) {
  States states(States::Rails::still);
  const WheelContactModel model = model_with(creep_law("table", 0.28));
  for (int n = 0; n < 6; ++n) {
    State s = states.next(WheelSide::right);
    s.wheelset.velocity << 0.0, states.at(-0.03, 0.03), 0.0, 0.0, states.at(-0.15, 0.15), 0.0;
    const WheelContact contact = s.contact();
    ASSERT_EQ(contact.loaded.table_share, 1.0);
    WheelContactModel smooth = model;
    smooth.friction = 0.0;
    const Vector9 creep = total(wheel_force(model, s.side, s.wheelset, s.rail, contact)) -
                          total(wheel_force(smooth, s.side, s.wheelset, s.rail, contact));
    LoadedContactOptions material;
    material.elements.across_narrowest = 30;
    const LoadedContact exact = loaded_contact(s1002_on_60e1(), contact.pose, material);
    RelativeMotion motion = running_motion(contact.pose, model.speed,
                                           s.wheelset.velocity[4] - model.speed / geometry().pair().nominal_radius());
    motion.velocity.y() += s.wheelset.velocity[1];
    LoadedRollingOptions options;
    options.friction = model.friction;
    options.speed = model.speed;
    const LoadedRolling rolling = loaded_rolling(geometry().pair(), exact, material, motion, options);
    const double bound = model.friction * exact.normal_force;
    EXPECT_LT((creep.head<3>() + rolling.on_rail.force).norm(), 0.015 * bound)
        << creep.head<3>().transpose() / bound << " | " << -rolling.on_rail.force.transpose() / bound;
  }
}

}  // namespace
}  // namespace railtab
