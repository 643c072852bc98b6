// A coach from files runs as the built one of the same matrices does.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../imported_vehicle.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

using testing::free_coach;
using testing::FreeCoach;
using testing::recorded_steps;
using testing::Written;

const std::string rough_track = "[irregularity]\nspectrum = \"german-low\"\nfade_in = 0\n";
const std::string rigid_track = "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[track]\nkind = \"rigid\"\n";
const std::string flexible_track =
    "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[track]\nlength_before = 27.0\nlength_after = 9.0\n";

constexpr int pitch = 4;  // whose angle grows with the way of a rolling wheelset

/// Largest difference of two runs against the largest amount in the first.
struct Difference {
  double force = 0.0, displacement = 0.0, acceleration = 0.0;
};

Difference difference(const std::vector<StepRecord>& a, const std::vector<StepRecord>& b) {
  Difference apart, largest;
  const auto add = [](double x, double y, double& most, double& amount) {
    most = std::max(most, std::abs(x - y));
    amount = std::max(amount, std::abs(x));
  };
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    EXPECT_EQ(a[i].wheels.size(), b[i].wheels.size());
    EXPECT_EQ(a[i].bodies.size(), b[i].bodies.size());
    for (std::size_t w = 0; w < std::min(a[i].wheels.size(), b[i].wheels.size()); ++w) {
      add(a[i].wheels[w].Q, b[i].wheels[w].Q, apart.force, largest.force);
      add(a[i].wheels[w].Y, b[i].wheels[w].Y, apart.force, largest.force);
    }
    for (std::size_t k = 0; k < std::min(a[i].bodies.size(), b[i].bodies.size()); ++k) {
      for (int m = 0; m < 6; ++m) {
        const MotionRecord &p = a[i].bodies[k], &q = b[i].bodies[k];
        if (m != pitch) add(p.displacement[m], q.displacement[m], apart.displacement, largest.displacement);
        add(p.acceleration[m], q.acceleration[m], apart.acceleration, largest.acceleration);
      }
    }
  }
  EXPECT_GT(largest.acceleration, 0.05);  // something happens
  return {apart.force / largest.force, apart.displacement / largest.displacement,
          apart.acceleration / largest.acceleration};
}

/// States of rest are found to 2e-9 m, which is some 2 N of a wheel's contact: other axes end elsewhere within that.
void expect_same(const Difference& d) {
  EXPECT_LT(d.force, 5e-5);
  EXPECT_LT(d.displacement, 1e-6);
  EXPECT_LT(d.acceleration, 5e-5);
}

using ImportedVehicle = testing::ImportedVehicle;

/// The coach with bogies that its table does not name.
FreeCoach with_unnamed_bogies() {
  FreeCoach coach = free_coach();
  for (testing::BodyRow& row : coach.rows) {
    if (row.body.starts_with("bogie")) row.body.clear();
  }
  return coach;
}

/// Records of two coaches without their bogies.
std::vector<StepRecord> without_bogies(std::vector<StepRecord> records) {
  for (StepRecord& record : records) {
    for (const std::ptrdiff_t coach : {7, 0}) {
      record.bodies.erase(record.bodies.begin() + coach + 1, record.bodies.begin() + coach + 3);
    }
  }
  return records;
}

constexpr Written turned = Written::turned_in_millimetres;

// Two braking coaches: names, order, distance, gyroscopic moments and loads of changing speed.
TEST_F(ImportedVehicle, RunsAsTheBuiltCoach) {
  write("speed.csv", "t[s],V[m/s]\n0,55\n0.5,54.5\n");
  const std::string text =
      rigid_track + rough_track + "[integration]\nduration = 0.1\n[train]\ncount = 2\nspeed_file = \"speed.csv\"\n";
  const std::vector<StepRecord> built = recorded_steps(scene(text));
  for (const Written how : {Written::as_railtab, turned}) {
    write(free_coach(), how);
    expect_same(difference(built, recorded_steps(scene(text + vehicle_section(how)))));
  }
  write(with_unnamed_bogies(), turned);
  expect_same(difference(without_bogies(built), recorded_steps(scene(text + vehicle_section(turned)))));
}

// Inner unknowns go along.
TEST_F(ImportedVehicle, IsSetAsideAsAWhole) {
  const std::string text =
      rigid_track + "[integration]\nduration = 0.05\n[train]\ncount = 2\ninitial_lateral_shift = 0.003\n";
  const std::vector<StepRecord> built = recorded_steps(scene(text));
  write(with_unnamed_bogies(), turned);
  expect_same(difference(without_bogies(built), recorded_steps(scene(text + vehicle_section(turned)))));
}

// At the default tolerance Newton's iterations of the two, from axes that are turned, may end up to five newtons apart.
TEST_F(ImportedVehicle, RunsAsTheBuiltCoachOnFlexibleTrack) {
  const std::string text = flexible_track + rough_track + "[integration]\nduration = 0.04\ntolerance = 1e-7\n";
  write(free_coach(), turned);
  expect_same(difference(recorded_steps(scene(text)), recorded_steps(scene(text + vehicle_section(turned)))));
}

TEST_F(ImportedVehicle, RunsAsTheBuiltCoachInTheVerticalPlane) {
  const std::string text =
      "[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.2\n" + rough_track;
  write(free_coach());
  const SceneParameters imported = scene(text + vehicle_section());
  EXPECT_EQ(build_model(imported).vehicle.dofs(), 16);
  expect_same(difference(recorded_steps(scene(text)), recorded_steps(imported)));
}

// An inner unknown on a stiff spring is mass of the car body; on a soft one it stays behind, and a sudden force meets
// the car body's own mass alone.
TEST_F(ImportedVehicle, InnerUnknownsTakePart) {
  constexpr double m = 3000.0;
  const std::string text =
      rigid_track + "[integration]\nduration = 0.1\n" + "[[load]]\nFz = 100e3\ngust_duration = 0.04\n";
  CoachParameters heavy = coach_parameters("manchester-coach");
  heavy.car_body.mass += m;
  write(free_coach(heavy));
  const std::vector<StepRecord> one_mass = recorded_steps(scene(vehicle_section() + text));

  FreeCoach stiff = free_coach();
  stiff.hang_mass(m, m * std::pow(2.0 * std::numbers::pi * 400.0, 2));
  write(stiff, turned);
  const SceneParameters with_stiff = scene(vehicle_section(turned) + text);
  EXPECT_EQ(build_model(with_stiff).vehicle.dofs(), 42);
  const Difference rigid = difference(one_mass, recorded_steps(with_stiff));
  EXPECT_LT(rigid.force, 1e-3);
  EXPECT_LT(rigid.displacement, 1e-2);

  FreeCoach soft = free_coach();
  soft.hang_mass(m, m * std::pow(2.0 * std::numbers::pi * 1.0, 2));
  write(soft);
  const std::vector<StepRecord> two_masses = recorded_steps(scene(vehicle_section() + text));
  const double static_load = (44482.0 + m) * 9.81 / 8.0;
  EXPECT_NEAR(two_masses.front().wheels[0].Q, static_load, 1e-3 * static_load);
  constexpr std::size_t peak = 40;  // of the gust, at 0.02 s
  const double ratio = two_masses[peak].bodies[0].acceleration[2] / one_mass[peak].bodies[0].acceleration[2];
  EXPECT_NEAR(ratio, 1.0 + m / 32000.0, 0.01);
}

}  // namespace
}  // namespace railtab
