// What an imported vehicle must be, and what is said where it is not.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string_view>

#include "../imported_vehicle.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"

namespace railtab {
namespace {

using testing::BodyRow;
using testing::free_coach;
using testing::FreeCoach;
using testing::Written;

constexpr int y = 1, z = 2, roll = 3, pitch = 4, yaw = 5;

class VehicleImportFiles : public testing::ImportedVehicle {
 protected:
  [[nodiscard]] static std::string message(const std::function<void()>& action) {
    try {
      action();
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no error";
  }

  void expect_rejected(const VehicleImport& import, std::initializer_list<std::string_view> words) const {
    const std::string what = message([&] { static_cast<void>(import_vehicle(import)); });
    for (const std::string_view word : words) EXPECT_NE(what.find(word), std::string::npos) << word << " in: " << what;
  }
  void expect_rejected(const FreeCoach& coach, std::initializer_list<std::string_view> words) const {
    write(coach);
    expect_rejected(files(), words);
  }

  /// dofs.csv of the coach with every `from` in it replaced.
  void expect_table_rejected(std::string_view from, std::string_view to,
                             std::initializer_list<std::string_view> words) const {
    write(free_coach());
    std::ifstream stream(folder_ / "dofs.csv");
    std::string table((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::size_t found = 0;
    for (std::size_t at = 0; (at = table.find(from, at)) != std::string::npos; at += to.size(), ++found) {
      table.replace(at, from.size(), to);
    }
    EXPECT_GT(found, 0U) << from;
    write("dofs.csv", table);
    expect_rejected(files(), words);
  }
};

/// A spring between two bodies of the coach at the first one's centre.
void add_spring(const FreeCoach& coach, const std::string& a, const std::string& b, const Eigen::Vector3d& along,
                const Eigen::Vector3d& about, Eigen::MatrixXd& matrix) {
  const Eigen::Vector3d at = coach.rows[static_cast<std::size_t>(coach.row(a, z))].position;
  const Eigen::Vector3d arm = at - coach.rows[static_cast<std::size_t>(coach.row(b, z))].position;
  const PairMatrix pair = spring_matrix(Eigen::Vector3d::Zero(), arm, along, about);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      matrix(coach.row(i < 6 ? a : b, i % 6), coach.row(j < 6 ? a : b, j % 6)) += pair(i, j);
    }
  }
}

TEST_F(VehicleImportFiles, GiveTheMatricesOfTheBuiltCoach) {
  const VehicleModel coach =
      build_coach(coach_parameters("manchester-coach"), MotionPlane::spatial, testing::without_geometric_stiffness);
  for (const Written how : {Written::as_railtab, Written::turned_in_millimetres}) {
    write(free_coach(), how);
    const VehicleModel read = import_vehicle(scene(vehicle_section(how) + "[contact]\nmode = \"online\"\n").vehicle,
                                             MotionPlane::spatial, testing::without_geometric_stiffness);
    ASSERT_EQ(read.dofs(), 41);
    EXPECT_EQ(read.dof, coach.dof);
    EXPECT_EQ(read.wheelsets, coach.wheelsets);
    EXPECT_NEAR(read.wheel_radius.front(), coach.wheel_radius.front(), 1e-12);
    EXPECT_EQ(read.length, coach.length);
    const auto expect_equal = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-12 * b.cwiseAbs().maxCoeff());
    };
    expect_equal(read.mass, coach.mass);
    expect_equal(read.damping, coach.damping);
    expect_equal(read.stiffness, coach.stiffness);
    expect_equal(read.gyroscopic, coach.gyroscopic);
    expect_equal(read.acceleration_load, coach.acceleration_load);
    EXPECT_LT((read.static_load - coach.static_load).cwiseAbs().maxCoeff(), 1e-8 * coach.static_load.maxCoeff());
    for (std::size_t b = 0; b < coach.bodies.size(); ++b) {
      EXPECT_EQ(read.bodies[b].name, coach.bodies[b].name);
      EXPECT_LT((read.bodies[b].position - coach.bodies[b].position).norm(), 1e-12);
    }
    const VehicleSummary built = summarise(coach, 6), imported = summarise(read, 6);
    ASSERT_EQ(imported.frequencies.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(imported.frequencies[k], built.frequencies[k], 1e-8);
  }
}

TEST_F(VehicleImportFiles, AreSummedUpInThePlan) {
  write(free_coach());
  const RunPlan plan = plan_run(scene(
      vehicle_section() + "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 1\n"));
  std::string built;
  for (const std::string& part : plan.built) built += part + "\n";
  EXPECT_NE(built.find("1 x imported, 41 degrees of freedom each"), std::string::npos) << built;
  // 32 t + 2 x 2.615 t + 4 x 1.813 t on eight wheels; bounce as in docs/theory/vehicle.md
  EXPECT_NE(built.find("k.mtx: 44482 kg, wheels of the wheelsets carry 54.55, 54.55, 54.55, 54.55 kN"),
            std::string::npos)
      << built;
  const std::vector<double> f = summarise(import_vehicle(files()), 20).frequencies;
  EXPECT_TRUE(std::any_of(f.begin(), f.end(), [](double hertz) { return std::abs(hertz - 1.07) < 0.005; }));
  EXPECT_TRUE(std::any_of(f.begin(), f.end(), [](double hertz) { return std::abs(hertz - 7.47) < 0.005; }));
}

TEST_F(VehicleImportFiles, MustBeAFreeVehicle) {
  FreeCoach tied = free_coach();
  tied.stiffness(tied.row("WS2", y), tied.row("WS2", y)) += 1e5;
  expect_rejected(tied, {"k.mtx: row", "(y of WS2)", "resists y of the whole vehicle", "ties to the ground"});
  tied = free_coach();
  tied.damping(tied.row("CAR", z), tied.row("CAR", z)) += 1e4;
  expect_rejected(tied, {"c.mtx: row", "(z of CAR)", "resists z", "ties to the ground"});
  // gravity that turns with the car body, said or unsaid
  tied = free_coach();
  const int roll_row = tied.row("CAR", roll);
  tied.stiffness(roll_row, roll_row) -= 3e5;
  expect_rejected(tied, {"k.mtx: row", "(roll of CAR)", "resists roll", "train.geometric_stiffness = \"in-matrices\""});
  const VehicleWeight in_matrices{standard_gravity, GeometricStiffness::in_matrices};
  EXPECT_EQ(message([&] { static_cast<void>(import_vehicle(files(), MotionPlane::spatial, in_matrices)); }),
            "no error");
  tied.stiffness(roll_row, roll_row) -= 3e7;
  write(tied);
  EXPECT_NE(message([&] {
              static_cast<void>(import_vehicle(files(), MotionPlane::spatial, in_matrices));
            }).find("a stiffness by which the vehicle stands on its rails"),
            std::string::npos);

  CoachParameters loose = coach_parameters("manchester-coach");
  loose.secondary.kx = loose.secondary.ky = 0.0;
  expect_rejected(free_coach(loose), {"k.mtx: row", "a motion that no spring resists", "six rigid motions"});

  FreeCoach pushing = free_coach();
  add_spring(pushing, "bogie-1", "CAR", {0.0, -1e7, 0.0}, {0.0, 0.0, 0.0}, pushing.stiffness);
  expect_rejected(pushing, {"k.mtx: row", "springs that push", "semidefinite"});
  pushing = free_coach();
  add_spring(pushing, "bogie-1", "CAR", {0.0, -1e6, 0.0}, {0.0, 0.0, 0.0}, pushing.damping);
  expect_rejected(pushing, {"c.mtx: row", "drives a motion", "semidefinite"});
}

// Two coaches and a ball between their ends: relative yaw, pitch and roll of the free train are hinges, which rails
// hold.
FreeCoach two_coaches(double kx) {
  constexpr double length = 26.4, ball = 1e8;  // m, N/m
  const FreeCoach one = free_coach();
  const Eigen::Index n = one.mass.rows();
  FreeCoach two;
  for (auto member : {&FreeCoach::mass, &FreeCoach::damping, &FreeCoach::stiffness}) {
    two.*member = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    (two.*member).topLeftCorner(n, n) = (two.*member).bottomRightCorner(n, n) = one.*member;
  }
  two.rows = one.rows;
  for (testing::BodyRow row : one.rows) {
    row.body += "-b";
    row.position.x() -= length;
    two.rows.push_back(row);
  }
  const auto join = [&](double k, int motion, int turn, double arm) {
    Eigen::VectorXd e = Eigen::VectorXd::Zero(2 * n);
    e[two.row("CAR", motion)] = 1.0;
    e[two.row("CAR-b", motion)] = -1.0;
    e[two.row("CAR", turn)] = e[two.row("CAR-b", turn)] = arm;
    two.stiffness += k * e * e.transpose();
  };
  join(kx, 0, pitch, 0.0);
  join(ball, y, yaw, -0.5 * length);
  join(ball, z, pitch, 0.5 * length);
  return two;
}

TEST_F(VehicleImportFiles, MayHaveHingesThatRailsHold) {
  VehicleImport import = files();
  import.wheelsets = {"WS1", "WS2", "WS3", "WS4", "WS1-b", "WS2-b", "WS3-b", "WS4-b"};
  import.car_bodies = {"CAR", "CAR-b"};
  write(two_coaches(1e7));
  const VehicleModel train = import_vehicle(import);
  EXPECT_EQ(train.coaches, 2);
  EXPECT_EQ(train.dofs(), 2 * 42 - 1);
  for (int w = 0; w < 8; ++w) EXPECT_NEAR(static_wheel_load(train, w) / (44482.0 * 9.81 / 8.0), 1.0, 1e-6);
  int cars = 0;
  for (const VehicleBody& body : train.bodies) {
    if (body.name == "car-body") {
      EXPECT_EQ(body.coach, cars++);
    } else if (body.name == "wheelset-6") {
      EXPECT_EQ(body.coach, 1);
    }
  }
  EXPECT_EQ(cars, 2);
  // nothing holds the second coach along the track
  write(two_coaches(0.0));
  const std::string found = message([&] { static_cast<void>(import_vehicle(import)); });
  EXPECT_NE(found.find("a motion that no spring resists"), std::string::npos) << found;
}

TEST_F(VehicleImportFiles, MustHaveMass) {
  FreeCoach coach = free_coach();
  const int row = coach.row("bogie-2", y), other = coach.row("bogie-2", yaw);
  coach.mass(row, row) = 0.0;
  expect_rejected(coach, {"m.mtx: row", "(y of bogie-2)", "mass 0", "> 0"});
  coach = free_coach();
  coach.mass(row, other) = coach.mass(other, row) = 1.1 * std::sqrt(coach.mass(row, row) * coach.mass(other, other));
  expect_rejected(coach, {"m.mtx: row", "of bogie-2", "positive definite"});
  coach = free_coach();
  coach.mass(row, row) *= 1.001;
  expect_rejected(coach, {"m.mtx", "44482 kg along x, 44484.6 kg along y", "the same mass"});
  coach = free_coach();
  coach.mass(row, other) = 10.0;
  expect_rejected(coach, {"m.mtx: row", "symmetric"});
}

// Finite and absurd numbers are named before anything is computed with them.
TEST_F(VehicleImportFiles, HaveScalesOfAVehicle) {
  FreeCoach coach = free_coach();
  const int row = coach.row("CAR", z);
  coach.mass(row, row) = 1e150;
  expect_rejected(coach, {"m.mtx: row", "(z of CAR)", "found mass 1e+150, expected -1e+09 to 1e+09 in SI units"});
  coach = free_coach();
  coach.stiffness(row, row) = 1e300;
  expect_rejected(coach, {"k.mtx: row", "(z of CAR)", "stiffness 1e+300", "-1e+18 to 1e+18"});
  coach = free_coach();
  coach.damping(row, row) = -1e200;
  expect_rejected(coach, {"c.mtx: row", "(z of CAR)", "damping -1e+200"});
  coach = free_coach();
  coach.mass(row, row) = 1e-15;
  expect_rejected(coach, {"m.mtx: row", "(z of CAR)", "Hz", "0 to 1e+09 Hz"});
}

TEST_F(VehicleImportFiles, HaveWheelsetsThatRollFreely) {
  FreeCoach braked = free_coach();
  add_spring(braked, "WS1", "bogie-1", {0.0, 0.0, 0.0}, {0.0, 1e4, 0.0}, braked.stiffness);
  expect_rejected(braked, {"k.mtx: row", "(pitch of WS1)", "stiffness of 1e+04 N m/rad", "turns freely"});
  braked = free_coach();
  add_spring(braked, "WS1", "bogie-1", {0.0, 0.0, 0.0}, {0.0, 50.0, 0.0}, braked.damping);
  expect_rejected(braked, {"c.mtx: row", "(pitch of WS1)", "damping of 50 N m s/rad", "turns freely"});
  FreeCoach geared = free_coach();
  const int wheelset = geared.row("WS3", pitch), bogie = geared.row("bogie-2", pitch);
  geared.mass(wheelset, bogie) = geared.mass(bogie, wheelset) = 20.0;
  expect_rejected(geared, {"m.mtx: row", "(pitch of WS3)", "shared with", "pitch of bogie-2"});
}

TEST_F(VehicleImportFiles, HaveInnerUnknownsOnSprings) {
  FreeCoach coach = free_coach();
  coach.hang_mass(100.0, 0.0);
  expect_rejected(coach, {"k.mtx: row 43 (of no body)", "inner degree of freedom", "springs hold"});
}

TEST_F(VehicleImportFiles, HaveATableThatFits) {
  expect_table_rejected(",WS1,rotz,", ",lost,rotz,", {"dofs.csv:", "wheelset WS1 without yaw", "a row for each"});
  expect_table_rejected("1,CAR,x,", "# ", {"dofs.csv:", "car body CAR without x"});
  expect_table_rejected("42,WS4", "43,WS4", {"dofs.csv:43", "row 43", "1 to 42"});
  expect_table_rejected("42,WS4", "41,WS4", {"dofs.csv:43", "row 41 again"});
  expect_table_rejected("WS2,roty", "WS2,rotx", {"dofs.csv:", "rotx of body WS2 again"});
  expect_table_rejected("WS2,roty", "WS2,pitch", {"dofs.csv:", "motion 'pitch'", "rotz"});
  expect_table_rejected("42,WS4,rotz,", "42,WS4,rotz,nan,", {"dofs.csv:43", "row,body,motion,x,y,z"});
  expect_table_rejected("1,CAR,x,0,", "1,CAR,x,nan,", {"dofs.csv:2", "'nan'", "finite"});
  expect_table_rejected("1,CAR,x,0,", "1,CAR,x,0.1,", {"dofs.csv:3", "CAR at another place", "dofs.csv:2"});
  expect_table_rejected("bogie-1", "coach/bogie", {"dofs.csv:", "coach/bogie", "without /"});
  expect_table_rejected("bogie-1", "wheelset-2", {"dofs.csv:", "a body named wheelset-2", "another name"});
  expect_table_rejected("row,body", "row,node", {"dofs.csv:1", "row,body,motion,x,y,z"});
  expect_table_rejected("bogie-2", "bogie-1", {"dofs.csv:", "bogie-1 at another place"});
}

TEST_F(VehicleImportFiles, StandWhereTheSceneSays) {
  write(free_coach());
  EXPECT_EQ(message([&] { static_cast<void>(import_vehicle(files())); }), "no error");
  VehicleImport wrong = files();
  std::swap(wrong.wheelsets[0], wrong.wheelsets[3]);
  expect_rejected(wrong, {"vehicle.wheelsets", "WS2 at x = 8.22 m after WS4 at -10.78 m", "from the front"});
  wrong = files();
  wrong.wheelsets[1] = "WS9";
  expect_rejected(wrong, {"vehicle.wheelsets", "WS9", "one of CAR, bogie-1"});
  wrong = files();
  wrong.car_body = "BODY";
  expect_rejected(wrong, {"vehicle.car_body", "BODY", "one of CAR"});
  wrong = files();
  wrong.frame.origin = std::array{0.0, 0.1, 0.0};
  expect_rejected(wrong, {"dofs.csv:", "WS1 at y = -0.1 m", "track's centre"});
  wrong = files();
  wrong.frame.axes = "x -y -z";
  expect_rejected(wrong, {"dofs.csv:", "the axle of WS1 -0.46 m above the rails", "vehicle.axes"});
  wrong.frame.axes = "x y -z";
  expect_rejected(wrong, {"vehicle.axes", "left-handed"});
  wrong = files();
  wrong.frame.units = "ft-lb";
  expect_rejected(wrong, {"vehicle.units", "ft-lb", "mm-N-t"});
  wrong = files();
  wrong.length = 20.0;
  expect_rejected(wrong, {"vehicle.length", "20 m", "outer wheelsets, 21.56 m"});
}

TEST_F(VehicleImportFiles, HaveMatricesOfOneSize) {
  write(free_coach());
  write("c.mtx", Eigen::MatrixXd::Identity(41, 41));
  expect_rejected(files(), {"c.mtx", "41 x 41", "42 x 42"});
  const Eigen::Index n = most_vehicle_rows + 1;
  write("k.mtx", fmt::format("%%MatrixMarket matrix coordinate real general\n{0} {0} 1\n1 1 1.0\n", n));
  expect_rejected(files(), {"k.mtx", "1001 rows", "at most 1000"});
  write("k.mtx", "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 inf\n");
  expect_rejected(files(), {"k.mtx:3", "'inf'", "finite"});
}

TEST_F(VehicleImportFiles, AreNamedByTheScene) {
  write(free_coach());
  const std::string online = "[contact]\nmode = \"online\"\n";
  EXPECT_EQ(scene(online + vehicle_section()).train.vehicle, "imported");
  EXPECT_EQ(scene(vehicle_section() + online + "[train]\nvehicle = \"imported\"\ncount = 3\n").train.count, 3);
  const auto rejected = [&](const std::string& text, std::string_view words) {
    const std::string what = message([&] {
      const SceneParameters read = scene(text);
      try {
        static_cast<void>(build_model(read));
      } catch (const InputError& wrong) {
        throw with_scene_line(wrong, read, folder_ / "scene.toml");
      }
    });
    EXPECT_NE(what.find(words), std::string::npos) << what;
  };
  const auto without = [&](const std::string& line) {
    std::string text = vehicle_section();
    text.erase(text.find(line), text.find('\n', text.find(line)) + 1 - text.find(line));
    return online + text;
  };
  const std::string rigid = "[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n";
  rejected("train.vehicle = \"imported\"\n" + online, "scene.toml:1: train.vehicle: found \"imported\" without all");
  rejected("train.vehicle = \"manchester-coach\"\n" + online + vehicle_section(),
           "scene.toml:5: vehicle.mass: found train.vehicle = \"manchester-coach\"");
  rejected(without("damping"), "vehicle.damping");
  rejected(without("wheelsets"), "vehicle.wheelsets: found none");
  rejected(without("car_body"), "vehicle.car_body: found none");
  rejected(without("length") + "[train]\ncount = 2\n", "vehicle.length: found none, and 2 vehicles");
  rejected(without("car_body") + "car_body = \"WS2\"\n", "vehicle.wheelsets: found WS2 twice");
  rejected(without("wheelsets") + "wheelsets = [\"WS1\", \"WS7\"]\n" + rigid,
           "scene.toml:11: vehicle.wheelsets: found WS7, expected one of");
  rejected(
      online + "dimensions.nominal_radius = 0.4575\n" + vehicle_section() + rigid,
      "scene.toml:3: contact.dimensions.nominal_radius: found 0.4575 m, expected 0.46 m, the wheels of the vehicle of");
}

}  // namespace
}  // namespace railtab
