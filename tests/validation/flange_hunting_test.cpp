// Hunting with flanges [MontenegroCalcada2023, section 4.3, model C]: the equations of motion up to the first touch,
// then impacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "../measured.hpp"
#include "flange_model.hpp"

namespace railtab::hunting {
namespace {

constexpr double yaw = flange_start_yaw, duration = 3.6;

struct Agreement {
  double miss = 0, peak = 0;  ///< of the lateral shift before the first touch [m]
  double lag = 0;             ///< of the zero crossings, largest [s]
};

Agreement with_equations(const FlangeRun& run) {
  const double dt = run.t[1] - run.t[0];
  const EquationsOfMotion equations(flange_speed);
  EquationsOfMotion::State s{0.0, flange_speed * yaw, yaw, 0.0};
  Agreement result;
  std::vector<double> zeros, zeros_of_run;
  for (std::size_t i = 1; i < run.t.size() && run.t[i] < run.impacts.at(0).begin; ++i) {
    const double before = s[0];
    for (int k = 0; k < 10; ++k) equations.step(0.1 * dt, s);
    result.miss = std::max(result.miss, std::abs(run.y[i] - s[0]));
    result.peak = std::max(result.peak, std::abs(s[0]));
    const auto crossing = [&](double a, double b) { return run.t[i] - dt * b / (b - a); };
    if (before * s[0] < 0.0) zeros.push_back(crossing(before, s[0]));
    if (run.y[i - 1] * run.y[i] < 0.0) zeros_of_run.push_back(crossing(run.y[i - 1], run.y[i]));
  }
  for (std::size_t i = 0; i < std::min(zeros.size(), zeros_of_run.size()); ++i)
    result.lag = std::max(result.lag, std::abs(zeros[i] - zeros_of_run[i]));
  return result;
}

double total_created(const FlangeRun& run) {
  double sum = 0.0;
  for (const FlangeImpact& impact : run.impacts) sum += std::abs(impact.created);
  return sum;
}

const FlangeRun& realistic_run() {
  static const FlangeRun run =
      run_flanged(flanged_wheelset(FlangeRoot::realistic), ContactForceRule::energy, 1e-3, yaw, duration);
  return run;
}

// Up to the first touch the same oscillation: its zeros within 1 ms of a period of 325 ms, its height to 5 %
// after nine cycles that make it twice as high (0.4 % per cycle: loads that shift with the roll saturate creep a little
// more).
TEST(FlangeHunting, FollowsTheEquationsOfMotionUntilTheFlangeTouches) {
  const FlangeRun& run = realistic_run();
  ASSERT_GE(run.impacts.size(), 5u);
  const Agreement a = with_equations(run);
  std::printf("first touch at %.3f s; before it %.3f mm of %.3f mm apart, zeros %.2f ms\n", run.impacts[0].begin,
              1e3 * a.miss, 1e3 * a.peak, 1e3 * a.lag);
  testing::measured("flange.first_touch", run.impacts[0].begin);
  testing::measured("flange.zeros_ms", 1e3 * a.lag);
  testing::measured("flange.heights_percent", 100 * a.miss / a.peak);
  EXPECT_GT(a.peak, 5e-3);
  EXPECT_LT(a.miss, 0.05 * a.peak);
  EXPECT_LT(a.lag, 1e-3);
  // Afterwards the flanges hold it: the motion without them would have grown on.
  const double largest = std::abs(*std::max_element(run.y.begin(), run.y.end()));
  EXPECT_LT(largest, 1.05 * a.peak);
}

struct Range {
  double least = 1e9, most = 0.0;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  void measured(const std::string& name) const {
    testing::measured(name + "_least", least);
    testing::measured(name + "_most", most);
  }
};

// The energy that the integration makes in an impact, against the lateral kinetic energy that comes with it.
TEST(FlangeHunting, ImpactsKeepTheirEnergy) {
  Range duration_ms, approach, force, energy;
  double most_made = 0.0;
  for (const FlangeImpact& i : realistic_run().impacts) {
    duration_ms.add(1e3 * (i.end - i.begin));
    approach.add(1e3 * std::abs(i.approach));
    force.add(1e-3 * i.largest_Y);
    energy.add(i.kinetic_energy());
    most_made = std::max(most_made, std::abs(i.created));
    EXPECT_LT(std::abs(i.created), 1e-2 * i.kinetic_energy());
  }
  const FlangeRun endpoint =
      run_flanged(flanged_wheelset(FlangeRoot::realistic), ContactForceRule::endpoint, 1e-3, yaw, duration);
  const double made = total_created(realistic_run()), made_by_endpoint = total_created(endpoint);
  duration_ms.measured("flange.duration_ms");
  approach.measured("flange.approach");
  force.measured("flange.force");
  energy.measured("flange.energy");
  testing::measured("flange.made_micro", 1e6 * most_made);
  testing::measured("flange.made_by_endpoint_J", made_by_endpoint);
  EXPECT_LT(made, 0.01 * made_by_endpoint);
}

// Chords in place of the root stand out further towards the rail: its touch is the earlier one.
TEST(FlangeHunting, SimplifiedRootTouchesSooner) {
  const FlangeRun& realistic = realistic_run();
  const FlangeRun simplified =
      run_flanged(flanged_wheelset(FlangeRoot::simplified), ContactForceRule::energy, 1e-3, yaw, duration);
  testing::measured("flange.simplified_touch", simplified.impacts.at(0).begin);
  EXPECT_LT(simplified.impacts.at(0).begin, realistic.impacts.at(0).begin - 0.1);
}

}  // namespace
}  // namespace railtab::hunting
