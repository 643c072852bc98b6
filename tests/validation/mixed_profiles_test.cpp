// Trains whose vehicles differ in their profiles, radii or tables: each vehicle runs as it would alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

using testing::recorded_steps;

class MixedProfiles : public testing::InFolder {
 protected:
  // On rigid rails nothing but the track excites vehicles that no coupler joins.
  [[nodiscard]] SceneParameters scene(const std::string& train, const std::string& contact,
                                      const std::string& profiles = "") const {
    std::ofstream(folder_ / "scene.toml")
        << "[train]\nspeed = 30.0\n"
        << train << "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n"
        << contact << profiles
        << "[track]\nkind = \"rigid\"\n[irregularity]\nspectrum = \"german-low\"\nfade_in = 0\n"
           "[integration]\ntime_step = 1e-3\nduration = 0.3\ntolerance = 1e-10\n"
           "contact_force = \"endpoint\"\n";
    return read_scene(folder_ / "scene.toml");
  }

  [[nodiscard]] std::string message_of(const SceneParameters& scene) const {
    try {
      static_cast<void>(build_model(scene));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no InputError";
  }
};

/// Largest difference of Q and Y between wheels of two runs [N].
double difference(const std::vector<StepRecord>& a, std::size_t first_of_a, const std::vector<StepRecord>& b,
                  std::size_t first_of_b, std::size_t wheels) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (std::size_t w = 0; w < wheels; ++w) {
      const WheelRecord &p = a[i].wheels.at(first_of_a + w), &q = b[i].wheels.at(first_of_b + w);
      largest = std::max({largest, std::abs(p.Q - q.Q), std::abs(p.Y - q.Y)});
    }
  }
  return largest;
}

TEST_F(MixedProfiles, TheSameProfilesAgainChangeNothing) {
  const std::string train = "vehicle = \"manchester-coach\"\ncount = 2\n";
  const std::vector<StepRecord> one = recorded_steps(scene(train, "")),
                                two = recorded_steps(scene(train, "", "[[profiles]]\ncoach = 2\nwheel = \"S1002\"\n"));
  EXPECT_EQ(difference(one, 0, two, 0, 16), 0.0);
}

// Coach 1 on S1002, coach 2 on cones: each as in a train that has its profile throughout.
TEST_F(MixedProfiles, EveryCoachRunsOnItsOwnProfile) {
  const std::string train = "vehicle = \"manchester-coach\"\ncount = 2\n";
  const std::vector<StepRecord> all = recorded_steps(scene(train, "")),
                                cones = recorded_steps(scene(train, "wheel = \"cone-1:40\"\n")),
                                mixed = recorded_steps(
                                    scene(train, "", "[[profiles]]\ncoach = 2\nwheel = \"cone-1:40\"\n"));
  EXPECT_EQ(difference(mixed, 0, all, 0, 8), 0.0);
  EXPECT_EQ(difference(mixed, 8, cones, 8, 8), 0.0);
  EXPECT_GT(difference(mixed, 8, all, 8, 8), 1.0) << "the profiles differ in what they do";
}

// A locomotive on wheels of another radius than its coach's: separate systems, of which each is as it is alone.
TEST_F(MixedProfiles, VehiclesOfUnlikeRadiusRunAsAlone) {
  const VsiModel train = build_model(scene("consist = [\"c0c0-locomotive\", \"manchester-coach\"]\n", "",
                                           "[[profiles]]\nvehicle = \"c0c0-locomotive\"\n"));
  ASSERT_EQ(train.wheelset_geometry.size(), 10U);
  const double radius = train.vehicle.wheel_radius.front();
  EXPECT_NE(radius, 0.46);
  EXPECT_EQ(train.geometry->pair().nominal_radius(), radius);
  EXPECT_EQ(train.geometry_of(9).pair().nominal_radius(), 0.46);

  const std::vector<StepRecord> mixed = recorded_steps(scene("consist = [\"c0c0-locomotive\", \"manchester-coach\"]\n",
                                                             "", "[[profiles]]\nvehicle = \"c0c0-locomotive\"\n"));
  const std::vector<StepRecord> locomotive = recorded_steps(scene(
      "vehicle = \"c0c0-locomotive\"\n", "[contact.dimensions]\nnominal_radius = " + std::to_string(radius) + "\n"));
  ASSERT_EQ(mixed.front().wheels.size(), 20U);
  EXPECT_LT(difference(mixed, 0, locomotive, 0, 12), 1e-2);  // of 1e5 N: order of the sums, Newton's tolerance

  // the coach alone, from where it stands in the train
  const double behind = train.wheelset_x(6, 0.0) - train.wheelset_x(0, 0.0);
  SceneParameters alone = scene("vehicle = \"manchester-coach\"\n", "");
  alone.train.start = behind;
  alone.spectrum = std::nullopt;
  VsiModel coach = build_model(alone);
  coach.irregularity = train.irregularity;
  std::vector<StepRecord> records;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) { records.push_back(record); };
  EXPECT_TRUE(run_scene(alone, coach, observer).complete);
  EXPECT_LT(difference(mixed, 12, records, 0, 8), 1e-2);
}

// In a gust that leans coaches on their stops and makes dampers blow off, each vehicle of a mixed train moves as it
// does alone, with its own force elements.
TEST_F(MixedProfiles, VehiclesWithForceElementsRunAsAlone) {
  const auto in_gust = [&](const std::string& train) {
    std::ofstream(folder_ / "scene.toml")
        << "[train]\nspeed = 30.0\n"
        << train
        << "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[contact.dimensions]\nnominal_radius = 0.4575\n"
           "[[load]]\nFy = 60e3\ngust_duration = 0.6\n"
           "[track]\nkind = \"rigid\"\n[integration]\ntime_step = 1e-3\nduration = 0.5\ntolerance = 1e-10\n";
    const SceneParameters scene = read_scene(folder_ / "scene.toml");
    return recorded_steps(scene);
  };
  const std::vector<StepRecord> mixed = in_gust(
                                    "consist = [\"chinese-emu-car\", \"-chinese-emu-car\", \"ordinary-coach\"]\n"),
                                car = in_gust("vehicle = \"chinese-emu-car\"\n"),
                                coach = in_gust("vehicle = \"ordinary-coach\"\n"),
                                linear = in_gust("vehicle = \"chinese-emu-car\"\nforce_elements = \"linear\"\n");
  ASSERT_EQ(mixed.front().wheels.size(), 24U);
  EXPECT_GT(difference(car, 0, linear, 0, 8), 1e3) << "the elements act";
  const double of_car = difference(mixed, 0, car, 0, 8), of_coach = difference(mixed, 16, coach, 0, 8);
  std::printf("mixed train: wheel forces as alone within %.1e N and %.1e N\n", of_car, of_coach);
  EXPECT_LT(of_car, 1e-3);  // of 1e5 N: rounding of positions in the train
  EXPECT_LT(of_coach, 1e-3);
  // the symmetric car turned round is the same car: other order of the sums
  EXPECT_LT(difference(mixed, 8, car, 0, 8), 1e-2);
}

TEST_F(MixedProfiles, AreInTheHeader) {
  const SceneParameters s =
      scene("vehicle = \"manchester-coach\"\ncount = 2\n", "", "[[profiles]]\ncoach = 1\nwheel = \"cone-1:40\"\n");
  const ResultHeader header = result_header(s, build_model(s));
  EXPECT_EQ(header.wheel_profile, "cone-1:40");
  ASSERT_EQ(header.wheel_outline.size(), 16U);
  for (std::size_t wheel = 0; wheel < 16; ++wheel) EXPECT_EQ(header.wheel_outline[wheel], wheel < 8 ? 1.0 : 0.0);
  const auto says = [&](const std::string& text) {
    return std::any_of(header.built.begin(), header.built.end(),
                       [&](const std::string& line) { return line.find(text) != line.npos; });
  };
  EXPECT_TRUE(says("coach 1: contact geometry: online, cone-1:40 on 60E1"));
  EXPECT_TRUE(says("coach 2: contact geometry: online, S1002 on 60E1"));
}

TEST_F(MixedProfiles, RejectWhatDoesNotFit) {
  const std::string train = "vehicle = \"manchester-coach\"\ncount = 2\n";
  EXPECT_NE(message_of(scene(train, "", "[[profiles]]\ncoach = 3\n")).find("[[profiles]] 1 of 1: found no wheelset"),
            std::string::npos)
      << message_of(scene(train, "", "[[profiles]]\ncoach = 3\n"));
  const std::string unlike = message_of(scene("consist = [\"manchester-coach\", \"c0c0-locomotive\"]\n", ""));
  EXPECT_NE(unlike.find("contact.dimensions.nominal_radius"), std::string::npos) << unlike;
  EXPECT_NE(unlike.find("coach 2"), std::string::npos) << unlike;
  EXPECT_NE(unlike.find("[[profiles]]"), std::string::npos) << unlike;
}

// Where the first coach has cones and the second S1002, the linear critical speed is that of the first.
TEST_F(MixedProfiles, FirstVehicleIsJudgedOnItsOwn) {
  const std::string train = "vehicle = \"manchester-coach\"\ncount = 2\n";
  const auto growth = [](const SceneParameters& s) { return least_stable_motion(stability_model(s), 60.0).growth; };
  const double cones = growth(scene(train, "wheel = \"cone-1:40\"\n")),
               mixed = growth(scene(train, "", "[[profiles]]\ncoach = 1\nwheel = \"cone-1:40\"\n"));
  EXPECT_EQ(mixed, cones);
  EXPECT_NE(mixed, growth(scene(train, "")));
}

}  // namespace
}  // namespace railtab
