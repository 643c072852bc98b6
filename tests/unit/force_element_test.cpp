// Bump stops, dampers with blow-off and dry friction: their forces, and one-mass oscillators in steps of a run against
// closed forms.
#include "railtab/runtime/vehicle/force_element.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "piecewise_linear_motion.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {
namespace {

using testing::PiecewiseLinearMotion;
using testing::Regime;

TEST(ForceCurve, IsOddAndGoesOnWithItsLastSlope) {
  const ForceCurve stop({{0.02, 0.0}, {0.03, 1000.0}, {0.04, 5000.0}});
  EXPECT_EQ(stop.free_travel(), 0.02);
  EXPECT_EQ(stop.at(0.015).force, 0.0);
  EXPECT_NEAR(stop.at(0.025).force, 500.0, 1e-9);
  EXPECT_NEAR(stop.at(-0.05).force, -9000.0, 1e-9);
  EXPECT_NEAR(stop.at(-0.05).slope, 4e5, 1e-6);
  const double area = 0.5 * 0.01 * 1000.0 + 0.5 * 0.01 * 6000.0 + 0.5 * 0.01 * 14000.0;
  EXPECT_NEAR(stop.integral(0.05), area, 1e-12 * area);
  EXPECT_EQ(stop.integral(-0.05), stop.integral(0.05));
}

TEST(ForceCurve, MeanIsTheDiscreteGradientOfItsIntegral) {
  const ForceCurve curve({{0.1, 2500.0}, {0.3, 3585.0}});
  const double places[] = {-0.5, -0.3, -0.2, -0.05, 0.0, 0.07, 0.1, 0.15, 0.31, 2.0};
  for (const double x0 : places) {
    for (const double x1 : places) {
      const ForceCurve::Value mean = curve.mean(x0, x1);
      EXPECT_NEAR(mean.force * (x1 - x0), curve.integral(x1) - curve.integral(x0), 1e-9) << x0 << " " << x1;
      if (std::abs(x1) == 0.1 || std::abs(x1) == 0.3) continue;  // a kink
      constexpr double h = 1e-7;
      const double slope = (curve.mean(x0, x1 + h).force - curve.mean(x0, x1 - h).force) / (2.0 * h);
      EXPECT_NEAR(mean.slope, slope, 1e-3 * std::abs(slope)) << x0 << " " << x1;
    }
  }
}

/// The path in many small parts, each of which sticks or slides as a whole.
double mean_by_parts(double force, double stretch, double limit0, double limit1) {
  constexpr int parts = 200000;
  double sum = 0.0;
  for (int i = 1; i <= parts; ++i) {
    const double limit = limit0 + (limit1 - limit0) * i / parts;
    const double next = std::clamp(force + stretch / parts, -limit, limit);
    sum += 0.5 * (force + next);
    force = next;
  }
  return sum / parts;
}

struct Path {
  double force, stretch, limit0, limit1;
};
constexpr Path paths[] = {{0.0, 50.0, 100.0, 100.0},    {30.0, 500.0, 100.0, 120.0}, {-60.0, 400.0, 100.0, 80.0},
                          {90.0, -300.0, 100.0, 140.0}, {80.0, -10.0, 100.0, 30.0},  {100.0, 1e5, 100.0, 100.0},
                          {-50.0, 20.0, 60.0, 0.0},     {0.0, 40.0, 0.0, 25.0}};

TEST(Friction, SticksAndSlidesAlongItsPath) {
  for (const Path& p : paths) {
    const FrictionStep step = slide(p.force, p.stretch, p.limit0, p.limit1);
    EXPECT_NEAR(step.mean, mean_by_parts(p.force, p.stretch, p.limit0, p.limit1), 2e-2) << p.force << " " << p.stretch;
    EXPECT_LE(std::abs(step.end), p.limit1);
    // what is not stored is dissipated: never less than nothing
    const double dissipated = step.mean * p.stretch - 0.5 * (step.end * step.end - p.force * p.force);
    EXPECT_GE(dissipated, -1e-9) << p.force << " " << p.stretch;
  }
}

TEST(Friction, HasItsDerivatives) {
  constexpr double h = 1e-5;
  for (const Path& p : paths) {
    if (p.limit1 == 0.0) continue;
    const FrictionStep step = slide(p.force, p.stretch, p.limit0, p.limit1);
    const FrictionStep more = slide(p.force, p.stretch + h, p.limit0, p.limit1);
    const FrictionStep less = slide(p.force, p.stretch - h, p.limit0, p.limit1);
    EXPECT_NEAR(step.mean_by_stretch, (more.mean - less.mean) / (2.0 * h), 1e-5);
    EXPECT_NEAR(step.end_by_stretch, (more.end - less.end) / (2.0 * h), 1e-5);
    const FrictionStep wider = slide(p.force, p.stretch, p.limit0, p.limit1 + h);
    const FrictionStep tighter = slide(p.force, p.stretch, p.limit0, p.limit1 - h);
    EXPECT_NEAR(step.mean_by_limit, (wider.mean - tighter.mean) / (2.0 * h), 1e-5);
    EXPECT_NEAR(step.end_by_limit, (wider.end - tighter.end) / (2.0 * h), 1e-5);
  }
}

constexpr double m = 1000.0, k = 4e5;
const double omega = std::sqrt(k / m), period = 2.0 * std::numbers::pi / omega;

/// A mass above a wheelset that is held, on one suspension unit.
VehicleModel mass_on(const NonlinearUnit& vertical, double damping = 0.0, double series = 0.0,
                     double gravity = standard_gravity) {
  VehicleDescription parts;
  parts.name = "mass";
  parts.weight.gravity = gravity;
  parts.bodies = {{"car-body", m, {100.0, 100.0, 100.0}, {0.0, 0.0, -1.0}},
                  {"wheelset-1", 100.0, {10.0, 10.0, 10.0}, {0.0, 0.0, -0.46}}};
  Suspension unit{1, 0, {0.0, 0.0, -0.46}, {0.0, 0.0, k}, {0.0, 0.0, damping}};
  unit.series_stiffness = {0.0, 0.0, series};
  unit.nonlinear[2] = vertical;
  parts.suspension = {unit};
  parts.wheelsets = {1};
  parts.held_dofs.assign(2, DofIndices{held, held, held, held, held, held});
  parts.held_dofs[0][2] = 0;
  return assemble_vehicle(parts);
}

/// The mass in steps, as the contacts' Newton makes them with a vehicle on held wheelsets. z down, from rest.
class Oscillator {
 public:
  Oscillator(VehicleModel vehicle, const HhtScheme& hht)
      : vehicle_(std::move(vehicle)),
        hht_(hht),
        response_(vehicle_, vehicle_.damping, hht),
        compliance_(vehicle_, response_.inverse(), hht.load_weight()),
        elements_(vehicle_),
        motion_(vehicle_.dofs()),
        friction_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(vehicle_.elements.element.size()))),
        load_(Eigen::VectorXd::Zero(vehicle_.dofs())) {}

  /// Begins at a place with a velocity, all springs at the elongations that belong to it; no friction.
  void begin(double z, double rate, double force = 0.0) {
    motion_.displacement[0] = z;
    motion_.velocity[0] = rate;
    const ForceElements& e = vehicle_.elements;
    motion_.contact_load =
        -e.rows.transpose() * e.force(e.rows * motion_.displacement, e.rows * motion_.velocity, friction_);
    motion_.step_load = motion_.contact_load;
    motion_.acceleration[0] = (force + motion_.contact_load[0] - k * z) / m;
  }

  /// @param force on the mass at the begin and at the end [N]
  void step(double before = 0.0, double after = 0.0) {
    const bool energy = hht_.contact_force == ContactForceRule::energy;
    predict(hht_, motion_, prediction_);
    load_.setZero();
    load_[0] = hht_.load_weight() * after - hht_.alpha * before;
    const Eigen::VectorXd increment =
        response_.free_increment(vehicle_, vehicle_.damping, hht_, load_, motion_, prediction_);
    elements_.begin({energy ? ElementRule::energy : ElementRule::endpoint, hht_.time_step, hht_.velocity_rate(),
                     energy ? 1.0 / (hht_.gamma() * hht_.load_weight()) : 1.0},
                    motion_, friction_, prediction_,
                    prediction_.displacement + motion_.acceleration / hht_.acceleration_rate());
    const Eigen::MatrixXd& rows = vehicle_.elements.rows;
    const Eigen::VectorXd free = prediction_.displacement + increment;
    ASSERT_TRUE(elements_.solve(compliance_, rows * free));
    const Eigen::VectorXd force = -rows.transpose() * elements_.share();
    const Eigen::VectorXd moved = increment + hht_.load_weight() * (response_.inverse() * force);
    EXPECT_NEAR((rows * (prediction_.displacement + moved) - elements_.elongation()).norm(), 0.0, 1e-12);
    account(moved);
    close_load(hht_, force, motion_.contact_load, motion_.step_load);
    motion_.contact_load = -rows.transpose() * elements_.end_force();
    friction_ = elements_.friction();
    update(hht_, prediction_, moved, motion_);
  }

  [[nodiscard]] double z() const { return motion_.displacement[0]; }
  [[nodiscard]] double rate() const { return motion_.velocity[0]; }
  /// What springs, stops, sticking friction and mass hold, and what has been dissipated [J].
  [[nodiscard]] double energy() const {
    double sum = 0.5 * m * rate() * rate() +
                 0.5 * motion_.displacement.dot(vehicle_.stiffness * motion_.displacement);
    const Eigen::VectorXd x = vehicle_.elements.rows * motion_.displacement;
    for (std::size_t i = 0; i < vehicle_.elements.element.size(); ++i) {
      const ForceElement& e = vehicle_.elements.element[i];
      const double f = friction_[static_cast<Eigen::Index>(i)];
      if (e.kind == ForceElementKind::stop) sum += e.curve.integral(x[e.row]);
      if (e.kind == ForceElementKind::friction) sum += 0.5 * f * f / e.stiffness;
    }
    return sum;
  }
  [[nodiscard]] double dissipated() const { return dissipated_; }
  [[nodiscard]] VehicleModel& vehicle() { return vehicle_; }

 private:
  void account(const Eigen::VectorXd& moved) {
    const Eigen::VectorXd before = vehicle_.elements.rows * motion_.displacement;
    const Eigen::VectorXd after = vehicle_.elements.rows * (prediction_.displacement + moved);
    for (std::size_t i = 0; i < vehicle_.elements.element.size(); ++i) {
      const ForceElement& e = vehicle_.elements.element[i];
      const double way = after[e.row] - before[e.row], f = friction_[static_cast<Eigen::Index>(i)];
      if (e.kind == ForceElementKind::damper) dissipated_ += e.curve.at(way / hht_.time_step).force * way;
      if (e.kind != ForceElementKind::friction) continue;
      const FrictionStep path = slide(f, e.stiffness * way, e.limit(before).force, e.limit(after).force);
      const double lost = path.mean * way - 0.5 * (path.end * path.end - f * f) / e.stiffness;
      EXPECT_GE(lost, -1e-9);
      dissipated_ += lost;
    }
  }

  VehicleModel vehicle_;
  HhtScheme hht_;
  VehicleResponse response_;
  ElementCompliance compliance_;
  ElementForces elements_;
  LinearMotion motion_;
  Eigen::VectorXd friction_, load_;
  Prediction prediction_;
  double dissipated_ = 0.0;
};

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
  PiecewiseLinearMotion exact({oscillator(0.0, c1, 0.0), oscillator(0.0, c2, rest), oscillator(0.0, c2, -rest)},
                              [](const Eigen::VectorXd& y) { return blow_off_regime(y[1]); },
                              Eigen::Vector2d(0.05, 0.0), time_step);
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
    PiecewiseLinearMotion exact({regime(c1, 0.0), regime(c2, rest), regime(c2, -rest)},
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
  PiecewiseLinearMotion exact({regime(stiffness), regime(0.0)},
                              [](const Eigen::VectorXd& y) {
                                constexpr double rounding = 1e-9;
                                const bool slides = std::abs(y[2]) >= force * (1.0 - rounding) && y[2] * y[1] > 0.0;
                                return slides ? 1 : 0;
                              },
                              Eigen::Vector3d(0.05, 0.0, 0.0), time_step);
  return largest_error(mass, exact, time_step, 4.0);
}

TEST(Friction, MeetsTheClosedFormWithSecondOrder) {
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
TEST(Friction, MeetsDenHartogsForcedVibration) {
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

TEST(Friction, DissipatesWhatTheMassLoses) {
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
