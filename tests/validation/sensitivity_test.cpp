// What a run keeps over many steps: the amplitude of a free vibration, and how a difference of rounding grows.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "../measured.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

using testing::recorded_steps;

// Masses and springs of the Manchester coach, without a damper.
constexpr const char* undamped_coach = R"(name = "undamped-coach"
description = "Springs and masses of the Manchester coach"
template = "two-bogie"
nominal_radius = 0.46
length = 26.4
source = "Manchester benchmarks"
date = "1998"
standing = "verified"
[car_body]
mass = 32000.0
Jx = 56800.0
Jy = 1.97e6
Jz = 1.97e6
height = 1.8
[bogie]
mass = 2615.0
Jx = 1722.0
Jy = 1476.0
Jz = 3067.0
height = 0.6
[wheelset]
mass = 1813.0
Jx = 1120.0
Jy = 112.0
Jz = 1120.0
[layout]
half_wheelbase = 1.28
half_bogie_distance = 9.5
[primary]
kx = 31.391e6
ky = 3.884e6
kz = 1.220e6
half_distance = 1.0
[secondary]
kx = 0.160e6
ky = 0.160e6
kz = 0.430e6
bending = 10.5e3
half_distance = 1.0
height = 0.8275
[roll_bar]
stiffness = 0.94e6
)";

using FreeMotion = testing::InFolder;

/// Rms over all wheels of Q without its mean over 20 ms: what the wheelsets' vibration on the contact springs leaves.
double ripple(const std::vector<StepRecord>& steps, double begin, double end) {
  const double step = steps[1].time - steps[0].time;
  const auto half = static_cast<std::size_t>(std::lround(0.01 / step));
  double squares = 0.0, count = 0.0;
  for (std::size_t wheel = 0; wheel < steps.front().wheels.size(); ++wheel) {
    double sum = 0.0;
    for (std::size_t i = 0; i <= 2 * half; ++i) sum += steps[i].wheels[wheel].Q;
    for (std::size_t i = half; i + half < steps.size(); ++i) {
      if (steps[i].time >= begin && steps[i].time < end) {
        squares += std::pow(steps[i].wheels[wheel].Q - sum / static_cast<double>(2 * half + 1), 2);
        count += 1.0;
      }
      if (i + half + 1 < steps.size()) sum += steps[i + half + 1].wheels[wheel].Q - steps[i - half].wheels[wheel].Q;
    }
  }
  return std::sqrt(squares / count);
}

TEST_F(FreeMotion, RippleOfTheContactForces) {
  struct Case {
    std::string name;
    std::optional<ContactForceRule> rule;
    double time_step, tolerance, alpha;
  };
  const std::vector<Case> cases{{"automatic", {}, 5e-4, 1e-7, 0.0},
                                {"energy", ContactForceRule::energy, 5e-4, 1e-7, 0.0},
                                {"short", ContactForceRule::energy, 2.5e-4, 1e-7, 0.0},
                                {"tolerance", {}, 5e-4, 1e-4, 0.0},
                                {"damped", {}, 5e-4, 1e-7, -0.05}};
  SceneParameters scene;
  scene.train.vehicle = write("undamped-coach.toml", undamped_coach);
  scene.train.speed = 200.0 / 3.6;
  scene.train.initial_lateral_shift = 3e-4;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.contact.friction = 0.0;
  scene.track_kind = TrackKind::rigid;
  scene.integration.duration = 14.0;
  std::map<std::string, double> growth;
  for (const Case& c : cases) {
    scene.integration.contact_force = c.rule;
    scene.integration.time_step = c.time_step;
    scene.integration.tolerance = c.tolerance;
    scene.integration.alpha = c.alpha;
    const std::vector<StepRecord> steps = recorded_steps(scene);
    const double first = ripple(steps, 0.05, 2.0), last = ripple(steps, 12.0, 13.95);
    growth[c.name] = last / first;
    std::printf("%-10s ripple %.1f N, at the end %.1f N\n", c.name.c_str(), first, last);
    testing::measured("free_motion." + c.name + ".first_N", first);
    testing::measured("free_motion." + c.name + ".last_N", last);
  }
  // The lower modes pass energy on to the wheelsets: steps of a half show it by another rule.
  EXPECT_NEAR(growth["automatic"], growth["short"], 0.1);
  EXPECT_NEAR(growth["energy"], growth["short"], 0.1);
  EXPECT_GT(growth["short"], 1.15);
  EXPECT_NEAR(growth["automatic"], growth["energy"], 0.02);
  EXPECT_LT(growth["tolerance"], growth["short"]);  // what the tolerance leaves out takes energy
  EXPECT_LT(growth["damped"], 0.5);
}

/// Of lateral positions of bodies in two runs [m]. @param first_above when it is more than a millimetre [s]; -1: never
double largest_difference(const std::vector<StepRecord>& a, const std::vector<StepRecord>& b, double& first_above) {
  constexpr double millimetre = 1e-3;
  double largest = 0.0;
  first_above = -1.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (std::size_t body = 0; body < a[i].bodies.size(); ++body) {
      largest = std::max(largest, std::abs(a[i].bodies[body].displacement[1] - b[i].bodies[body].displacement[1]));
    }
    if (first_above < 0.0 && largest > millimetre) first_above = a[i].time;
  }
  return largest;
}

/// Numbers of one run after its first second.
struct Statistics {
  double Q_rms = 0.0, Y_rms = 0.0, shift_rms = 0.0, Q_largest = 0.0, Y_largest = 0.0;

  explicit Statistics(const std::vector<StepRecord>& steps) {
    double n = 0.0, mean = 0.0, Q = 0.0, Y = 0.0, shift = 0.0;
    for (const StepRecord& step : steps) {
      if (step.time < 1.0) continue;
      for (std::size_t w = 0; w < step.wheels.size(); ++w) {
        const WheelRecord& wheel = step.wheels[w];
        n += 1.0;
        mean += wheel.Q;
        Q += wheel.Q * wheel.Q;
        Y += wheel.Y * wheel.Y;
        shift += std::pow(step.bodies[3 + w / 2].displacement[1], 2);
        Q_largest = std::max(Q_largest, wheel.Q);
        Y_largest = std::max(Y_largest, std::abs(wheel.Y));
      }
    }
    Q_rms = std::sqrt(Q / n - std::pow(mean / n, 2));
    Y_rms = std::sqrt(Y / n);
    shift_rms = std::sqrt(shift / n);
  }
};

/// (largest − least)/mean over runs.
double spread(const std::vector<Statistics>& runs, double Statistics::*member) {
  double least = runs.front().*member, largest = least, sum = 0.0;
  for (const Statistics& run : runs) {
    least = std::min(least, run.*member);
    largest = std::max(largest, run.*member);
    sum += run.*member;
  }
  return (largest - least) / (sum / static_cast<double>(runs.size()));
}

SceneParameters coach_on_rough_rails(double speed_kmh, double shift) {
  SceneParameters scene;
  scene.train.speed = speed_kmh / 3.6;
  scene.train.initial_lateral_shift = shift;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.track_kind = TrackKind::rigid;
  scene.spectrum.emplace();
  scene.spectrum->name = "german-low";
  scene.integration.duration = 3.0;
  return scene;
}

constexpr double smallest_shift = 1e-15;  // m: rounding

TEST(Difference, OfRoundingStaysBelowTheCriticalSpeed) {
  const std::vector<StepRecord> a = recorded_steps(coach_on_rough_rails(200.0, 0.0)),
                                b = recorded_steps(coach_on_rough_rails(200.0, smallest_shift));
  double above = 0.0;
  const double difference = largest_difference(a, b, above);
  const Statistics first(a), second(b);
  std::printf("200 km/h: %.1e m; largest Q %.9g and %.9g N\n", difference, first.Q_largest, second.Q_largest);
  testing::measured("difference.200.shift_m", difference);
  testing::measured("difference.200.Q", std::abs(second.Q_largest / first.Q_largest - 1.0));
  EXPECT_LT(difference, 1e-7);
  EXPECT_NEAR(second.Q_largest, first.Q_largest, 1e-5 * first.Q_largest);
  EXPECT_NEAR(second.Y_largest, first.Y_largest, 1e-4 * first.Y_largest);
}

TEST(Difference, OfRoundingGrowsWhereFlangesStrikeAndStatisticsStay) {
  std::vector<Statistics> runs;
  std::vector<StepRecord> reference;
  double above = -1.0;
  for (int i = 0; i < 3; ++i) {
    const std::vector<StepRecord> steps = recorded_steps(coach_on_rough_rails(400.0, i * smallest_shift));
    runs.emplace_back(steps);
    if (i == 0) reference = steps;
    if (i == 1) {
      EXPECT_GT(largest_difference(reference, steps, above), 1e-3);
    }
  }
  const double Q = spread(runs, &Statistics::Q_rms), Y = spread(runs, &Statistics::Y_rms);
  const double shift = spread(runs, &Statistics::shift_rms);
  const double largest_Q = spread(runs, &Statistics::Q_largest), largest_Y = spread(runs, &Statistics::Y_largest);
  std::printf("400 km/h: 1 mm apart after %.2f s; rms of Q, Y, shift %.3f, %.3f, %.3f; largest Q, Y %.3f, %.3f\n",
              above, Q, Y, shift, largest_Q, largest_Y);
  testing::measured("difference.400.above_1_mm_s", above);
  testing::measured("difference.400.Q_rms_percent", 100.0 * Q);
  testing::measured("difference.400.Y_rms_percent", 100.0 * Y);
  testing::measured("difference.400.shift_rms_percent", 100.0 * shift);
  testing::measured("difference.400.Q_largest_percent", 100.0 * largest_Q);
  testing::measured("difference.400.Y_largest_percent", 100.0 * largest_Y);
  EXPECT_GT(above, 0.0);
  EXPECT_LT(Q, 0.25);
  EXPECT_LT(Y, 0.3);
  EXPECT_LT(shift, 0.15);
}

}  // namespace
}  // namespace railtab
