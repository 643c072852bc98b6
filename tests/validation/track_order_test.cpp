// Order of wheel forces in the time step over flexible track, and what limits it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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

Forces forces(double torsional_stiffness, int elements_per_bay, double time_step) {
  SceneParameters scene;
  scene.train.speed = 200.0 / 3.6;
  scene.contact.mode = ContactMode::online;
  scene.contact.wheel = "cone-1:20";
  scene.contact.creep_law = "linear";
  scene.track.length_before = 60.0;
  scene.track.length_after = 40.0;
  scene.track.rail.GJ = torsional_stiffness;
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

// Linear torsion gives the rail's roll a kink at every pad, and with it the force on its nodes, which no step ends at.
// A rail that does not twist has none, but the curvature of its elements jumps at nodes, the less the shorter they are.
// Two elements per bay that do not deflect between their nodes: 32 N with torsion; 7.5 N at order 1.9 without.
TEST(TrackOrder, ForcesAreOfSecondOrderButForTheKinksOfTorsionAtPads) {
  struct Case {
    const char* name;
    double torsional_stiffness;  // N m²
    int elements_per_bay;        // 0: the default
    double least_order, largest_order;
    double largest_difference;  // of Q, of steps of 0.5 and 0.25 ms [N]
  };
  for (const Case& c : {Case{"torsion", RailBeamParameters{}.GJ, 0, 0.7, 1.3, 15.0},
                        Case{"no_torsion", 1e9, 0, 1.3, 2.6, 6.0}, Case{"no_torsion_4", 1e9, 4, 1.7, 2.6, 6.0}}) {
    const auto of = [&](double time_step) { return forces(c.torsional_stiffness, c.elements_per_bay, time_step); };
    const Forces coarse = of(5e-4), middle = of(2.5e-4), fine = of(1.25e-4);
    const double first = rms_difference(coarse.Q, middle.Q), second = rms_difference(middle.Q, fine.Q);
    const double order = std::log2(first / second);
    const double Y = rms_difference(coarse.Y, middle.Y);
    std::printf(
        "%s: Q of 0.5 and 0.25 ms differ by %.1f N, of 0.25 and 0.125 ms by %.1f N, order %.2f; Y of 0.5 and 0.25 ms "
        "by %.1f N\n",
        c.name, first, second, order, Y);
    testing::measured(std::string("track_order.") + c.name, order);
    testing::measured(std::string("track_order.") + c.name + ".Q", first);
    testing::measured(std::string("track_order.") + c.name + ".Y", Y);
    EXPECT_GT(order, c.least_order);
    EXPECT_LT(order, c.largest_order);
    EXPECT_LT(first, c.largest_difference);
  }
}

}  // namespace
}  // namespace railtab
