// Bump stops, dampers with blow-off and dry friction: one-mass oscillators in steps of a run against closed forms.
#include "railtab/runtime/vehicle/force_element.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "one_mass_oscillator.hpp"
#include "piecewise_linear_motion.hpp"

namespace railtab {
namespace {

using testing::k;
using testing::m;
using testing::mass_on;
using testing::Oscillator;
using testing::period;
using testing::PiecewiseLinearMotion;
using testing::Regime;

/// Largest difference of the displacement from the exact motion over `periods`, relative to its largest value.
double largest_error(Oscillator& steps, PiecewiseLinearMotion& exact, double time_step, double periods) {
  double error = 0.0, largest = 0.0;
  const long count = std::lround(periods * period / time_step);
  for (long i = 0; i < count; ++i) {
    steps.step();
    exact.advance();
    largest = std::max(largest, std::abs(exact.state()[0]));
    error = std::max(error, std::abs(steps.z() - exact.state()[0]));
  }
  return error / largest;
}

/// ẋ = v, m v̇ = −(k + stiffness) x − c v − force
Regime oscillator(double stiffness, double c, double force) {
  return {Eigen::MatrixXd{{0.0, 1.0}, {-(k + stiffness) / m, -c / m}}, Eigen::Vector2d(0.0, -force / m)};
}

constexpr double travel = 0.025;
NonlinearUnit bump_stop() {
  NonlinearUnit unit;
  unit.stop = ForceCurve({{travel, 0.0}, {travel + 0.01, 6e3}, {travel + 0.02, 30e3}});
  return unit;
}
constexpr double start_rate = 1.0;  // m/s: 50 mm without a stop

PiecewiseLinearMotion exact_stop(double time_step) {
  const double first = 6e5, second = 2.4e6, kink = travel + 0.01;
  return {{oscillator(0.0, 0.0, 0.0), oscillator(first, 0.0, -first * travel), oscillator(first, 0.0, first * travel),
           oscillator(second, 0.0, 6e3 - second * kink), oscillator(second, 0.0, -6e3 + second * kink)},
          [=](const Eigen::VectorXd& y) {
            if (std::abs(y[0]) < travel) return 0;
            return (std::abs(y[0]) < kink ? 1 : 3) + (y[0] < 0.0 ? 1 : 0);
          },
          Eigen::Vector2d(0.0, start_rate),
          time_step};
}

double stop_error(double time_step, double alpha, ContactForceRule rule, double periods) {
  Oscillator mass(mass_on(bump_stop()), {alpha, time_step, rule});
  mass.begin(0.0, start_rate);
  PiecewiseLinearMotion exact = exact_stop(time_step);
  return largest_error(mass, exact, time_step, periods);
}

TEST(BumpStop, MeetsTheClosedFormWithSecondOrder) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    for (const double alpha : {0.0, -0.05}) {
      const double coarse = stop_error(period / 500.0, alpha, rule, 5.0);
      const double fine = stop_error(period / 1000.0, alpha, rule, 5.0);
      EXPECT_LT(fine, 1e-3);
      EXPECT_GT(coarse / fine, 3.3) << alpha;
      EXPECT_LT(coarse / fine, 4.7) << alpha;
    }
  }
}

/// Over 100 periods; the published rule, with forces at the ends of the steps, as the contrast.
TEST(BumpStop, KeepsItsEnergy) {
  const auto drift = [](ContactForceRule rule) {
    Oscillator mass(mass_on(bump_stop()), {0.0, period / 100.0, rule});
    mass.begin(0.0, start_rate);
    const double energy = mass.energy();
    double largest = 0.0;
    for (int i = 0; i < 10000; ++i) {
      mass.step();
      largest = std::max(largest, std::abs(mass.energy() - energy));
    }
    return largest / energy;
  };
  EXPECT_LT(drift(ContactForceRule::energy), 1e-9);
  EXPECT_GT(drift(ContactForceRule::endpoint), 1e-4);
}

constexpr double blow_off_rate = 0.2, blow_off_force = 2e3, c1 = blow_off_force / blow_off_rate, c2 = 1e3;
NonlinearUnit blow_off() {
  NonlinearUnit unit;
  unit.damper = ForceCurve({{blow_off_rate, blow_off_force}, {1.0, blow_off_force + 0.8 * c2}});
  return unit;
}

int blow_off_regime(double rate) { return std::abs(rate) < blow_off_rate ? 0 : rate > 0.0 ? 1 : 2; }

double blow_off_error(double time_step, double alpha, ContactForceRule rule) {
  Oscillator mass(mass_on(blow_off()), {alpha, time_step, rule});
  mass.begin(0.05, 0.0);
  constexpr double rest = blow_off_force - c2 * blow_off_rate;
  PiecewiseLinearMotion exact(
      {oscillator(0.0, c1, 0.0), oscillator(0.0, c2, rest), oscillator(0.0, c2, -rest)},
      [](const Eigen::VectorXd& y) { return blow_off_regime(y[1]); }, Eigen::Vector2d(0.05, 0.0), time_step);
  return largest_error(mass, exact, time_step, 3.0);
}

TEST(BlowOffDamper, MeetsTheClosedFormWithSecondOrder) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    for (const double alpha : {0.0, -0.05}) {
      const double coarse = blow_off_error(period / 500.0, alpha, rule);
      const double fine = blow_off_error(period / 1000.0, alpha, rule);
      EXPECT_LT(fine, 1e-3);
      EXPECT_GT(coarse / fine, 3.3) << alpha;
      EXPECT_LT(coarse / fine, 4.7) << alpha;
    }
  }
}

TEST(BlowOffDamper, DissipatesWhatTheMassLoses) {
  Oscillator mass(mass_on(blow_off()), {0.0, period / 1000.0, ContactForceRule::energy});
  mass.begin(0.05, 0.0);
  const double energy = mass.energy();
  for (int i = 0; i < 3000; ++i) {
    mass.step();
    ASSERT_NEAR(mass.energy() + mass.dissipated(), energy, 1e-9 * energy) << i;
  }
  EXPECT_GT(mass.dissipated(), 0.9 * energy);
}

/// m v̇ = −k x − k_s s, ṡ = v − d⁻¹(k_s s)
TEST(BlowOffDamper, InSeriesMeetsTheClosedFormWithSecondOrder) {
  constexpr double series = 8e5;
  const auto regime = [](double c, double rest) -> Regime {
    return {Eigen::MatrixXd{{0.0, 1.0, 0.0}, {-k / m, 0.0, -series / m}, {0.0, 1.0, -series / c}},
            Eigen::Vector3d(0.0, 0.0, rest / c)};
  };
  constexpr double rest = blow_off_force - c2 * blow_off_rate;
  const auto error = [&](double time_step, double alpha, ContactForceRule rule) {
    Oscillator mass(mass_on(blow_off(), c1, series), {alpha, time_step, rule});
    mass.begin(0.05, 0.0);
    PiecewiseLinearMotion exact(
        {regime(c1, 0.0), regime(c2, rest), regime(c2, -rest)},
        [series](const Eigen::VectorXd& y) {
          const double force = series * y[2];
          return std::abs(force) < blow_off_force ? 0 : force > 0.0 ? 1 : 2;
        },
        Eigen::Vector3d(0.05, 0.0, 0.0), time_step);
    return largest_error(mass, exact, time_step, 3.0);
  };
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    for (const double alpha : {0.0, -0.05}) {
      const double coarse = error(period / 500.0, alpha, rule), fine = error(period / 1000.0, alpha, rule);
      EXPECT_LT(fine, 1e-3);
      EXPECT_GT(coarse / fine, 3.3) << alpha;
      EXPECT_LT(coarse / fine, 4.7) << alpha;
    }
  }
}

NonlinearUnit sliding(double force, double slides_after) {
  NonlinearUnit unit;
  unit.friction = {force, 0.0, slides_after};
  return unit;
}

/// m v̇ = −k x − f, ḟ = k_f v while it sticks.
double friction_error(double time_step, double alpha, ContactForceRule rule) {
  constexpr double force = 2e3, slides_after = 4e-3, stiffness = force / slides_after;
  Oscillator mass(mass_on(sliding(force, slides_after)), {alpha, time_step, rule});
  mass.begin(0.05, 0.0);
  const auto regime = [](double rate) -> Regime {
    return {Eigen::MatrixXd{{0.0, 1.0, 0.0}, {-k / m, 0.0, -1.0 / m}, {0.0, rate, 0.0}}, Eigen::Vector3d::Zero()};
  };
  PiecewiseLinearMotion exact(
      {regime(stiffness), regime(0.0)},
      [](const Eigen::VectorXd& y) {
        constexpr double rounding = 1e-9;
        const bool slides = std::abs(y[2]) >= force * (1.0 - rounding) && y[2] * y[1] > 0.0;
        return slides ? 1 : 0;
      },
      Eigen::Vector3d(0.05, 0.0, 0.0), time_step);
  return largest_error(mass, exact, time_step, 4.0);
}

TEST(DryFriction, MeetsTheClosedFormWithSecondOrder) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    for (const double alpha : {0.0, -0.05}) {
      const double coarse = friction_error(period / 500.0, alpha, rule);
      const double fine = friction_error(period / 1000.0, alpha, rule);
      EXPECT_LT(fine, 1e-3);
      EXPECT_GT(coarse / fine, 3.0) << alpha;
      EXPECT_LT(coarse / fine, 5.0) << alpha;
    }
  }
}

/// Forced vibration with Coulomb friction F and a force P cos Ωt, which does not stop within a cycle [DenHartog1931]:
/// The travel before sliding, s, delays the friction by √(s/x̂): here it is shorter than a step.
///     x̂ = (P/k) √(V² − (F/P)² H²),  V = 1/(1 − β²),  H = sin(π/β)/(β (1 + cos(π/β))),  β = Ω/ω.
TEST(DryFriction, MeetsDenHartogsForcedVibration) {
  constexpr double P = 4e3, F = 0.3 * P;
  for (const double beta : {0.7, 1.3}) {
    const double V = 1.0 / (1.0 - beta * beta);
    const double H = std::sin(std::numbers::pi / beta) / (beta * (1.0 + std::cos(std::numbers::pi / beta)));
    const double amplitude = P / k * std::sqrt(V * V - F * F / (P * P) * H * H);
    constexpr int per_cycle = 1000, cycles = 60;
    const double cycle = period / beta, time_step = cycle / per_cycle;
    Oscillator mass(mass_on(sliding(F, 1e-6 * amplitude)), {0.0, time_step, ContactForceRule::energy});
    const auto force = [&](int i) { return P * std::cos(2.0 * std::numbers::pi * i / per_cycle); };
    mass.begin(0.0, 0.0, force(0));
    double largest = 0.0;
    for (int i = 0; i < per_cycle * cycles; ++i) {
      mass.step(force(i), force(i + 1));
      if (i >= per_cycle * (cycles - 1)) largest = std::max(largest, std::abs(mass.z()));
    }
    EXPECT_NEAR(largest, amplitude, 1e-3 * amplitude) << beta;
  }
}

TEST(DryFriction, DissipatesWhatTheMassLoses) {
  for (const double slides_after : {4e-3, 1e-5}) {
    Oscillator mass(mass_on(sliding(2e3, slides_after)), {0.0, period / 200.0, ContactForceRule::energy});
    mass.begin(0.05, 0.0);
    const double energy = mass.energy();
    for (int i = 0; i < 2000; ++i) {
      mass.step();
      ASSERT_NEAR(mass.energy() + mass.dissipated(), energy, 1e-9 * energy) << i;
    }
    // it stops where the spring is weaker than the friction
    EXPECT_LT(std::abs(mass.z()), 2e3 / k + slides_after);
  }
}

/// Turning points of a mass, z of each.
std::vector<double> turning_points(Oscillator& mass, int steps) {
  std::vector<double> turns;
  for (int i = 0; i < steps; ++i) {
    const double rate = mass.rate(), z = mass.z();
    mass.step();
    if (rate * mass.rate() < 0.0) turns.push_back(std::abs(mass.z()) > std::abs(z) ? mass.z() : z);
  }
  return turns;
}

NonlinearUnit wedge(double ratio) {
  NonlinearUnit unit;
  unit.friction = {0.0, ratio, 1e-5};
  return unit;
}

/// A wedge pressed by its spring alone, without weight: it resists by r k z under compression, z > 0, the spring's
/// stiffness being k (1 + r) on the way in and k (1 − r) on the way out, and by nothing else. Every return decays by
/// √((1 − r)/(1 + r)).
TEST(Wedge, DecaysGeometricallyWithoutWeight) {
  constexpr double r = 0.3;
  Oscillator mass(
      [] {
        VehicleModel vehicle = mass_on(wedge(r), 0.0, 0.0, 0.0);
        EXPECT_EQ(vehicle.elements.element[0].load, 0.0);
        EXPECT_EQ(vehicle.elements.element[0].load_stiffness, k);
        vehicle.elements.element[0].stiffness = 1e4 * k;
        return vehicle;
      }(),
      {0.0, period / 1000.0, ContactForceRule::energy});
  mass.begin(0.05, 0.0);
  std::vector<double> compressed;
  for (const double turn : turning_points(mass, 6000)) {
    if (turn > 0.0) compressed.push_back(turn);
  }
  ASSERT_GE(compressed.size(), 4U);
  double expected = 0.05;
  for (std::size_t i = 0; i < 4; ++i) {
    expected *= std::sqrt((1.0 - r) / (1.0 + r));
    EXPECT_NEAR(compressed[i], expected, 1e-3 * expected) << i;
  }
}

/// Under a weight W the spring's load P turns at P₂ = 2W/(1 + r) − P₁ when compressed and at P₃ = 2W/(1 − r) − P₂ when
/// released: every cycle the amplitude falls by 4 r W/(1 − r²) of load.
TEST(Wedge, DecaysUnderAWeight) {
  constexpr double r = 0.08, weight = m * standard_gravity;
  VehicleModel vehicle = mass_on(wedge(r));
  EXPECT_NEAR(vehicle.elements.element[0].load, weight, 1e-9 * weight);
  vehicle.elements.element[0].stiffness = 1e4 * k;
  Oscillator mass(vehicle, {0.0, period / 1000.0, ContactForceRule::energy});
  const double released = 0.3 * weight;  // of the load, at the start
  mass.begin((released - weight) / k, 0.0);
  const std::vector<double> turns = turning_points(mass, 2500);
  ASSERT_GE(turns.size(), 3U);
  double load = released;
  for (std::size_t i = 0; i < 3; ++i) {
    load = 2.0 * weight / (i % 2 == 0 ? 1.0 + r : 1.0 - r) - load;
    EXPECT_NEAR(weight + k * turns[i], load, 1e-3 * weight) << i;
  }
}

/// m v̇ = −k z − f, ḟ = k_f v while it sticks, and f = ±r (W + k z) while it slides, held there against rounding.
double wedge_error(double time_step, double alpha, ContactForceRule rule) {
  constexpr double r = 0.2, weight = m * standard_gravity, slides_after = 4e-3, stiffness = r * weight / slides_after;
  NonlinearUnit unit;
  unit.friction = {0.0, r, slides_after};
  Oscillator mass(mass_on(unit), {alpha, time_step, rule});
  constexpr double released = 0.02;  // m: the wedge stays pressed
  mass.begin(released, 0.0);
  const Regime sticks{Eigen::MatrixXd{{0.0, 1.0, 0.0}, {-k / m, 0.0, -1.0 / m}, {0.0, stiffness, 0.0}},
                      Eigen::Vector3d::Zero()};
  const auto sliding_at = [](double limit) -> Regime {
    constexpr double hold = 1e3;  // 1/s
    return {Eigen::MatrixXd{{0.0, 1.0, 0.0}, {-k / m, 0.0, -1.0 / m}, {hold * limit * k, limit * k, -hold}},
            Eigen::Vector3d(0.0, 0.0, hold * limit * weight)};
  };
  PiecewiseLinearMotion exact(
      {sticks, sliding_at(r), sliding_at(-r)},
      [](const Eigen::VectorXd& y) {
        constexpr double rounding = 1e-9;
        const double limit = r * (weight + k * y[0]);
        const bool slides = std::abs(y[2]) >= limit * (1.0 - rounding) && y[2] * y[1] > 0.0;
        return slides ? (y[2] > 0.0 ? 1 : 2) : 0;
      },
      Eigen::Vector3d(released, 0.0, 0.0), time_step);
  return largest_error(mass, exact, time_step, 4.0);
}

TEST(Wedge, MeetsTheClosedFormWithSecondOrder) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    for (const double alpha : {0.0, -0.05}) {
      const double coarse = wedge_error(period / 500.0, alpha, rule), fine = wedge_error(period / 1000.0, alpha, rule);
      EXPECT_LT(fine, 1e-3);
      EXPECT_GT(coarse / fine, 3.0) << alpha;
      EXPECT_LT(coarse / fine, 5.0) << alpha;
    }
  }
}

TEST(Wedge, NeedsALoad) {
  EXPECT_NO_THROW((void)mass_on(wedge(0.1)));
  NonlinearUnit with_force = wedge(0.1);
  with_force.friction.force = 100.0;
  EXPECT_NEAR(mass_on(with_force).elements.element[0].stiffness, (100.0 + 0.1 * m * standard_gravity) / 1e-5, 1.0);
}

TEST(Wedge, DissipatesWhatTheMassLoses) {
  Oscillator mass(mass_on(wedge(0.2)), {0.0, period / 200.0, ContactForceRule::energy});
  mass.begin(0.04, 0.0);  // farther than the spring is compressed by the weight: the load goes through zero
  const double energy = mass.energy();
  for (int i = 0; i < 2000; ++i) {
    mass.step();
    ASSERT_NEAR(mass.energy() + mass.dissipated(), energy, 1e-9 * energy) << i;
  }
  EXPECT_GT(mass.dissipated(), 0.5 * energy);
}

/// All kinds in one unit and a unit that stands upside down: elements share the rows of their elongations, and a load
/// is a compression either way.
TEST(ForceElements, ShareRowsAndKnowTheirLoads) {
  NonlinearUnit unit = wedge(0.1);
  unit.stop = bump_stop().stop;
  const VehicleModel vehicle = mass_on(unit);
  EXPECT_EQ(vehicle.elements.element.size(), 2U);
  EXPECT_EQ(vehicle.elements.elongations(), 1);
  EXPECT_EQ(vehicle.elements.element[0].name, "suspension along z, wheelset-1 to car-body");
  EXPECT_EQ(mass_on(blow_off(), c1, 8e5).elements.rows, (Eigen::MatrixXd{{1.0, -1.0}}));
  EXPECT_EQ(mass_on(blow_off(), c1, 8e5).damping.norm(), 0.0);
}

}  // namespace
}  // namespace railtab
