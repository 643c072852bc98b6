// railtab/contact.h through the shared library, against the C++ functions that it stands for.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <thread>

#include "cpp_contact.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Every allocation of this program and of the shared library is counted.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace railtab::c_test {
namespace {

constexpr double rate = 80.0;  // dv/dq of the tangents [1/s]
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A table of the fixture.
std::string table_file(const std::string& name) { return std::string(RAILTAB_C_TABLES) + "/" + name; }

using Handle = std::unique_ptr<railtab_contact, void (*)(railtab_contact*)>;

railtab_contact_parameters parameters() {
  railtab_contact_parameters p;
  EXPECT_EQ(railtab_contact_default_parameters(&p), RAILTAB_OK);
  p.speed = speed;
  return p;
}

struct Opened {
  railtab_status status;
  Handle contact;
  std::string message;
};

Opened open(const std::string& file, const railtab_contact_parameters& p, const char* creep_table = nullptr) {
  railtab_contact* contact = nullptr;
  std::array<char, 400> message;
  const railtab_status status =
      railtab_contact_open(file.c_str(), creep_table, &p, &contact, message.data(), message.size());
  return {status, Handle(contact, &railtab_contact_close), message.data()};
}

Handle contact_of(const std::string& table, const railtab_contact_parameters& p = parameters()) {
  Opened opened = open(table_file(table), p);
  EXPECT_EQ(opened.status, RAILTAB_OK) << opened.message;
  EXPECT_EQ(opened.message, "");
  return std::move(opened.contact);
}

bool same_bits(double one, double other) { return std::memcmp(&one, &other, sizeof one) == 0; }

struct CForce {
  railtab_status status;
  railtab_wheel_force force;
  std::array<double, 81> tangent{};
};

CForce force_of(const railtab_contact* contact, const Motions& m) {
  const railtab_wheelset_motion wheelset = m.c_wheelset();
  const railtab_rail_motion rail = m.c_rail();
  CForce result;
  result.status = railtab_contact_force(contact, m.c_side(), &wheelset, &rail, &result.force);
  return result;
}

CForce force_and_tangent_of(const railtab_contact* contact, const Motions& m) {
  const railtab_wheelset_motion wheelset = m.c_wheelset();
  const railtab_rail_motion rail = m.c_rail();
  CForce result;
  result.status = railtab_contact_force_and_tangent(contact, m.c_side(), &wheelset, &rail, rate, &result.force,
                                                    result.tangent.data());
  return result;
}

void expect_same_force(const railtab_wheel_force& found, const WheelForce& expected, int i) {
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(same_bits(found.wheelset[k], expected.wheelset[k])) << i << ' ' << k;
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(found.rail[k], expected.rail[k])) << i << ' ' << k;
  EXPECT_TRUE(same_bits(found.rail_x, expected.rail_x)) << i;
  EXPECT_EQ(found.outside_creep_table, expected.outside_creep_table) << i;
}

struct Counts {
  int touching = 0, free = 0, looked_up = 0, searched = 0, by_loaded_part = 0;
};

/// Forces, tangents and statuses of random motions, to the last bit.
Counts compare_forces(const std::string& file, int count) {
  const CppContact cpp(table_file(file));
  const Handle contact = contact_of(file);
  Counts counts;
  const std::vector<Motions> all = random_motions(cpp, count);
  for (int i = 0; i < count; ++i) {
    const auto& [side, wheelset, rail] = all[i];
    const WheelContact at = cpp.at(side, wheelset, rail);
    const WheelForce force = wheel_force(cpp.model, side, wheelset, rail, at);
    const WheelResponse response = wheel_response(cpp.model, side, wheelset, rail, {Vector6::Constant(rate), rate});
    const CForce found = force_of(contact.get(), all[i]), both = force_and_tangent_of(contact.get(), all[i]);
    const bool searched = at.loaded.table_share < 1.0 && !at.patches.from_table;
    EXPECT_EQ(found.status, searched ? RAILTAB_SEARCHED : RAILTAB_OK) << i;
    EXPECT_EQ(both.status, found.status) << i;
    expect_same_force(found.force, force, i);
    expect_same_force(both.force, response.force, i);
    for (int row = 0; row < 9; ++row) {
      for (int column = 0; column < 9; ++column) {
        EXPECT_TRUE(same_bits(both.tangent[9 * row + column], response.tangent(row, column))) << i << row << column;
      }
    }
    if (!found.force.touches) {
      EXPECT_EQ(force.wheelset.norm() + force.rail.norm(), 0.0) << i;
    }
    ++(found.force.touches ? counts.touching : counts.free);
    ++(searched ? counts.searched : counts.looked_up);
    if (at.loaded.table_share > 0.0) ++counts.by_loaded_part;
  }
  return counts;
}

TEST(ContactInC, ForcesAndTangentsAreThoseOfTheCppLibraryToTheLastBit) {
  const Counts counts = compare_forces("s1002_60e1.h5", 2000);
  EXPECT_GT(counts.touching, 1000);
  EXPECT_GT(counts.free, 50);
  EXPECT_GT(counts.looked_up, 500);
  EXPECT_GT(counts.searched, 100);
}

TEST(ContactInC, TheLoadedPartOfATableServes) {
  const Counts counts = compare_forces("loaded.h5", 2000);
  EXPECT_GT(counts.by_loaded_part, 20);
}

TEST(ContactInC, PatchesAreThoseOfTheCppLibraryToTheLastBit) {
  for (const char* file : {"s1002_60e1.h5", "loaded.h5"}) {
    const CppContact cpp(table_file(file));
    const Handle contact = contact_of(file);
    int touching = 0;
    for (const Motions& m : random_motions(cpp, 1000)) {
      const railtab_wheelset_motion wheelset = m.c_wheelset();
      const railtab_rail_motion rail = m.c_rail();
      std::array<railtab_patch, RAILTAB_MAX_PATCHES> found;
      int count = -1;
      const railtab_status status =
          railtab_contact_patches(contact.get(), m.c_side(), &wheelset, &rail, found.data(), &count);
      const WheelsetPose pose = relative_pose(cpp.table.geometry.pair(), m.side, m.wheelset, m.rail);
      const ContactPatches expected = cpp.table.patches.patches(pose, touch_rounding);
      const auto loads = patch_loadings(cpp.table.geometry, pose, expected, cpp.model.normal);
      EXPECT_EQ(status, expected.from_table ? RAILTAB_OK : RAILTAB_SEARCHED);
      ASSERT_EQ(count, expected.count);
      for (int i = 0; i < count; ++i) {
        const railtab_patch& f = found[i];
        const ContactPatch& p = expected.patch[i];
        const std::array<double, 14> numbers{
            f.y_rail,      f.z_rail,          f.y_wheel,        f.z_wheel,      f.x, f.angle, f.rolling_radius,
            f.penetration, f.curvature_wheel, f.curvature_rail, f.normal_force, f.a, f.b,     f.pressure};
        const std::array<double, 14> of_cpp{p.y_rail,
                                            p.z_rail,
                                            p.y_wheel,
                                            p.z_wheel,
                                            p.x,
                                            p.angle,
                                            p.rolling_radius,
                                            std::max(0.0, p.penetration),
                                            p.curv_wheel,
                                            p.curv_rail,
                                            loads[i].normal_force,
                                            loads[i].a,
                                            loads[i].b,
                                            loads[i].pressure};
        for (int k = 0; k < 14; ++k) EXPECT_TRUE(same_bits(numbers[k], of_cpp[k])) << k;
        EXPECT_EQ(f.concave, p.concave ? 1 : 0);
        ++touching;
      }
    }
    EXPECT_GT(touching, 500) << file;
  }
}

TEST(ContactInC, LoadsOfPatchesAreThoseOfTheContactsMaterial) {
  railtab_contact_parameters p = parameters();
  p.young *= 0.5;
  const Handle steel = contact_of("s1002_60e1.h5"), soft = contact_of("s1002_60e1.h5", p);
  railtab_wheelset_motion wheelset{};
  wheelset.displacement[1] = -2e-3;  // where the tread touches in one patch
  ASSERT_EQ(railtab_contact_height(steel.get(), RAILTAB_RIGHT, -2e-3, 0.0, 0.0, 60e3, &wheelset.displacement[2]),
            RAILTAB_OK);
  std::array<railtab_patch, RAILTAB_MAX_PATCHES> of_steel, of_soft;
  int count = 0;
  railtab_contact_patches(steel.get(), RAILTAB_RIGHT, &wheelset, nullptr, of_steel.data(), &count);
  railtab_contact_patches(soft.get(), RAILTAB_RIGHT, &wheelset, nullptr, of_soft.data(), &count);
  ASSERT_EQ(count, 1);
  // F = K d^(3/2) with K in proportion to E; the ellipse of an approach is the same
  EXPECT_NEAR(of_soft[0].normal_force / of_steel[0].normal_force, 0.5, 1e-12);
  EXPECT_NEAR(of_soft[0].a / of_steel[0].a, 1.0, 1e-12);
}

TEST(ContactInC, TheDefaultsAreThoseOfTheCppLibrary) {
  railtab_contact_parameters p;
  ASSERT_EQ(railtab_contact_default_parameters(&p), RAILTAB_OK);
  const WheelContactModel model;
  EXPECT_EQ(p.speed, 0.0);
  EXPECT_EQ(p.speed_floor, 0.0);
  EXPECT_EQ(p.friction, model.friction);
  EXPECT_EQ(p.friction_limit, 1.0);
  EXPECT_EQ(p.friction_decay, 0.0);
  EXPECT_EQ(p.initial_slope, 1.0);
  EXPECT_EQ(p.damping, 0.0);
  EXPECT_EQ(p.young, model.normal.material.E);
  EXPECT_EQ(p.poisson, model.normal.material.nu);
  EXPECT_EQ(p.curvature_floor, model.normal.curvature_floor);
  EXPECT_EQ(p.k_adhesion, 1.0);
  EXPECT_EQ(p.k_slip, 1.0);
  EXPECT_EQ(p.creep_law, RAILTAB_CREEP_TABLE);
  EXPECT_EQ(railtab_contact_default_parameters(nullptr), RAILTAB_INVALID_INPUT);
}

/// Every parameter reaches the model: forces are those of a C++ model that has it too.
TEST(ContactInC, EveryParameterReachesTheForce) {
  struct Change {
    const char* name;
    std::function<void(railtab_contact_parameters&)> in_c;
    std::function<void(WheelContactModel&)> in_cpp;
  };
  const std::vector<Change> changes{
      {"speed", [](auto& p) { p.speed = 33.0; }, [](auto& m) { m.speed = 33.0; }},
      {"speed_floor", [](auto& p) { p.speed_floor = 60.0; }, [](auto& m) { m.speed_floor = 60.0; }},
      {"friction", [](auto& p) { p.friction = 0.1; }, [](auto& m) { m.friction = 0.1; }},
      {"friction_limit and friction_decay", [](auto& p) { p.friction_limit = 0.4, p.friction_decay = 1.5; },
       [](auto& m) { m.friction_law.limit = 0.4, m.friction_law.decay = 1.5; }},
      {"initial_slope", [](auto& p) { p.initial_slope = 0.6; }, [](auto& m) { m.friction_law.initial_slope = 0.6; }},
      {"damping", [](auto& p) { p.damping = 0.2; }, [](auto& m) { m.damping = 0.2; }},
      {"young", [](auto& p) { p.young = 200e9; }, [](auto& m) { m.normal.material.E = 200e9; }},
      {"poisson", [](auto& p) { p.poisson = 0.279; }, [](auto& m) { m.normal.material.nu = 0.279; }},
      {"curvature_floor", [](auto& p) { p.curvature_floor = 5.0; }, [](auto& m) { m.normal.curvature_floor = 5.0; }},
      {"polach", [](auto& p) { p.creep_law = RAILTAB_CREEP_POLACH, p.k_adhesion = 0.7, p.k_slip = 0.2; },
       [](auto& m) {
         m.creep_law = PolachCreep{0.28, 0.7, 0.2};
       }},
      {"fastsim", [](auto& p) { p.creep_law = RAILTAB_CREEP_FASTSIM; }, [](auto& m) { m.creep_law = FastsimCreep{}; }},
      {"linear", [](auto& p) { p.creep_law = RAILTAB_CREEP_LINEAR; }, [](auto& m) { m.creep_law = LinearCreep{}; }}};
  CppContact cpp(table_file("s1002_60e1.h5"));
  const std::vector<Motions> all = random_motions(cpp, 40);
  const WheelContactModel unchanged = cpp.model;
  for (const Change& change : changes) {
    railtab_contact_parameters p = parameters();
    change.in_c(p);
    cpp.model = unchanged;
    change.in_cpp(cpp.model);
    const Handle contact = contact_of("s1002_60e1.h5", p);
    int differ = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [side, wheelset, rail] = all[i];
      const WheelContact at = cpp.at(side, wheelset, rail);
      const WheelForce expected = wheel_force(cpp.model, side, wheelset, rail, at);
      expect_same_force(force_of(contact.get(), all[i]).force, expected, static_cast<int>(i));
      if (expected.wheelset != wheel_force(unchanged, side, wheelset, rail, at).wheelset) ++differ;
    }
    EXPECT_GT(differ, 20) << change.name;
  }
}

TEST(ContactInC, ACreepTableIsRead) {
  const std::string shipped = shipped_creep_table().string();
  const CppContact cpp(table_file("s1002_60e1.h5"));
  const Opened named = open(table_file("s1002_60e1.h5"), parameters(), shipped.c_str());
  ASSERT_EQ(named.status, RAILTAB_OK) << named.message;
  const Motions m = random_motions(cpp, 1)[0];
  expect_same_force(force_of(named.contact.get(), m).force,
                    wheel_force(cpp.model, m.side, m.wheelset, m.rail, cpp.at(m.side, m.wheelset, m.rail)), 0);

  const Opened missing = open(table_file("s1002_60e1.h5"), parameters(), "no-such-creep-table.h5");
  EXPECT_EQ(missing.status, RAILTAB_INVALID_INPUT);
  EXPECT_NE(missing.message.find("no-such-creep-table.h5"), std::string::npos) << missing.message;

  railtab_contact_parameters polach = parameters();
  polach.creep_law = RAILTAB_CREEP_POLACH;
  const Opened useless = open(table_file("s1002_60e1.h5"), polach, shipped.c_str());
  EXPECT_EQ(useless.status, RAILTAB_INVALID_INPUT);
  EXPECT_NE(useless.message.find("creep_table"), std::string::npos) << useless.message;
}

TEST(ContactInC, TheSpeedChanges) {
  const Handle contact = contact_of("s1002_60e1.h5");
  CppContact cpp(table_file("s1002_60e1.h5"));
  cpp.model.speed = 41.0;
  EXPECT_EQ(railtab_contact_set_speed(contact.get(), 41.0), RAILTAB_OK);
  const Motions m = random_motions(cpp, 1)[0];
  const WheelForce expected = wheel_force(cpp.model, m.side, m.wheelset, m.rail, cpp.at(m.side, m.wheelset, m.rail));
  expect_same_force(force_of(contact.get(), m).force, expected, 0);
  for (const double wrong : {0.0, -1.0, nan, infinity}) {
    EXPECT_EQ(railtab_contact_set_speed(contact.get(), wrong), RAILTAB_INVALID_INPUT) << wrong;
  }
  expect_same_force(force_of(contact.get(), m).force, expected, 0);  // which left the speed as it was
  EXPECT_EQ(railtab_contact_set_speed(nullptr, 41.0), RAILTAB_INVALID_INPUT);

  railtab_contact_parameters p = parameters();
  p.speed_floor = 0.1;
  EXPECT_EQ(railtab_contact_set_speed(contact_of("s1002_60e1.h5", p).get(), 0.0), RAILTAB_OK);
}

TEST(ContactInC, TheDimensionsAreThoseOfTheTable) {
  const Handle contact = contact_of("s1002_60e1.h5");
  railtab_dimensions d;
  ASSERT_EQ(railtab_contact_dimensions(contact.get(), &d), RAILTAB_OK);
  EXPECT_EQ(d.track_gauge, 1.435);
  EXPECT_EQ(d.gauge_height, 0.014);
  EXPECT_EQ(d.flange_back, 1.360);
  EXPECT_EQ(d.nominal_radius, 0.460);
  EXPECT_NEAR(d.tape_circle_offset, 0.750, 1e-15);  // half the flange-back distance and 70 mm
  EXPECT_EQ(d.rail_offset, CppContact(table_file("s1002_60e1.h5")).table.geometry.pair().rail_offset());
  EXPECT_EQ(railtab_contact_dimensions(nullptr, &d), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_dimensions(contact.get(), nullptr), RAILTAB_INVALID_INPUT);
}

TEST(ContactInC, AWheelAtItsHeightCarriesTheLoad) {
  railtab_contact_parameters p = parameters();
  p.friction = 0.0;
  p.young = 70e9;
  const Handle softer = contact_of("s1002_60e1.h5", p);
  p.young = 210e9;
  const Handle contact = contact_of("s1002_60e1.h5", p);
  double of_steel = 0.0, of_softer = 0.0;
  ASSERT_EQ(railtab_contact_height(contact.get(), RAILTAB_RIGHT, 1e-3, 0.0, 0.0, 60e3, &of_steel), RAILTAB_OK);
  ASSERT_EQ(railtab_contact_height(softer.get(), RAILTAB_RIGHT, 1e-3, 0.0, 0.0, 60e3, &of_softer), RAILTAB_OK);
  EXPECT_GT(of_softer, of_steel + 20e-6) << "twice as deep";
  for (const railtab_side side : {RAILTAB_LEFT, RAILTAB_RIGHT}) {
    railtab_wheelset_motion wheelset{};
    wheelset.displacement[1] = 1e-3;
    wheelset.displacement[3] = 1e-4;
    wheelset.displacement[5] = -5e-4;
    ASSERT_EQ(railtab_contact_height(contact.get(), side, 1e-3, 1e-4, -5e-4, 60e3, &wheelset.displacement[2]),
              RAILTAB_OK);
    railtab_wheel_force force;
    EXPECT_EQ(railtab_contact_force(contact.get(), side, &wheelset, nullptr, &force), RAILTAB_OK);
    EXPECT_NEAR(force.wheelset[2], -60e3, 1e-3);  // upwards
    EXPECT_NEAR(force.rail[1], 60e3, 1e-3);       // downwards
    // contact angles point to the track centre: the right wheel is pushed to the left
    EXPECT_GT(side == RAILTAB_LEFT ? force.wheelset[1] : -force.wheelset[1], 100.0);
  }
  double z = 7.0;
  const auto invalid = [&](double y, double load) {
    return railtab_contact_height(contact.get(), RAILTAB_LEFT, y, 0.0, 0.0, load, &z) == RAILTAB_INVALID_INPUT;
  };
  EXPECT_TRUE(invalid(0.0, 0.0));
  EXPECT_TRUE(invalid(0.0, 1.1e7));
  EXPECT_TRUE(invalid(0.0, nan));
  EXPECT_TRUE(invalid(nan, 60e3));
  EXPECT_TRUE(invalid(1.0, 60e3));
  EXPECT_EQ(z, 7.0);
}

TEST(ContactInC, APositionAlongTheTrackAndARotationAboutTheAxleChangeNothing) {
  const Handle contact = contact_of("s1002_60e1.h5");
  const CppContact cpp(table_file("s1002_60e1.h5"));
  Motions m = random_motions(cpp, 1)[0];
  const railtab_wheel_force before = force_of(contact.get(), m).force;
  m.wheelset.displacement[0] = 1234.5;
  m.wheelset.displacement[4] = 0.7;
  const railtab_wheel_force after = force_of(contact.get(), m).force;
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(same_bits(before.wheelset[k], after.wheelset[k])) << k;
}

TEST(ContactInC, ARailThatIsNullIsAtRest) {
  const Handle contact = contact_of("s1002_60e1.h5");
  const CppContact cpp(table_file("s1002_60e1.h5"));
  for (Motions m : random_motions(cpp, 10)) {
    m.rail = {};
    m.wheelset.displacement[2] = 2e-4;
    const railtab_wheelset_motion wheelset = m.c_wheelset();
    railtab_wheel_force force;
    EXPECT_GE(railtab_contact_force(contact.get(), m.c_side(), &wheelset, nullptr, &force), 0);
    const railtab_wheel_force expected = force_of(contact.get(), m).force;
    for (int k = 0; k < 6; ++k) EXPECT_TRUE(same_bits(force.wheelset[k], expected.wheelset[k])) << k;
  }
}

TEST(ContactInC, WrongParametersAreNamed) {
  struct Wrong {
    const char* name;
    double railtab_contact_parameters::*member;
    std::vector<double> values;
  };
  using P = railtab_contact_parameters;
  const std::vector<Wrong> all{{"speed", &P::speed, {0.0, -1.0, nan, infinity}},
                               {"speed_floor", &P::speed_floor, {-1.0, nan, infinity}},
                               {"friction", &P::friction, {-0.1, 2.1, nan}},
                               {"friction_limit", &P::friction_limit, {-0.1, 1.1, nan}},
                               {"friction_decay", &P::friction_decay, {-0.1, 1.1e3, nan}},
                               {"initial_slope", &P::initial_slope, {0.0, 1.1, nan}},
                               {"damping", &P::damping, {-0.1, 1.1e3, nan}},
                               {"material.E", &P::young, {0.0, -1.0, nan, infinity}},
                               {"material.nu", &P::poisson, {-0.1, 0.6, nan}},
                               {"curvature_floor", &P::curvature_floor, {0.0, 1.1e4, nan}},
                               {"k_adhesion", &P::k_adhesion, {0.0, 1.1, nan}},
                               {"k_slip", &P::k_slip, {0.0, 1.1, nan}}};
  for (const Wrong& wrong : all) {
    for (const double value : wrong.values) {
      railtab_contact_parameters p = parameters();
      p.*wrong.member = value;
      const Opened opened = open(table_file("s1002_60e1.h5"), p);
      EXPECT_EQ(opened.status, RAILTAB_INVALID_INPUT) << wrong.name << " = " << value;
      EXPECT_EQ(opened.contact, nullptr);
      EXPECT_NE(opened.message.find(wrong.name), std::string::npos) << opened.message;
      EXPECT_NE(opened.message.find("expected"), std::string::npos) << opened.message;
    }
  }
  railtab_contact_parameters p = parameters();
  p.creep_law = 4;
  EXPECT_NE(open(table_file("s1002_60e1.h5"), p).message.find("creep_law"), std::string::npos);
  p = parameters();
  p.poisson = 0.3;  // the shipped creep table is for 0.28
  EXPECT_NE(open(table_file("s1002_60e1.h5"), p).message.find("Poisson"), std::string::npos);
  p = parameters();
  p.young = 200e9;  // the loaded part is for 210e9
  EXPECT_NE(open(table_file("loaded.h5"), p).message.find("loaded part"), std::string::npos);
}

TEST(ContactInC, WrongFilesAreNamedAndMessagesFitTheirBuffer) {
  const railtab_contact_parameters p = parameters();
  const std::string file = table_file("none.h5");
  railtab_contact* contact = nullptr;
  const std::string whole = open(file, p).message;
  EXPECT_NE(whole.find(file), std::string::npos) << whole;
  for (std::size_t size = 0; size <= whole.size() + 1; ++size) {
    std::vector<char> buffer(size + 1, '#');
    EXPECT_EQ(railtab_contact_open(file.c_str(), nullptr, &p, &contact, buffer.data(), size), RAILTAB_INVALID_INPUT);
    EXPECT_EQ(buffer[size], '#');
    if (size > 0) {
      EXPECT_EQ(std::string(buffer.data()), whole.substr(0, size - 1));
    }
  }
  const std::string text = ::testing::TempDir() + "/railtab_no_table.h5";
  std::ofstream(text) << "no table\n";
  EXPECT_EQ(open(text, p).status, RAILTAB_INVALID_INPUT);
  EXPECT_EQ(open(::testing::TempDir(), p).status, RAILTAB_INVALID_INPUT);
  // a creep table is none of geometry
  EXPECT_EQ(open(shipped_creep_table().string(), p).status, RAILTAB_INVALID_INPUT);
}

TEST(ContactInC, ACharacterOfSeveralBytesIsNotCut) {
  const std::string file = table_file("µµµµ.h5");
  const railtab_contact_parameters p = parameters();
  railtab_contact* contact = nullptr;
  for (std::size_t size = file.size() - 14; size < file.size(); ++size) {
    std::vector<char> buffer(size);
    railtab_contact_open(file.c_str(), nullptr, &p, &contact, buffer.data(), size);
    const std::string text = buffer.data();
    EXPECT_GE(text.size() + 2, size);
    // no first byte of a character at the end
    EXPECT_NE(static_cast<unsigned char>(text.back()) & 0xC0, 0xC0) << size;
  }
}

TEST(ContactInC, NullPointersAreInvalid) {
  const Handle contact = contact_of("s1002_60e1.h5");
  const railtab_contact* const c = contact.get();
  const railtab_contact_parameters p = parameters();
  const std::string file = table_file("s1002_60e1.h5");
  railtab_contact* other = nullptr;
  EXPECT_EQ(railtab_contact_open(nullptr, nullptr, &p, &other, nullptr, 0), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_open(file.c_str(), nullptr, nullptr, &other, nullptr, 0), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_open(file.c_str(), nullptr, &p, nullptr, nullptr, 0), RAILTAB_INVALID_INPUT);
  railtab_contact_close(nullptr);

  const railtab_wheelset_motion w{};
  railtab_wheel_force force;
  std::array<double, 81> tangent;
  std::array<railtab_patch, RAILTAB_MAX_PATCHES> patches;
  int count = 0;
  double z = 0.0;
  const auto side = RAILTAB_LEFT;
  EXPECT_EQ(railtab_contact_force(nullptr, side, &w, nullptr, &force), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_force(c, side, nullptr, nullptr, &force), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_force(c, side, &w, nullptr, nullptr), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_force_and_tangent(c, side, &w, nullptr, 0.0, &force, nullptr), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_force_and_tangent(c, side, &w, nullptr, nan, &force, tangent.data()),
            RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_patches(c, side, &w, nullptr, nullptr, &count), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_patches(c, side, &w, nullptr, patches.data(), nullptr), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_height(nullptr, side, 0.0, 0.0, 0.0, 1.0, &z), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_height(c, side, 0.0, 0.0, 0.0, 1.0, nullptr), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(railtab_contact_force(c, 7, &w, nullptr, &force), RAILTAB_INVALID_INPUT);
}

TEST(ContactInC, NumbersThatAreNotFiniteAreInvalidAndResultsStayAsTheyWere) {
  const Handle contact = contact_of("s1002_60e1.h5");
  railtab_wheelset_motion wheelset{};
  railtab_rail_motion rail{};
  rail.friction = 1.0;
  railtab_wheel_force force;
  force.rail_x = 7.0;
  const auto status = [&] { return railtab_contact_force(contact.get(), RAILTAB_LEFT, &wheelset, &rail, &force); };
  std::vector<double*> numbers{&rail.yaw, &rail.slope, &rail.friction};
  for (int i = 0; i < 6; ++i) {
    numbers.push_back(&wheelset.displacement[i]);
    numbers.push_back(&wheelset.velocity[i]);
  }
  for (int i = 0; i < 3; ++i) {
    numbers.push_back(&rail.displacement[i]);
    numbers.push_back(&rail.velocity[i]);
  }
  for (double* number : numbers) {
    const double before = *number;
    for (const double wrong : {nan, infinity, -infinity}) {
      *number = wrong;
      EXPECT_EQ(status(), RAILTAB_INVALID_INPUT);
    }
    *number = before;
  }
  rail.friction = -0.1;
  EXPECT_EQ(status(), RAILTAB_INVALID_INPUT);
  EXPECT_EQ(force.rail_x, 7.0);
  rail.friction = 1.0;
  EXPECT_GE(status(), 0);
  EXPECT_NE(force.rail_x, 7.0);
}

TEST(ContactInC, FarAwayThereIsNoContact) {
  const Handle contact = contact_of("s1002_60e1.h5");
  for (const int dof : {1, 3, 5}) {
    for (double size = 1.0; size < 1e300; size *= 1e7) {
      railtab_wheelset_motion wheelset{};
      wheelset.displacement[2] = -0.05;
      wheelset.displacement[dof] = size;
      railtab_wheel_force force;
      EXPECT_GE(railtab_contact_force(contact.get(), RAILTAB_RIGHT, &wheelset, nullptr, &force), 0);
      for (const double f : force.wheelset) EXPECT_TRUE(std::isfinite(f)) << dof << ' ' << size;
    }
  }
}

TEST(ContactInC, ForcesAndPatchesAllocateNothing) {
  const long before_open = allocations;
  const Handle contact = contact_of("s1002_60e1.h5"), loaded = contact_of("loaded.h5");
  EXPECT_GT(allocations, before_open + 10);  // those of the shared library count
  const CppContact cpp(table_file("s1002_60e1.h5"));
  const std::vector<Motions> all = random_motions(cpp, 500);
  std::array<railtab_patch, RAILTAB_MAX_PATCHES> patches;
  int count = 0, searched = 0;
  const long before = allocations;
  for (const railtab_contact* const c : {contact.get(), loaded.get()}) {
    for (const Motions& m : all) {
      const railtab_wheelset_motion wheelset = m.c_wheelset();
      const railtab_rail_motion rail = m.c_rail();
      searched += force_of(c, m).status == RAILTAB_SEARCHED;
      force_and_tangent_of(c, m);
      railtab_contact_patches(c, m.c_side(), &wheelset, &rail, patches.data(), &count);
    }
    railtab_contact_force(c, RAILTAB_LEFT, nullptr, nullptr, nullptr);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(searched, 0);
}

TEST(ContactInC, ThreadsShareAContact) {
  const Handle contact = contact_of("s1002_60e1.h5");
  const CppContact cpp(table_file("s1002_60e1.h5"));
  const std::vector<Motions> all = random_motions(cpp, 300);
  std::vector<CForce> serial;
  for (const Motions& m : all) serial.push_back(force_and_tangent_of(contact.get(), m));
  std::array<int, 4> different{};
  std::vector<std::thread> threads;
  for (int& of_thread : different) {
    threads.emplace_back([&] {
      const Handle own = contact_of("s1002_60e1.h5");  // while others open and ask
      for (std::size_t i = 0; i < all.size(); ++i) {
        const CForce found = force_and_tangent_of(contact.get(), all[i]);
        of_thread += found.tangent != serial[i].tangent || found.status != serial[i].status;
        of_thread += std::memcmp(found.force.wheelset, serial[i].force.wheelset, sizeof found.force.wheelset) != 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, (std::array<int, 4>{}));
}

TEST(ContactInC, StatusesHaveTexts) {
  EXPECT_STREQ(railtab_status_text(RAILTAB_OK), "no error");
  for (int status = -3; status <= 1; ++status) {
    const std::string text = railtab_status_text(status);
    EXPECT_NE(text, "unknown status") << status;
    for (int other = -3; other < status; ++other) {
      EXPECT_NE(text, railtab_status_text(other));
    }
  }
  EXPECT_STREQ(railtab_status_text(2), "unknown status");
  EXPECT_STREQ(railtab_status_text(-4), "unknown status");
  EXPECT_STREQ(railtab_version(), railtab::version());
}

}  // namespace
}  // namespace railtab::c_test
