// Vehicle files: what they mean, and what is rejected with which words.
#include "railtab/runtime/vehicle/vehicle_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_warnings.hpp"
#include "railtab/runtime/vehicle/joint_file.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vehicle/vehicle_plausibility.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"

namespace railtab {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

std::string manchester() { return library_vehicle("manchester-coach").text; }

std::string message_of(const std::string& text) {
  try {
    const VehicleData data = parse_vehicle(text, "coach.toml");
    require_closing(data);
    static_cast<void>(build_vehicle(data, data.motion));
  } catch (const InputError& wrong) {
    return wrong.what();
  }
  return "no InputError";
}

void expect_rejected(const std::string& text, const std::vector<std::string>& words) {
  const std::string message = message_of(text);
  for (const std::string& word : words) EXPECT_NE(message.find(word), message.npos) << message << "\nwithout: " << word;
}

/// Two axles without bogies, of all that a file needs without template.
const std::string wagon = R"(name = "wagon"
description = "two axles"
nominal_radius = 0.46
length = 9.0

[car_body]
mass = 20000.0
Jx = 2e4
Jy = 1e5
Jz = 1e5
height = 1.5

[wheelset]
x = [2.5, -2.5]
mass = 1500.0
Jx = 900.0
Jy = 100.0
Jz = 900.0

[[connection]]
name = "springs"
joins = [["wheelset-1", "car-body"], ["wheelset-2", "car-body"]]
y = 1.0
both_sides = true
kx = 5e6
ky = 4e6
kz = 1e6
cz = 3e4
)";

TEST(VehicleFile, OfBodiesAndConnectionsIsTheModelOfItsParts) {
  const VehicleModel built = build_vehicle(parse_vehicle(wagon, "wagon.toml"), MotionPlane::spatial);
  VehicleDescription parts;
  parts.name = "wagon";
  parts.bodies = {{"car-body", 20000.0, {2e4, 1e5, 1e5}, {0.0, 0.0, -1.5}},
                  {"wheelset-1", 1500.0, {900.0, 100.0, 900.0}, {2.5, 0.0, -0.46}},
                  {"wheelset-2", 1500.0, {900.0, 100.0, 900.0}, {-2.5, 0.0, -0.46}}};
  for (const int w : {1, 2}) {
    for (const double y : {-1.0, 1.0}) {
      parts.suspension.push_back({w, 0, {w == 1 ? 2.5 : -2.5, y, -0.46}, {5e6, 4e6, 1e6}, {0.0, 0.0, 3e4}});
    }
  }
  parts.wheelsets = {1, 2};
  parts.held_dofs.assign(3, DofIndices{0, 0, 0, 0, 0, 0});
  parts.held_dofs[0][0] = held;
  parts.length = 9.0;
  const VehicleModel expected = assemble_vehicle(parts);
  EXPECT_EQ(built.stiffness, expected.stiffness);
  EXPECT_EQ(built.damping, expected.damping);
  EXPECT_EQ(built.mass, expected.mass);
  EXPECT_EQ(built.static_load, expected.static_load);
  EXPECT_EQ(built.length, 9.0);
}

/// N e_y, the couple of a spring under N whose upper end has moved aside by e_y, turns the lower body by (1 − λ) N e_y
/// and the upper one by λ N e_y.
TEST(VehicleFile, CoupleShareDividesTheCoupleOfThePreload) {
  const std::string half = manchester(), fifth = replaced(half, "[secondary]", "[secondary]\ncouple_share = 0.2");
  const VehicleModel a = build_vehicle(parse_vehicle(half, "half.toml"), MotionPlane::spatial),
                     b = build_vehicle(parse_vehicle(fifth, "fifth.toml"), MotionPlane::spatial);
  const Eigen::MatrixXd K = b.stiffness - a.stiffness;
  const double moved = 0.3 * 32000.0 * 9.81;  // of the couple per e_y, from the car body to its two bogies
  const int car_y = a.dof[0][1], car_roll = a.dof[0][3];
  EXPECT_NEAR(std::abs(K(car_roll, car_y)), moved, 1e-6 * moved);
  for (const std::size_t bogie : {1U, 2U}) {
    EXPECT_NEAR(K(a.dof[bogie][3], car_y), -0.5 * K(car_roll, car_y), 1e-6 * moved);
  }
  EXPECT_NEAR(b.stiffness(car_roll, car_y) - build_vehicle(parse_vehicle(half, "half.toml"), MotionPlane::spatial,
                                                           {standard_gravity, GeometricStiffness::omitted})
                                                 .stiffness(car_roll, car_y),
              -0.2 / 0.3 * K(car_roll, car_y), 1e-6 * moved);
  expect_rejected(replaced(half, "[primary]", "[primary]\ncouple_share = 1.2"), {"couple_share", "1.2"});
}

TEST(VehicleFile, TemplateIsShortForBodiesAndConnections) {
  const VehicleData coach = library_vehicle("manchester-coach");
  std::string text = R"(name = "manchester-coach"
description = "the same without template"
nominal_radius = 0.46
length = 26.4
[car_body]
mass = 32000.0
Jx = 56800.0
Jy = 1.97e6
Jz = 1.97e6
height = 1.8
[[body]]
name = "bogie"
x = [9.5, -9.5]
height = 0.6
mass = 2615.0
Jx = 1722.0
Jy = 1476.0
Jz = 3067.0
[wheelset]
x = [10.78, 8.22, -8.22, -10.78]
mass = 1813.0
Jx = 1120.0
Jy = 112.0
Jz = 1120.0
[[connection]]
name = "primary"
joins = [["wheelset-1", "bogie-1"], ["wheelset-2", "bogie-1"], ["wheelset-3", "bogie-2"], ["wheelset-4", "bogie-2"]]
y = 1.0
both_sides = true
kx = 31.391e6
ky = 3.884e6
kz = 1.220e6
cx = 15e3
cy = 2e3
cz = 4e3
[[connection]]
name = "secondary"
joins = [["bogie-1", "car-body"], ["bogie-2", "car-body"]]
y = 1.0
both_sides = true
height = 0.8275
kx = 0.160e6
ky = 0.160e6
kz = 0.430e6
cy = 32e3
cz = 20e3
k_roll = 480.5e3
k_pitch = 10.5e3
)";
  const VehicleModel general = build_vehicle(parse_vehicle(text, "coach.toml"), MotionPlane::spatial);
  const VehicleModel built = build_vehicle(coach, MotionPlane::spatial);
  EXPECT_LT((general.stiffness - built.stiffness).norm(), 1e-14 * built.stiffness.norm());
  EXPECT_LT((general.damping - built.damping).norm(), 1e-14 * built.damping.norm());
  EXPECT_EQ(general.mass, built.mass);
}

TEST(VehicleFile, ThreeAxlesStandAroundTheBogiesCentre) {
  const VehicleData data = library_vehicle("c0c0-locomotive");
  std::vector<double> x;
  for (const int w : data.parts.wheelsets) x.push_back(data.parts.bodies[static_cast<std::size_t>(w)].position.x());
  EXPECT_EQ(x, (std::vector<double>{5.642 + 2.15, 5.642, 5.642 - 2.15, -5.642 + 2.15, -5.642, -5.642 - 2.15}));
}

TEST(VehicleFile, ValuesInheritTheirProvenance) {
  const VehicleData data =
      parse_vehicle(replaced(replaced(wagon, "length = 9.0",
                                      "length = { value = 9.0, standing = \"suspect\", note = \"once 8.5\" }\n"
                                      "source = \"drawing 12\"\ndate = \"1987\"\nstanding = \"verified\""),
                             "[wheelset]", "[wheelset]\nstanding = \"assumed\""),
                    "wagon.toml");
  const auto value = [&](std::string_view key) {
    const auto found = std::find_if(data.sourced.values.begin(), data.sourced.values.end(),
                                    [&](const auto& v) { return v.key == key; });
    EXPECT_NE(found, data.sourced.values.end()) << key;
    return *found;
  };
  EXPECT_EQ(value("length").provenance.standing, Standing::suspect);
  EXPECT_EQ(value("length").provenance.note, "once 8.5");
  EXPECT_EQ(value("length").provenance.source, "drawing 12");
  EXPECT_EQ(value("car_body.mass").provenance.standing, Standing::verified);
  EXPECT_EQ(value("wheelset.mass").provenance.standing, Standing::assumed);
  EXPECT_EQ(value("connection[1].kz").provenance.date, "1987");
  EXPECT_EQ(value("connection[1].kz").unit, "N/m");
}

TEST(VehicleFile, SaysWhatIsNotLinear) {
  const VehicleData data = parse_vehicle(
      wagon +
          "damper_curve_y = [[0.1, 2500], [0.3, 3585]]\nstop_y = [[0.025, 0], [0.03, 600]]\nfriction_x = 4e3\n"
          "friction_ratio_z = 0.2\nfriction_yaw = 5e3\nstand_in_for = \"leaf springs\"\n",
      "wagon.toml");
  EXPECT_EQ(data.parts.suspension[0].damping.y(), 25000.0);  // the slope of the first segment
  EXPECT_EQ(data.nonlinear, (std::vector<std::string>{"springs along x: dry friction of 4000 N",
                                                      "springs along y: damper of 2 points, up to 3585 N at 0.3 m/s",
                                                      "springs along y: stop from 0 N at 25 mm to 600 N at 30 mm",
                                                      "springs along z: dry friction of 0.2 times the load along z",
                                                      "springs about z: dry friction of 5000 N m"}));
  EXPECT_EQ(data.stand_ins, (std::vector<std::string>{"springs: a linear stand-in for leaf springs"}));
  EXPECT_EQ(data.linearised,
            (std::vector<std::string>{
                "springs along y: its damper of 2 points, up to 3585 N at 0.3 m/s, runs linearly with 25000 N s/m",
                "springs along z: dry friction of 0.2 times the load along z runs as a linear damper of 30000 N s/m",
                "springs: a linear stand-in for leaf springs"}));
  EXPECT_EQ(data.left_out, (std::vector<std::string>{"springs along x: dry friction of 4000 N",
                                                     "springs along y: its stop, from 0 N at 25 mm to 600 N at 30 mm",
                                                     "springs about z: dry friction of 5000 N m"}));
}

// The model of a run has the elements in place of their stand-ins, that of natural motions the stand-ins.
TEST(VehicleFile, BuildsTheElementsOrTheirStandIns) {
  const VehicleData data = parse_vehicle(
      wagon +
          "damper_curve_y = [[0.1, 2500], [0.3, 3585]]\nseries_ky = 1e6\nstop_y = [[0.025, 0], [0.03, 600]]\n"
          "friction_ratio_z = 0.2\n",
      "wagon.toml");
  const VehicleModel linear = build_vehicle(data, MotionPlane::spatial);
  const VehicleModel built = build_vehicle(data, MotionPlane::spatial, {}, ForceElementChoice::nonlinear);
  EXPECT_TRUE(linear.elements.empty());
  const std::size_t units = data.parts.suspension.size();
  ASSERT_EQ(built.elements.element.size(), 3 * units);
  EXPECT_EQ(built.dofs(), linear.dofs());
  EXPECT_EQ(built.stiffness, linear.stiffness);
  // dampers along y in series and along z are elements now; the wagon has no others
  EXPECT_GT(linear.damping.norm(), 0.0);
  EXPECT_EQ(built.damping.norm(), 0.0);
  // all springs together carry the car body: 20 t
  double load = 0.0;
  for (const ForceElement& e : built.elements.element) load += e.load;
  double weight = 0.0;
  for (int w = 0; w < 2; ++w) weight += 2.0 * static_wheel_load(built, w);
  weight -= 9.81 * (data.parts.bodies[1].mass + data.parts.bodies[2].mass);
  EXPECT_NEAR(load, weight, 1e-6 * weight);
  // rigid motions of the whole vehicle stretch nothing
  EXPECT_LT((built.elements.rows * built.lateral_shift).norm(), 1e-12);
}

TEST(VehicleFile, RejectsKeysThatItDoesNotKnow) {
  expect_rejected(replaced(manchester(), "half_wheelbase", "half_wheelbse"),
                  {"coach.toml:", "layout.half_wheelbase", "found nothing", "expected a number, 0.05 to 100 m"});
  expect_rejected(replaced(manchester(), "[roll_bar]\n", "[roll_bar]\nstifness = 1.0\n"),
                  {"coach.toml:", "unknown key 'roll_bar.stifness'; did you mean 'roll_bar.stiffness'?"});
  expect_rejected(replaced(manchester(), "[roll_bar]", "[rollbar]"),
                  {"unknown key 'rollbar'; did you mean 'roll_bar'?"});
  expect_rejected(wagon + "k = 1.0\n", {"unknown key 'connection[1].k'"});
  expect_rejected(wagon + "[bogie]\nmass = 1.0\n", {"unknown key 'bogie'"});
}

TEST(VehicleFile, RejectsValuesWithFileLineAndKey) {
  expect_rejected(replaced(manchester(), "mass = 32000.0", "mass = \"32 t\""),
                  {"coach.toml:", "car_body.mass: found the text \"32 t\", expected a number, 1 to 1e+06 kg"});
  expect_rejected(replaced(manchester(), "mass = 32000.0", "mass = -1.0"), {"car_body.mass: found -1"});
  expect_rejected(replaced(manchester(), "mass = 32000.0", "mass = nan"), {"car_body.mass: found nan"});
  expect_rejected(replaced(manchester(), "height = 0.6", "height = 600.0"),
                  {"bogie.height: found 600, expected a number, 0.05 to 100 m"});
  expect_rejected(replaced(manchester(), "mass = 32000.0", "mass = { value = 32000.0, sorce = \"x\" }"),
                  {"car_body.mass: found { sorce = … }", "source, date, standing, note"});
  expect_rejected(replaced(manchester(), "standing = \"verified\"", "standing = \"certain\""),
                  {"standing: found the text \"certain\", expected one of verified, assumed, suspect"});
  expect_rejected(replaced(manchester(), "template = \"two-bogie\"", "template = \"three-piece\""),
                  {"template: found the text \"three-piece\", expected one of two-bogie"});
  expect_rejected(replaced(manchester(), "0.46", "46.0"), {"nominal_radius: found 46, expected a number, 0.05 to 2 m"});
  expect_rejected(replaced(wagon, "length = 9.0", "length = 4.0"),
                  {"length: found 4 m, expected more than the distance of the outer wheelsets, 5 m"});
  expect_rejected(replaced(wagon, "x = [2.5, -2.5]", "x = [-2.5, 2.5]"),
                  {"wheelset.x: found 2.5 m after -2.5 m", "in order from the front"});
  expect_rejected(wagon + "series_ky = 1e6\n",
                  {"connection[1].series_ky: found a stiffness in series without damper, expected cy too"});
  expect_rejected(wagon + "stop_y = [[0.03, 600], [0.02, 900]]\n",
                  {"connection[1].stop_y", "[0.02, 900] after [0.03, 600]", "points", "m and N"});
  expect_rejected(wagon + "stop_y = [[0.02, 600], [0.03, 900]]\n",
                  {"connection[1].stop_y: found 2 points, first 600 N", "there the free travel ends"});
  expect_rejected(wagon + "damper_curve_y = [[0.02, 600], [0.03, 500]]\n",
                  {"connection[1].damper_curve_y: found [0.03, 500]", "whose forces do not fall"});
  expect_rejected(wagon + "friction_y = 600\ndamper_curve_y = [[0.02, 600]]\n",
                  {"connection[1].friction_y: found dry friction in a connection with a damper of its own",
                   "a [[connection]] for each"});
  expect_rejected(wagon + "friction_ratio_y = 11\n", {"connection[1].friction_ratio_y: found 11"});
  for (const char* none : {"0", "0.0", "{ value = 0, source = \"drawing\" }"}) {
    expect_rejected(wagon + "series_kz = " + none + "\n",
                    {"connection[1].series_kz: found 0, expected more than 0 N/m, or no series_kz"});
  }
  expect_rejected("name = ", {"coach.toml:1: "});
}

TEST(VehicleFile, KeysOfLateralMotionHaveNoEffectOnVerticalData) {
  const std::string vertical = library_vehicle("velaro-e-coach").text;
  const auto expect_idle = [&](const std::string& section, const std::string& key, const std::string& path) {
    expect_rejected(replaced(vertical, section + "\n", section + "\n" + key + " = 1.0\n"),
                    {path + ": found a key that has no effect with motion = \"vertical\"", "expected no " + path});
  };
  expect_idle("[car_body]", "Jx", "car_body.Jx");
  expect_idle("[car_body]", "height", "car_body.height");
  expect_idle("[wheelset]", "Jy", "wheelset.Jy");
  expect_idle("[primary]", "half_distance", "primary.half_distance");
  expect_idle("[secondary]", "ky", "secondary.ky");
  expect_idle("[secondary]", "bending", "secondary.bending");
  expect_rejected(vertical + "[roll_bar]\nstiffness = 1e6\n", {"roll_bar: found a key that has no effect"});
  expect_rejected(vertical +
                      "[[connection]]\nname = \"stay\"\njoins = [[\"bogie-1\", \"car-body\"]]\nkz = 1.0\n"
                      "k_yaw = 1.0\n",
                  {"connection[1].k_yaw: found a key that has no effect with motion = \"vertical\""});
  expect_rejected(replaced(vertical, "[car_body]\n", "[car_body]\nmas = 1.0\n"), {"did you mean 'car_body.mass'?"});
}

/// What lies 10 t heavy on the car body of the wagon, beside the middle.
std::string one_sided_load(double y) {
  return "[[body]]\nname = \"load\"\nx = 0.0\ny = " + std::to_string(y) +
         "\nheight = 1.5\nmass = 10000.0\nJx = 5e3\nJy = 5e3\nJz = 5e3\n[[connection]]\nname = \"lashing\"\n"
         "joins = [[\"load\", \"car-body\"]]\ny = " +
         std::to_string(y) + "\nheight = 1.5\nkx = 1e8\nky = 1e8\nkz = 1e8\nk_roll = 1e8\nk_pitch = 1e8\nk_yaw = 1e8\n";
}

// Of each wheelset's 161.9 kN a load at y takes 32.7 kN per metre from one wheel and gives them to the other.
TEST(VehicleFile, RejectsLoadsThatLiftWheels) {
  expect_rejected(wagon + one_sided_load(3.0),
                  {"coach.toml: wagon: found wheelset-1 whose left wheel carries -17167.5 N",
                   "expected a vehicle that stands on all its wheels"});
  expect_rejected(wagon + one_sided_load(2.1), {"no InputError"});
}

TEST(VehicleFile, RejectsConnectionsThatDoNothing) {
  const std::string empty =
      std::string(wagon) + "[[connection]]\nname = \"cover\"\njoins = [[\"wheelset-1\", \"car-body\"]]\n";
  EXPECT_NE(
      message_of(empty).find("name: found 'cover' without stiffness, damping, friction and stop, expected one of them"),
      std::string::npos)
      << message_of(empty);
  EXPECT_EQ(message_of(empty + "k_roll = 1e5\n"), "no InputError");
}

TEST(VehicleFile, WheelsetsThatNothingJoinsAreTold) {
  const std::string loose = replaced(wagon, "x = [2.5, -2.5]", "x = [2.5, -2.5, -4.0]");
  const std::vector<std::string> sentences = implausible_values(parse_vehicle(loose, "coach.toml"));
  EXPECT_EQ(sentences, std::vector<std::string>{
                           "wagon: no connection joins wheelset-3 to the vehicle: it will run away from the rest"});
  EXPECT_TRUE(implausible_values(parse_vehicle(wagon, "coach.toml")).empty());
}

TEST(VehicleFile, VehiclesAndJointsAreToldApart) {
  std::string without = wagon;
  const std::size_t length = without.find("length = ");
  without.erase(length, without.find('\n', length) + 1 - length);
  expect_rejected(without, {"coach.toml", "length: found nothing", "a file without one is a joint"});
  try {
    static_cast<void>(parse_joint(wagon, "joint.toml"));
    ADD_FAILURE() << "a vehicle is no joint";
  } catch (const InputError& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("length: found a vehicle, which has one, expected a joint"),
              std::string::npos)
        << wrong.what();
  }
}

TEST(VehicleFile, RejectsBodiesThatAreNotThere) {
  expect_rejected(replaced(wagon, "\"wheelset-2\", \"car-body\"", "\"wheelset-2\", \"car_body\""),
                  {"connection[1].joins: found body 'car_body', expected one of car-body, wheelset-1, wheelset-2"});
  expect_rejected(replaced(wagon, "\"wheelset-2\", \"car-body\"", "\"wheelset-2\""),
                  {"connection[1].joins", "pairs of bodies"});
  expect_rejected(replaced(wagon, "kz = 1e6\n", ""), {"a weight of", "that no spring carries"});
}

TEST(VehicleFile, MustCloseWithItself) {
  expect_rejected(replaced(manchester(), "mass = 44482.0", "mass = 45000.0"),
                  {"coach.toml: check: mass: found 44482 kg by the file's own values, expected 44775 to 45225 kg"});
  expect_rejected(replaced(manchester(), "bounce = [1.03, 1.13]", "bounce = [1.3, 1.5]"),
                  {"check: car body bounce: found 1.08016 Hz", "expected 1.3 to 1.5 Hz"});
  expect_rejected(wagon + "[check]\naxle_load = [11500.0, 11500.0, 11500.0]\n",
                  {"check.axle_load: found 3 axle loads, expected one for all or 2"});
  expect_rejected(wagon + "[check]\nmass = 23000.0\naxle_load = 11500.0\n", {"no InputError"});
}

class VehicleInScene : public testing::InFolder {
 protected:
  [[nodiscard]] SceneParameters scene(const std::string& train, const std::string& contact) const {
    write("scene.toml", "[train]\n" + train + "\n[contact]\n" + contact +
                            "\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n");
    return read_scene(folder_ / "scene.toml");
  }
  const std::string rigid = "normal = \"rigid\"", online = "mode = \"online\"";
};

TEST_F(VehicleInScene, IsAFileBesideIt) {
  write("wagon.toml", wagon);
  const SceneParameters parameters = scene("vehicle = \"wagon.toml\"\nspeed_kmh = 20", online);
  ASSERT_EQ(parameters.files.size(), 1U);  // whose checksum the results keep
  const VsiModel model = build_model(parameters);
  EXPECT_EQ(model.vehicle.name, "wagon");
  EXPECT_EQ(model.wheelsets(), 2);
  const RunPlan plan = plan_run(parameters);
  EXPECT_EQ(plan.built.front(), "1 x wagon, 17 degrees of freedom each");
  EXPECT_TRUE(plan.warnings.empty());
}

// On narrow gauge the rails are too near to each other for a load that standard gauge carries.
TEST_F(VehicleInScene, WithoutEquilibriumNamesWeightBesideTheMiddle) {
  write("wagon.toml", wagon + one_sided_load(2.1));
  const SceneParameters narrow = scene("vehicle = \"wagon.toml\"\nspeed_kmh = 20",
                                       online + "\ndimensions.track_gauge = 1.0\ndimensions.flange_back = 0.925");
  EXPECT_EQ(narrow.contact.dimensions.track_gauge, 1.0);
  const RunSummary run = Scene(folder_ / "scene.toml").run([](const StepRecord&) {});
  EXPECT_FALSE(run.complete);
  EXPECT_NE(run.message.find("there is one with the weight in the middle between the rails: at wheelset 1 of vehicle 1 "
                             "the left wheel would carry -15.8 kN"),
            std::string::npos)
      << run.message;
}

TEST_F(VehicleInScene, IsRejectedByTheSceneWhereThereIsNone) {
  const auto message = [&](const std::string& vehicle, const std::string& contact) -> std::string {
    try {
      (void)build_model(scene("vehicle = \"" + vehicle + "\"", contact));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no InputError";
  };
  EXPECT_NE(message("nowhere.toml", online).find("scene.toml:2: train.vehicle: found no file"), std::string::npos);
  EXPECT_NE(
      message("manchester", online).find("a vehicle's TOML file, relative to the scene, or one of c0c0-locomotive"),
      std::string::npos);
  const std::string vertical = message("velaro-e-coach", online);
  EXPECT_NE(
      vertical.find("train.vehicle: found velaro-e-coach, whose data are vertical only, expected contact.normal = "
                    "\"rigid\", or a copy of its file"),
      std::string::npos)
      << vertical;
  EXPECT_EQ(message("velaro-e-coach", rigid), "no InputError");
}

TEST_F(VehicleInScene, WarnsAboveItsTopSpeed) {
  const auto warnings = [&](const std::string& train) {
    const SceneParameters parameters = scene(train, rigid);
    return scene_warnings(parameters, build_model(parameters));
  };
  write("fast.toml", "top_speed_kmh = 120.0\n" + wagon);
  EXPECT_TRUE(warnings("vehicle = \"fast.toml\"\nspeed_kmh = 120").empty());
  const std::vector<std::string> above = warnings("vehicle = \"fast.toml\"\nspeed_kmh = 121");
  ASSERT_EQ(above.size(), 1U);
  EXPECT_EQ(above[0],
            "the train runs at 121 km/h, and the top speed of wagon is 120 km/h: its data do not describe it there");
  write("speed.csv", "t[s],V[km/h]\n0,100\n0.1,130\n");
  const std::vector<std::string> later = warnings("vehicle = \"fast.toml\"\nspeed_file = \"speed.csv\"");
  ASSERT_EQ(later.size(), 2U);
  EXPECT_NE(later[0].find("130 km/h, and the top speed of wagon"), std::string::npos) << later[0];
  EXPECT_NE(later[1].find("speed.csv changes the speed by forces on the car bodies"), std::string::npos) << later[1];
}

/// Rails of the track that are not where the contact's gauge has them.
TEST_F(VehicleInScene, WarnsOfTrackOffTheGauge) {
  const auto told = [&](const std::string& half) {
    write("scene.toml",
          "[contact]\nmode = \"online\"\n[track]\nlength_before = 30\nlength_after = 30\nhalf_rail_distance = " + half +
              "\n[integration]\nduration = 0.1\n");
    const SceneParameters parameters = read_scene(folder_ / "scene.toml");
    std::string all;
    for (const std::string& warning : scene_warnings(parameters, build_model(parameters))) all += warning + "\n";
    return all;
  };
  const std::string off = "from the track centre, at a gauge of 1.435 m";
  EXPECT_EQ(told("0.7").find(off), std::string::npos);
  EXPECT_NE(told("0.25").find("track.half_rail_distance = 0.25 m: contact is on rail heads"), std::string::npos);
  EXPECT_NE(told("1.1").find(off), std::string::npos);
}

/// Scenes on S1002 and 60E1 in which vehicles hunt, or are about to.
class VehicleAtHighSpeed : public testing::InFolder {
 protected:
  /// What is said of trains on rigid rails, in one text.
  [[nodiscard]] std::string warnings(const std::string& train, double radius,
                                     const std::string& inclination = "1:40") const {
    write("scene.toml", "[train]\n" + train + "\n[contact]\nmode = \"online\"\nrail_inclination = \"" + inclination +
                            "\"\ndimensions.nominal_radius = " + std::to_string(radius) +
                            "\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n");
    std::string all;
    for (const std::string& warning : plan_run(read_scene(folder_ / "scene.toml")).warnings) all += warning + "\n";
    return all;
  }
  static void expect(const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << all << "without: " << part;
  }
};

TEST_F(VehicleAtHighSpeed, VehiclesWithoutYawDampersAreWarnedOf) {
  const std::string coach = warnings("vehicle = \"manchester-coach\"\nspeed_kmh = 300", 0.46);
  expect(coach, "the train runs at 300 km/h, above a linear critical speed of manchester-coach on these profiles");
  expect(coach, "the top speed of manchester-coach is 200 km/h");
  EXPECT_EQ(warnings("vehicle = \"manchester-coach\"\nspeed_kmh = 200", 0.46), "");
  expect(warnings("vehicle = \"chinese-high-speed-car\"\nspeed_kmh = 300", 0.4575),
         "the train runs at 300 km/h, above a linear critical speed of chinese-high-speed-car on these profiles");
  EXPECT_EQ(warnings("vehicle = \"chinese-emu-car\"\nspeed_kmh = 270", 0.4575), "");
}

TEST_F(VehicleAtHighSpeed, TheConicityOf3MmCountsWhereSmallMotionsDecay) {
  // on rails at 1:20 the coach's body hunts above 282.5 km/h with the conicity of 3 mm, above 297.9 km/h with that at
  // rest
  const std::string between = warnings("vehicle = \"manchester-coach\"\nspeed_kmh = 290", 0.46, "1:20");
  expect(between, "above the critical speed of manchester-coach at the equivalent conicity 0.009");
  EXPECT_EQ(between.find("above a linear critical speed"), std::string::npos) << between;
  EXPECT_EQ(warnings("vehicle = \"manchester-coach\"\nspeed_kmh = 270", 0.46, "1:20").find("conicity"),
            std::string::npos);
}

TEST_F(VehicleAtHighSpeed, VehiclesOfALargeTrainAreLookedAtAlone) {
  write("coupler.toml",
        "name = \"coupler\"\ndescription = \"coupler\"\nnominal_radius = 0.46\n[[connection]]\n"
        "name = \"coupler\"\njoins = [[\"ahead/car-body\", \"behind/car-body\"]]\nheight = 1.0\n"
        "kx = 5e6\n");
  // 2 x 45 + 9 x 41 degrees of freedom in one system; ice3-like-coach hunts above 253.9 km/h, manchester-coach above
  // 260.2 km/h
  const std::string all = warnings(
      "consist = [\"ice3-like-coach*2\", \"manchester-coach*9\"]\njoint = \"coupler.toml\"\nspeed_kmh = 257", 0.46);
  expect(all, "above a linear critical speed of ice3-like-coach on these profiles");
  EXPECT_EQ(all.find("critical speed of manchester-coach"), std::string::npos) << all;
  expect(all, "the top speed of the train of 2 x ice3-like-coach, 9 x manchester-coach is 200 km/h");
}

TEST_F(VehicleAtHighSpeed, CoachesOnSharedBogiesOfALargeTrainAreNamed) {
  const std::string folder = RAILTAB_SOURCE_DIR "/docs/examples/articulated/";
  const std::string all = warnings("consist = [\"" + folder + "power-car.toml\", \"" + folder + "end-coach.toml\", \"" +
                                       folder + "coach.toml*20\", \"-" + folder + "end-coach.toml\"]\nspeed_kmh = 100",
                                   0.46);
  expect(all, "the critical speed of coach, end-coach is not checked: the train is one system of ");
  EXPECT_EQ(all.find("power-car"), std::string::npos) << all;
}

/// A run of each vehicle over the bridge of docs/examples/demo.toml: what it warns of is what its file says.
class VehicleRun : public testing::InFolder, public ::testing::WithParamInterface<std::string> {};

TEST_P(VehicleRun, CrossesTheDemoBridge) {
  const VehicleData data = library_vehicle(GetParam());
  const bool vertical = data.motion == MotionPlane::vertical;
  const std::string contact = vertical ? "normal = \"rigid\""
                                       : "mode = \"online\"\ncreep_law = \"linear\"\ndimensions.nominal_radius = " +
                                             std::to_string(data.parts.nominal_radius);
  write("scene.toml", "[train]\nvehicle = \"" + GetParam() + "\"\nspeed_kmh = 100\nstart = -10.0\n[contact]\n" +
                          contact +
                          "\n[track]\nlength_before = 40.0\nlength_after = 50.0\n[[bridge]]\nlength = 32.0\n"
                          "damping_ratio = 0.01\n[integration]\ntime_step = 2e-3\nduration = 1.0\n");
  const SceneParameters scene = read_scene(folder_ / "scene.toml");
  const RunPlan plan = plan_run(scene);
  // Of wagons on dry friction, too: by linear stand-ins of it they hunt at that speed.
  const bool freight = GetParam().starts_with("freight");
  EXPECT_EQ(plan.warnings.size(), (data.stand_ins.empty() ? 0U : 1U) + (freight ? 1U : 0U));
  for (const std::string& warning : plan.warnings) {
    const bool hunts = freight && warning.find("above a linear critical speed of " + GetParam()) != std::string::npos;
    EXPECT_TRUE(hunts || warning.starts_with(GetParam() + " has force elements that are not linear: ")) << warning;
  }
  const double static_load = summarise(build_vehicle(data, data.motion), 0).wheel_load.front();
  double highest = 0.0;
  const RunSummary run = Scene(folder_ / "scene.toml").run([&](const StepRecord& step) {
    for (const WheelRecord& wheel : step.wheels) highest = std::max(highest, wheel.Q);
  });
  EXPECT_TRUE(run.complete) << run.message;
  EXPECT_GT(highest, static_load);
  EXPECT_LT(highest, 1.5 * static_load);
}

INSTANTIATE_TEST_SUITE_P(Of, VehicleRun, ::testing::ValuesIn(vehicle_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace railtab
