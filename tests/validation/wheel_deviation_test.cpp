// Wheels that are not round: closed forms of the deviation, and what it does in runs.

#include "railtab/runtime/line/wheel_deviation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi, radius = 0.46;

double slope_by_difference(const WheelDeviation& wheel, double angle) {
  constexpr double h = 1e-6;
  return (wheel.at(angle + h).rise - wheel.at(angle - h).rise) / (2.0 * h);
}

TEST(WheelDeviation, SharpFlatTurnsTheWheelAboutItsEdges) {
  const double length = 0.06, half = std::asin(0.5 * length / radius);
  const WheelDeviation wheel(radius, {{WheelFlat::Edges::sharp, length, 1.0}}, {});
  // over the edge the centre is R cos of the angle to the vertical above it; on the whole flat it is L²/(8R) lower
  for (const double theta : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
    const double expected = radius * (std::cos(half - std::abs(theta) * half) - 1.0);
    EXPECT_NEAR(wheel.at(1.0 + theta * half).rise, expected, 1e-15) << theta;
    EXPECT_NEAR(wheel.at(1.0 + theta * half - 6.0 * pi).rise, expected, 1e-14) << "six half turns before";
  }
  EXPECT_NEAR(wheel.at(1.0).rise / (-length * length / (8.0 * radius)), 1.0, 2e-3);
  EXPECT_EQ(wheel.at(1.0 + 1.001 * half).rise, 0.0);
  EXPECT_NEAR(wheel.at(1.0 + 0.5 * half).slope, slope_by_difference(wheel, 1.0 + 0.5 * half), 1e-8);
  // falling, then rising: at the kink the slope jumps by 2 R sin φ
  EXPECT_NEAR(wheel.at(1.0 + 1e-9).slope - wheel.at(1.0 - 1e-9).slope, length, 1e-8);
}

TEST(WheelDeviation, RoundedFlatHarmonicAndContour) {
  const double length = 0.06, half = std::asin(0.5 * length / radius), depth = length * length / (16.0 * radius);
  const WheelDeviation rounded(radius, {{WheelFlat::Edges::rounded, length, 0.0}}, {});
  EXPECT_NEAR(rounded.at(0.0).rise, -depth, 1e-15);
  EXPECT_NEAR(rounded.at(0.5 * half).rise, -0.5 * depth, 1e-15);
  EXPECT_NEAR(rounded.at(half).rise, 0.0, 1e-15);
  EXPECT_NEAR(rounded.at(0.4 * half).slope, slope_by_difference(rounded, 0.4 * half), 1e-8);
  EXPECT_NEAR(rounded.at(0.4 * half).curvature,
              (rounded.at(0.4 * half + 1e-6).slope - rounded.at(0.4 * half - 1e-6).slope) / 2e-6, 1e-4);

  const WheelDeviation polygon(radius, {}, {{18, 2e-5, 0.1}});
  EXPECT_NEAR(polygon.at(0.1 + 2.0 * pi * 5.0 / 18.0).rise, 2e-5, 1e-17);
  EXPECT_NEAR(polygon.at(0.2).rise, 2e-5 * std::cos(1.8), 1e-17);
  EXPECT_NEAR(polygon.at(0.2).curvature, -18.0 * 18.0 * polygon.at(0.2).rise, 1e-12);

  // a contour through samples of a run-out: third order in the spacing
  const auto error = [](int n) {
    WheelContour contour;
    for (int i = 0; i < n; ++i) {
      contour.angle.push_back(2.0 * pi * i / n + 0.3);
      contour.rise.push_back(1e-4 * std::sin(contour.angle.back()));
    }
    const WheelDeviation wheel(radius, {}, {}, contour);
    double largest = 0.0;
    for (double a = -7.0; a < 7.0; a += 0.0137) {
      largest = std::max(largest, std::abs(wheel.at(a).rise - 1e-4 * std::sin(a)));
    }
    return largest;
  };
  EXPECT_LT(error(72), 1e-8);
  EXPECT_GT(std::log2(error(36) / error(72)), 2.5);
}

TEST(WheelDeviation, RejectsWhatIsNoWheel) {
  EXPECT_THROW(WheelDeviation(radius, {{WheelFlat::Edges::sharp, 0.5, 0.0}}, {}), InputError);
  EXPECT_THROW(WheelDeviation(radius, {}, {{0, 1e-4, 0.0}}), InputError);
  EXPECT_THROW(WheelDeviation(radius, {}, {{1, 0.05, 0.0}}), InputError);
  EXPECT_THROW(WheelDeviation(radius, {}, {}, {{0.0, 1.0, 2.0}, {0.0, 0.0, 0.0}}), InputError);
  EXPECT_THROW(WheelDeviation(radius, {}, {}, {{0.0, 1.0, 2.0, 6.4}, {0.0, 0.0, 0.0, 0.0}}), InputError);
}

constexpr double sprung = 10000.0, wheelset_mass = 1500.0, stiffness = 2e6, damping = 3e4;

// A mass on a spring above one wheelset, vertical motion alone, on rigid rails.
VsiModel sprung_wheelset(double speed) {
  VsiModel model;
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle({"sprung wheelset",
                                    {{"mass", sprung, {1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}},
                                     {"wheelset", wheelset_mass, {1.0, 1.0, 1.0}, {0.0, 0.0, -radius}}},
                                    {{0, 1, {0.0, 0.0, -0.7}, {0.0, 0.0, stiffness}, {0.0, 0.0, damping}}},
                                    {1},
                                    {all_but_z, all_but_z},
                                    radius,
                                    10.0});
  model.vehicle_x = {0.0};
  model.contact.speed = speed;
  return model;
}

struct Force {
  std::vector<double> t, Q;
};

Force run(const VsiModel& model, double time_step, double duration) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  Force force;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    force.t.push_back(record.time);
    force.Q.push_back(record.wheels[0].Q + record.wheels[1].Q);
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  const RunSummary summary = simulate(model, integration, duration, 1, state, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  return force;
}

// The wheelset goes up and down by A cos ωt, ω = n V/R: the force that this takes is known in closed form.
TEST(WheelDeviation, OutOfRoundWheelsetsShakeTheRailsAtTheirRotation) {
  constexpr double speed = 40.0, amplitude = 2e-4;
  for (const int order : {1, 3}) {
    VsiModel model = sprung_wheelset(speed);
    model.normal_contact = NormalContact::rigid;
    model.wheel_deviation.assign(2, WheelDeviation(radius, {}, {{order, amplitude, 0.0}}));
    const double omega = order * speed / radius, period = 2.0 * pi / omega;
    const double step = period / 200.0;
    const Force force = run(model, step, 60.0 * period);
    // over whole periods at the end: amplitude and phase of the force down on the rails
    double c = 0.0, s = 0.0;
    const std::size_t n = 4000, first = force.t.size() - 1 - n;
    for (std::size_t i = first; i < first + n; ++i) {
      c += 2.0 / static_cast<double>(n) * force.Q[i] * std::cos(omega * force.t[i]);
      s += 2.0 / static_cast<double>(n) * force.Q[i] * std::sin(omega * force.t[i]);
    }
    // the wheelset is at z = −A e^{iωt} (z down); Q = −m_w z̈ − D z = A (D − m_w ω²) e^{iωt} with the dynamic stiffness
    // D of what hangs on it
    using Complex = std::complex<double>;
    const Complex link(stiffness, omega * damping);
    const Complex hanging = link - link * link / (link - sprung * omega * omega);
    const Complex expected = amplitude * (hanging - wheelset_mass * omega * omega);
    std::printf("order %d: %.2f N, closed form %.2f N\n", order, std::hypot(c, s), std::abs(expected));
    EXPECT_NEAR(std::hypot(c, s) / std::abs(expected), 1.0, 2e-3);
    EXPECT_NEAR(std::abs(Complex(c, -s) - expected) / std::abs(expected), 0.0, 2e-3);
  }
}

// A new flat: over its first half the centre falls along a circle about the edge, by V²/R. Faster than √(R Q/m) the
// wheel cannot follow, and flies.
TEST(WheelDeviation, WheelFollowsAFlatSlowlyAndFliesFast) {
  const double weight = (sprung + wheelset_mass) * standard_gravity;
  const double limit = std::sqrt(radius * weight / wheelset_mass);  // 5.9 m/s
  const auto least_and_peak = [&](double share, double length) {
    VsiModel model = sprung_wheelset(share * limit);
    model.geometry = std::make_shared<const ContactGeometry>(
        ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                    ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
    model.contact.geometry = model.geometry.get();
    model.contact.friction = 0.0;
    model.contact.damping = 2.0;
    const double half = std::asin(0.5 * length / radius), begin = 0.02 * share * limit / radius;
    model.wheel_deviation.assign(2, WheelDeviation(radius, {{WheelFlat::Edges::sharp, length, begin + half}}, {}));
    const double fall = radius * half / (share * limit);
    const Force force = run(model, 2e-5, 0.02 + 2.0 * fall + 0.03);
    double sum = 0.0, peak = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < force.t.size(); ++i) {
      peak = std::max(peak, force.Q[i]);
      if (force.t[i] < 0.02 + 0.3 * fall || force.t[i] > 0.02 + 0.95 * fall) continue;
      sum += force.Q[i];
      ++count;
    }
    return std::pair{sum / count / weight, peak / weight};
  };
  const auto [slow, slow_peak] = least_and_peak(0.5, 0.08);
  const auto [medium, medium_peak] = least_and_peak(0.8, 0.08);
  const auto [fast, fast_peak] = least_and_peak(1.5, 0.08);
  std::printf("Q/Q0 on the first half: %.3f, %.3f, %.3f; peaks %.2f, %.2f, %.2f\n", slow, medium, fast, slow_peak,
              medium_peak, fast_peak);
  // the spring above relaxes by what the wheelset falls, 1.7 mm of 20 mm at the kink
  EXPECT_NEAR(slow, 1.0 - 0.25, 0.06);
  EXPECT_NEAR(medium, 1.0 - 0.64, 0.06);
  EXPECT_LT(fast, 0.02);
  EXPECT_GT(slow_peak, 1.5);
  EXPECT_GT(medium_peak, slow_peak);
}

}  // namespace
}  // namespace railtab
