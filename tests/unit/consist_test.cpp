// Trains of different vehicles, turned vehicles and joints.
#include "railtab/runtime/vehicle/consist.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/vehicle/joint_file.hpp"
#include "railtab/runtime/vehicle/separate_systems.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_file.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {
namespace {

const std::filesystem::path articulated = RAILTAB_SOURCE_DIR "/docs/examples/articulated";

ConsistEntry entry(const std::string& vehicle, int count = 1, bool reversed = false) {
  return {vehicle, count, reversed};
}
ConsistEntry example(const std::string& name, int count = 1, bool reversed = false) {
  return entry((articulated / (name + ".toml")).string(), count, reversed);
}

std::vector<double> wheel_loads(const VehicleModel& vehicle) {
  std::vector<double> loads;
  for (int w = 0; w < static_cast<int>(vehicle.wheelsets.size()); ++w) loads.push_back(static_wheel_load(vehicle, w));
  return loads;
}

VehicleModel model_of(const std::vector<ConsistEntry>& entries, MotionPlane plane = MotionPlane::spatial) {
  return build_consist(read_consist(entries, {}), plane, {}, ForceElementChoice::linear);
}

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const InputError& wrong) {
    return wrong.what();
  }
  return "no InputError";
}

TEST(ConsistEntry, HasSignNameAndCount) {
  const auto e = parse_consist_entry("-power-car*2");
  ASSERT_TRUE(e);
  EXPECT_EQ(e->vehicle, "power-car");
  EXPECT_EQ(e->count, 2);
  EXPECT_TRUE(e->reversed);
  EXPECT_FALSE(parse_consist_entry("coach")->reversed);
  for (const char* wrong : {"", "-", "coach*0", "coach*101", "coach*x", "coach*", "*3"}) {
    EXPECT_FALSE(parse_consist_entry(wrong)) << wrong;
  }
}

/// Results hold checksums of all files that a scene reads: of vehicles, and of the joints that these name.
TEST(Consist, JointsAreAmongTheFilesOfAScene) {
  const SceneParameters scene = read_scene(RAILTAB_SOURCE_DIR "/docs/examples/articulated.toml");
  std::vector<std::string> names;
  for (const std::filesystem::path& file : scene.files) names.push_back(file.filename().string());
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"coach.toml", "coupler.toml", "end-coach.toml", "jacobs-bogie.toml",
                                             "power-car.toml"}));
}

/// As the head of docs/examples/articulated.toml says: bogies pass at the span's first natural frequency.
TEST(Consist, TheArticulatedExampleCrossesItsSpanAtResonance) {
  const VsiModel model = build_model(read_scene(RAILTAB_SOURCE_DIR "/docs/examples/articulated.toml"));
  constexpr double bogie_distance = 18.7;  // m
  const double omega = std::sqrt(lowest_modes(model.structure->stiffness, model.structure->mass, 1).omega2[0]);
  EXPECT_NEAR(model.contact.speed, bogie_distance * omega / (2.0 * std::numbers::pi), 0.005 * model.contact.speed);
}

/// Wheels of docs/examples/eurostar.toml carry the shares of their coaches by the law of the lever, with bogies and
/// wheelsets of their own; the two halves of the train mirror each other.
TEST(Eurostar, WheelsCarryTheSharesOfTheirCoaches) {
  const VsiModel model = build_model(read_scene(RAILTAB_SOURCE_DIR "/docs/examples/eurostar.toml"));
  const std::vector<double> loads = wheel_loads(model.vehicle);
  const double long_end = 13.252 / 18.7, short_end = 5.448 / 18.7;  // of EC1 and EC9
  const double front = 9.774 / 18.7, rear = 8.926 / 18.7;           // of EC2 to EC8
  const double motor_bogie = 2200.0 + 2 * 1700.0, trailer_bogie = 2900.0 + 2 * 1900.0;
  std::vector<double> bogies(2, 0.5 * 51500.0 + motor_bogie);
  bogies.push_back(35860.0 * long_end + motor_bogie);
  bogies.push_back(35860.0 * short_end + 22525.0 * front + trailer_bogie);
  for (int coach = 2; coach < 8; ++coach) bogies.push_back(22525.0 * (rear + front) + trailer_bogie);
  bogies.push_back(22525.0 * rear + 27122.0 * short_end + trailer_bogie);
  bogies.push_back(27122.0 * long_end + trailer_bogie);
  std::vector<double> expected;
  for (const double mass : bogies) expected.insert(expected.end(), 2, 0.25 * 9.81 * mass);
  ASSERT_EQ(loads.size(), 2 * expected.size());
  for (std::size_t w = 0; w < expected.size(); ++w) {
    EXPECT_NEAR(loads[w], expected[w], 1e-6 * expected[w]) << w;
    EXPECT_NEAR(loads[loads.size() - 1 - w], expected[w], 1e-6 * expected[w]) << w;
  }
}

TEST(Consist, OfUnlikeVehiclesLoadsItsWheelsAsEachVehicleAlone) {
  // six axles, four axles, bodies on side frames; one of them turned round
  const std::vector<std::string> names{"c0c0-locomotive", "manchester-coach", "manchester-coach", "freight-21t"};
  const VehicleModel train =
      model_of({entry(names[0], 1, true), entry(names[1], 2), entry(names[3])}, MotionPlane::vertical);
  std::vector<double> expected;
  for (const std::string& name : names) {
    const std::vector<double> alone = wheel_loads(build_vehicle(library_vehicle(name), MotionPlane::vertical));
    expected.insert(expected.end(), alone.begin(), alone.end());
  }
  const std::vector<double> loads = wheel_loads(train);
  ASSERT_EQ(loads.size(), 6U + 4U + 4U + 4U);
  for (std::size_t w = 0; w < loads.size(); ++w) EXPECT_NEAR(loads[w] / expected[w], 1.0, 1e-9) << w;
  EXPECT_EQ(train.coaches, 4);
}

TEST(Consist, TurnedVehicleIsItsMirrorImageAboutTheVertical) {
  VehicleData data = read_vehicle_file(articulated / "power-car.toml");
  data.parts.bodies[0].position.x() = 0.4;  // off the middle
  const VehicleDescription turned = reversed(data.parts);
  EXPECT_EQ(turned.bodies[0].position.x(), -0.4);
  EXPECT_EQ(turned.bodies[1].name, "bogie-2");
  EXPECT_EQ(turned.bodies[1].position.x(), -7.0);
  EXPECT_EQ(turned.bodies[static_cast<std::size_t>(turned.wheelsets[0])].name, "wheelset-1");
  EXPECT_GT(turned.bodies[static_cast<std::size_t>(turned.wheelsets[0])].position.x(), 8.0);
  const auto loads_of = [](VehicleDescription parts) {
    parts.held_dofs = held_motions(parts, MotionPlane::spatial);
    return wheel_loads(assemble_vehicle(parts));
  };
  std::vector<double> ahead = loads_of(data.parts), back = loads_of(turned);
  EXPECT_GT(ahead[0], 1.01 * ahead[3]);
  for (std::size_t w = 0; w < 4; ++w) EXPECT_NEAR(back[w] / ahead[3 - w], 1.0, 1e-9);
  const VehicleDescription twice = reversed(turned);
  for (std::size_t b = 0; b < twice.bodies.size(); ++b) {
    EXPECT_EQ(twice.bodies[b].name, data.parts.bodies[b].name);
    EXPECT_EQ(twice.bodies[b].position, data.parts.bodies[b].position);
  }
}

TEST(Consist, ArticulatedTrainSharesItsBogies) {
  const VehicleModel train = model_of({example("power-car"), example("end-coach"), example("coach", 2),
                                       example("end-coach", 1, true), example("power-car", 1, true)});
  // by the lever rule: a car body stands on both bogies alike
  const double power = 68000.0 / 8, own = (28000.0 / 2 + 7000.0) / 4, mixed = (28000.0 / 2 + 26000.0 / 2 + 7000.0) / 4,
               shared = (26000.0 + 7000.0) / 4;
  std::vector<double> expected(4, power);
  for (const double mass : {own, mixed, shared, mixed, own}) expected.insert(expected.end(), 2, mass);
  expected.insert(expected.end(), 4, power);
  const std::vector<double> loads = wheel_loads(train);
  ASSERT_EQ(loads.size(), expected.size());
  for (std::size_t w = 0; w < loads.size(); ++w) EXPECT_NEAR(loads[w] / (9.81 * expected[w]), 1.0, 1e-7) << w;
  // bogies of the coaches stand 18.7 m apart
  const auto x = [&](std::size_t w) { return train.bodies[static_cast<std::size_t>(train.wheelsets[w])].position.x(); };
  for (std::size_t w = 4; w + 2 < 14; w += 2) EXPECT_NEAR(x(w) - x(w + 2), 18.7, 1e-12);
  for (std::size_t w = 0; w + 1 < loads.size(); ++w) EXPECT_GT(x(w), x(w + 1));
  // springs along x join all car bodies: the first one's x alone is held
  int held_cars = 0, cars = 0;
  for (std::size_t b = 0; b < train.bodies.size(); ++b) {
    if (train.bodies[b].name != "car-body") continue;
    ++cars;
    held_cars += train.dof[b][0] == held ? 1 : 0;
  }
  EXPECT_EQ(cars, 6);
  EXPECT_EQ(held_cars, 1);
}

TEST(Consist, FallsToNoSideAndIsSymmetric) {
  // the same train seen from the other end is the same train
  const std::vector<ConsistEntry> entries{example("power-car"), example("end-coach"), example("coach"),
                                          example("end-coach", 1, true)};
  std::vector<ConsistEntry> turned(entries.rbegin(), entries.rend());
  for (ConsistEntry& e : turned) e.reversed = !e.reversed;
  std::vector<double> ahead = wheel_loads(model_of(entries)), back = wheel_loads(model_of(turned));
  std::reverse(back.begin(), back.end());
  for (std::size_t w = 0; w < ahead.size(); ++w) EXPECT_NEAR(ahead[w] / back[w], 1.0, 1e-9);
}

/// Velocities of a vehicle that moves ahead at 1 m/s, or turns at 1 rad/s about the vertical at x0, as a rigid body.
enum class RigidMotion { ahead, turning };
Eigen::VectorXd rigid_motion(const VehicleModel& train, int coach, RigidMotion motion, double x0) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(train.dofs());
  for (std::size_t b = 0; b < train.bodies.size(); ++b) {
    if (train.bodies[b].coach != coach) continue;
    const DofIndices& dof = train.dof[b];
    if (motion == RigidMotion::ahead) {
      v[dof[0]] = 1.0;
    } else {
      v[dof[1]] = train.bodies[b].position.x() - x0;
      v[dof[5]] = 1.0;
    }
  }
  return v;
}

/// A coupler resists by kx and cx; two inter-car dampers by cx each, at the distance y from the middle also where a
/// coach turns about its joint.
TEST(Consist, CouplersAndInterCarDampersActBetweenCarBodies) {
  const VehicleModel train = model_of(
      {example("power-car"), example("end-coach"), example("end-coach", 1, true), example("power-car", 1, true)});
  constexpr double coupler_k = 5e6, coupler_c = 50e3, damper_c = 100e3, damper_y = 0.9;
  const auto power = [](const Eigen::MatrixXd& matrix, const Eigen::VectorXd& v) { return v.dot(matrix * v); };
  const Eigen::VectorXd power_car = rigid_motion(train, 3, RigidMotion::ahead, 0.0);
  EXPECT_NEAR(power(train.stiffness, power_car), coupler_k, 1e-6 * coupler_k);
  EXPECT_NEAR(power(train.damping, power_car), coupler_c, 1e-6 * coupler_c);
  const Eigen::VectorXd coach = rigid_motion(train, 2, RigidMotion::ahead, 0.0);
  EXPECT_NEAR(power(train.damping, coach), 2.0 * damper_c + coupler_c, 1e-6 * damper_c);
  double joint_x = 0.0;  // in the middle of the shared bogie
  for (const VehicleBody& body : train.bodies) {
    if (body.name == "joint-bogie") joint_x = body.position.x();
  }
  const Eigen::VectorXd turning = rigid_motion(train, 2, RigidMotion::turning, joint_x);
  EXPECT_NEAR(power(train.damping, turning), 2.0 * damper_c * damper_y * damper_y, 1e-6 * damper_c);
}

// Unlike vehicles that nothing joins are separate systems, whose dofs no matrix couples; a response by systems is that
// of the whole.
TEST(SeparateSystems, AreVehiclesThatNothingJoins) {
  const VehicleModel train =
      build_consist(read_consist({entry("c0c0-locomotive", 1, true), entry("chinese-emu-car", 2)}, {}),
                    MotionPlane::spatial, {}, ForceElementChoice::nonlinear);
  const std::vector<SeparateSystem> systems = separate_systems(train);
  ASSERT_EQ(systems.size(), 3U);
  EXPECT_EQ(systems[0].wheelsets, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(systems[2].wheelsets, (std::vector<int>{10, 11, 12, 13}));
  EXPECT_EQ(systems[0].elements.size(), 0U);
  EXPECT_GT(systems[1].elements.size(), 0U);
  EXPECT_EQ(systems[1].elements.size() + systems[2].elements.size(), train.elements.element.size());
  std::vector<bool> found(static_cast<std::size_t>(train.dofs()), false);
  Eigen::MatrixXd rest = train.stiffness.cwiseAbs() + train.damping.cwiseAbs() + train.gyroscopic.cwiseAbs();
  for (const SeparateSystem& system : systems) {
    for (const int dof : system.dofs) {
      EXPECT_FALSE(found[static_cast<std::size_t>(dof)]) << dof;
      found[static_cast<std::size_t>(dof)] = true;
    }
    rest(system.dofs, system.dofs).setZero();
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), false), 0);
  EXPECT_TRUE(rest.isZero(0.0));

  const HhtScheme scheme{.alpha = -0.05, .time_step = 1e-3};
  const Eigen::MatrixXd effective = effective_matrix(scheme, train.mass, train.damping, train.stiffness);
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(train.dofs(), 1e3, 5e3);
  const Eigen::VectorXd moved = VehicleResponse(train, train.damping, scheme).displacement(load);
  EXPECT_LT((effective * moved - load).cwiseAbs().maxCoeff(), 1e-6);
}

class ConsistFiles : public testing::InFolder {};

// A joint joins what it connects, also one that is a bump stop alone.
TEST_F(ConsistFiles, JointsMakeOneSystem) {
  EXPECT_EQ(
      separate_systems(model_of({example("power-car"), example("end-coach"), example("end-coach", 1, true)})).size(),
      1U);
  const auto joined_by = [&](const std::string& values) {
    std::ofstream(folder_ / "joint.toml")
        << "name = \"joint\"\ndescription = \"a joint\"\nnominal_radius = 0.4575\n[[connection]]\nname = \"b\"\n"
        << "joins = [[\"ahead/car-body\", \"behind/car-body\"]]\nheight = 1.0\n"
        << values;
    return separate_systems(build_consist(read_consist({entry("ordinary-coach", 3)}, folder_ / "joint.toml"),
                                          MotionPlane::spatial, {}, ForceElementChoice::nonlinear))
        .size();
  };
  EXPECT_EQ(joined_by("cy = 1e3\n"), 1U);
  EXPECT_EQ(joined_by("stop_y = [[0.05, 0.0], [0.06, 1e5]]\n"), 1U);
}

TEST_F(ConsistFiles, SayWhatIsWrong) {
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const auto text_of = [](const std::string& name) {
    std::ifstream in(articulated / name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (const char* name : {"power-car.toml", "end-coach.toml", "coach.toml", "jacobs-bogie.toml", "coupler.toml"}) {
    write(name, text_of(name));
  }
  const auto train = [&](const std::vector<std::string>& names) {
    std::vector<ConsistEntry> entries;
    for (const std::string& name : names) entries.push_back(entry((folder_ / name).string()));
    return message_of([&] { static_cast<void>(model_of(entries)); });
  };
  EXPECT_EQ(train({"power-car.toml", "end-coach.toml", "coach.toml", "coach.toml"}).find("no InputError"),
            std::string::npos)
      << "the last coach hangs at its joint";
  EXPECT_NE(message_of([&] {
              static_cast<void>(build_vehicle(read_vehicle_file(folder_ / "coach.toml"), MotionPlane::spatial));
            }).find("stands on bogies of its joints"),
            std::string::npos);
  EXPECT_NE(train({"power-car.toml", "coach.toml"}).find("the same joint in the files of both neighbours"),
            std::string::npos);
  for (const char* name : {"end-coach.toml", "coach.toml"}) {
    const auto read_with = [&](const std::string& check) {
      write("checked.toml", replaced(text_of(name), "[check]\n", "[check]\n" + check + "\n"));
      return message_of([&] { static_cast<void>(read_vehicle_file(folder_ / "checked.toml")); });
    };
    for (const char* check : {"axle_load = 17000.0", "bounce = [0.5, 1.5]"}) {
      EXPECT_NE(read_with(check).find("found a check of a vehicle that stands on joints, expected mass alone"),
                std::string::npos)
          << name << ": " << read_with(check);
    }
  }
  write("coupler.toml", replaced(text_of("coupler.toml"), "behind/car-body", "behind/frame"));
  EXPECT_NE(train({"power-car.toml", "end-coach.toml", "coach.toml"}).find("body 'behind/frame'"), std::string::npos);
  write("coupler.toml", replaced(text_of("coupler.toml"), "behind/car-body", "frame"));
  EXPECT_NE(train({"power-car.toml", "end-coach.toml", "coach.toml"}).find("behind/car-body"), std::string::npos);
  write("power-car.toml", replaced(text_of("power-car.toml"), "coupler.toml", "none.toml"));
  EXPECT_NE(train({"power-car.toml", "coach.toml"}).find("no file"), std::string::npos);
}

TEST_F(ConsistFiles, SceneNamesCoachesAndBodies) {
  write("scene.toml",
        "[train]\nconsist = [\"-c0c0-locomotive\", \"manchester-coach*2\"]\n[contact]\nnormal = "
        "\"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 1.0\n[[load]]\nbody = "
        "\"car-body\"\nFz = 1e3\n[[load]]\nbody = \"bogie-2\"\ncoach = 3\nFz = 1e3\n");
  const SceneParameters scene = read_scene(folder_ / "scene.toml");
  const VsiModel model = build_model(scene);
  EXPECT_EQ(model.wheelsets(), 14);
  const std::vector<std::string> names = model_header(model).body_names;
  for (const char* name : {"coach-1/car-body", "coach-1/wheelset-6", "coach-2/car-body", "coach-3/bogie-2"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
  ASSERT_EQ(model.loads.size(), 2U);
  EXPECT_EQ(model.loads[0].bodies.size(), 3U);
  ASSERT_EQ(model.loads[1].bodies.size(), 1U);
  EXPECT_EQ(names[static_cast<std::size_t>(model.loads[1].bodies[0])], "coach-3/bogie-2");
  // vehicles of one kind run as before
  write("alike.toml",
        "[train]\nconsist = [\"manchester-coach*3\"]\n[contact]\nnormal = \"rigid\"\n[track]\nkind = "
        "\"rigid\"\n[integration]\nduration = 1.0\n");
  const VsiModel alike = build_model(read_scene(folder_ / "alike.toml"));
  EXPECT_EQ(alike.vehicle_x.size(), 3U);
  EXPECT_EQ(alike.vehicle.coaches, 1);
  const auto wrong = [&](const std::string& train) {
    write("wrong.toml", "[train]\n" + train + "\n[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n");
    return message_of([&] { static_cast<void>(read_scene(folder_ / "wrong.toml")); });
  };
  EXPECT_NE(wrong("consist = [\"manchester-coach*0\"]").find("\"manchester-coach*0\" in the list"), std::string::npos);
  for (const char* entry : {"manchester-coach*0", "manchester-coach*101", "manchester-coach * 2"}) {
    const std::string message = wrong(std::string("consist = [\"") + entry + "\"]");
    EXPECT_NE(message.find("\"NAME*N\" with N from 1 to 100, without blanks around the *"), std::string::npos)
        << message;
  }
  EXPECT_NE(wrong("consist = []").find("train.consist: found an empty list, expected a list of vehicles"),
            std::string::npos);
  EXPECT_NE(wrong("consist = [\"manchester\"]").find("manchester-coach"), std::string::npos);
  EXPECT_NE(wrong("consist = [\"manchester-coach\"]\ncount = 2").find("train.consist too"), std::string::npos);
  EXPECT_NE(wrong("consist = [\"manchester-coach*60\", \"velaro-e-coach*60\"]").find("120 vehicles"),
            std::string::npos);
}

}  // namespace
}  // namespace railtab
