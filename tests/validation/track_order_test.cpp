// Order of wheel forces in the time step over flexible track.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

struct Forces {
  std::vector<double> Q, Y;  // every millisecond, all wheels [N]
};

Forces forces(int elements_per_bay, double time_step) {
  SceneParameters scene;
  scene.train.speed = 200.0 / 3.6;
  scene.contact.mode = ContactMode::online;
  scene.contact.wheel = "cone-1:20";
  scene.contact.creep_law = "linear";
  scene.track.length_before = 60.0;
  scene.track.length_after = 40.0;
  scene.track.elements_per_bay = elements_per_bay;
  scene.integration.time_step = time_step;
  scene.integration.tolerance = 1e-8;
  scene.integration.duration = 0.15;
  scene.output.every = static_cast<int>(std::lround(1e-3 / time_step));
  Forces result;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    for (const WheelRecord& wheel : record.wheels) {
      result.Q.push_back(wheel.Q);
      result.Y.push_back(wheel.Y);
    }
  };
  EXPECT_TRUE(run_scene(scene, observer).complete);
  return result;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// Rails that bend and twist without kinks load their nodes smoothly as a wheel passes. The curvature of the shapes
// jumps at nodes, the less the shorter elements are, and excites vibrations near 1 kHz. Without them Y has higher
// harmonics of the sleepers' passing. The first of these steps resolve neither, the last do.
TEST(TrackOrder, WheelForcesConvergeAsFarAsStepsResolveThem) {
  struct Case {
    const char* name;
    int elements_per_bay;  // 0: the default
    double least_order_of_Q, least_order_of_Y, largest_of_Q, largest_of_Y;
  };
  constexpr double last_order = 1.8, highest_order = 2.7;
  for (const Case& c : {Case{"one", 0, 1.3, 0.5, 6.0, 5.0}, Case{"four", 4, 1.85, 1.75, 3.5, 6.0},
                        Case{"eight", 8, 1.85, 1.2, 3.5, 6.0}}) {
    std::vector<Forces> by_halving;
    for (int halvings = 0; halvings < 6; ++halvings) {
      by_halving.push_back(forces(c.elements_per_bay, std::ldexp(5e-4, -halvings)));
    }
    const auto examine = [&](const std::string& force, auto of, double least_order, double largest) {
      const auto difference = [&](std::size_t i) { return rms_difference(by_halving[i].*of, by_halving[i + 1].*of); };
      const double first = difference(0), order = 0.5 * std::log2(first / difference(2));
      const double finest = std::log2(difference(3) / difference(4));
      std::printf(
          "%s per bay: %s of 0.5 and 0.25 ms differ by %.2f N, order over two halvings %.2f, over the last %.2f\n",
          c.name, force.c_str(), first, order, finest);
      const std::string key = std::string("track_order.") + c.name + "." + force;
      testing::measured(key, first);
      testing::measured(key + ".order", order);
      testing::measured(key + ".finest_order", finest);
      EXPECT_GT(order, least_order);
      EXPECT_LT(order, highest_order);
      EXPECT_GT(finest, last_order);
      EXPECT_LT(finest, highest_order);
      EXPECT_LT(first, largest);
    };
    examine("Q", &Forces::Q, c.least_order_of_Q, c.largest_of_Q);
    examine("Y", &Forces::Y, c.least_order_of_Y, c.largest_of_Y);
  }
}

}  // namespace
}  // namespace railtab
