#pragma once

// The suspended wheelset of [MontenegroCalcada2023, section 4.3] in railtab's own simulation, and what its motion says
// about stability. Assumptions d to g of Eq. 18 are switches of the library, so that each can be lifted by itself.

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::hunting {

enum class Suspension { none, primary };  ///< models A and B
enum class Roll { held, free };
enum class Spin { included, neglected };

/// Assumptions of Eq. 18; the defaults are all of them.
struct Assumptions {
  Suspension suspension = Suspension::primary;
  Roll roll = Roll::held;
  Spin spin = Spin::neglected;
  GravitationalStiffness gravitational_stiffness = GravitationalStiffness::neglected;
  GyroscopicMoments gyroscopic_moments = GyroscopicMoments::neglected;
};

constexpr double R0 = 0.4566, Lcp = 0.7175, l = 0.9;  // m [MontenegroCalcada2023, Table 2]; l is half the distance

/// Cones 1:40 that touch crowns of 300 mm radius (Table 2's ellipse is that of this pair) at ±Lcp on their tape
/// circles.
inline WheelRailPair cones_on_crowns() {
  PairDimensions dimensions;
  dimensions.flange_back = 2.0 * (Lcp - PairDimensions::tape_circle_to_flange_back);
  dimensions.nominal_radius = R0;
  const auto pair = [&] {
    return WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                         ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), dimensions);
  };
  const double y_contact = -0.3 * std::sin(std::atan(1.0 / 40.0));  // where the crown is as steep as the cone
  dimensions.track_gauge += 2.0 * (Lcp - y_contact - pair().rail_offset());
  return pair();
}

/// Table 2 of the paper; `speed` in m/s.
inline VsiModel wheelset(const Assumptions& assume, double speed) {
  constexpr double nu = 0.28, G = 82e9;
  VsiModel model;
  const std::vector<RigidBody> bodies{{"frame", 1.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}},
                                      {"wheelset", 1568.0, {656.0, 168.0, 656.0}, {0.0, 0.0, -R0}}};
  DofIndices none;
  none.fill(held);
  const DofIndices free{held, 0, 0, assume.roll == Roll::held ? held : 0, held, 0};
  std::vector<railtab::Suspension> suspension;
  if (assume.suspension == Suspension::primary) {
    const Eigen::Vector3d k(135e3, 250e3, 0.0);  // N/m
    for (double y : {-l, l}) suspension.push_back({0, 1, {0.0, y, -R0}, k, Eigen::Vector3d::Zero()});
  }
  model.vehicle = assemble_vehicle({"suspended wheelset", bodies, suspension, {1}, {none, free}, R0, 10.0});
  model.vehicle_x = {0.0};
  model.gyroscopic_moments = assume.gyroscopic_moments;

  model.geometry = std::make_shared<const ContactGeometry>(ContactSearch(cones_on_crowns()));
  model.contact.geometry = model.geometry.get();
  model.contact.speed = speed;
  model.contact.normal.material = {.E = 2.0 * (1.0 + nu) * G, .nu = nu};
  model.contact.gravitational_stiffness = assume.gravitational_stiffness;
  const PatchEllipse ellipse{5.667e-3, 4.284e-3};
  model.contact.constant_ellipse = ellipse;
  KalkerCoefficients c = kalker_coefficients(ellipse.a / ellipse.b, nu);
  if (assume.spin == Spin::neglected) c.c23 = c.c33 = 0.0;
  c.c11 = 4.523;
  c.c22 = 4.121;
  model.contact.creep_law = LinearCreep{.nu = nu, .coefficients = c};
  return model;
}

/// Lateral shift [m] and yaw [rad] of the wheelset over time [s].
struct Motion {
  std::vector<double> t, y, yaw;
};

/// Goes on from `state` to time `end`, adding to `motion` every `record_every` steps.
inline void run(const VsiModel& model, double time_step, double end, int record_every, VsiState& state,
                Motion& motion) {
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    motion.t.push_back(record.time);
    motion.y.push_back(record.bodies.at(1).displacement[1]);
    motion.yaw.push_back(record.bodies.at(1).displacement[5]);
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  integration.tolerance = 1e-9;
  const RunSummary summary = simulate(model, integration, end, record_every, state, observer);
  if (!summary.complete) throw std::runtime_error(summary.message);
}

struct Oscillation {
  double decrement;   ///< Eq. 21, per cycle; positive where the motion decays
  double wavelength;  ///< [m]
};

/// Hunting after a lateral shift of 0.1 mm: from the peaks between the first, where the fast motions of the start have
/// died out, and the last of `cycles` later.
inline Oscillation oscillation(const VsiModel& model, int cycles) {
  const double speed = model.contact.speed;
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) throw std::runtime_error("no equilibrium");
  state.vehicle[0].displacement[model.vehicle.dof[1][1]] += 1e-4;
  Motion motion;
  constexpr double about = 23.0;  // m, the wavelength
  const double time_step = std::min(1e-3, about / speed / 300.0);
  run(model, time_step, std::round((cycles + 1.75) * about / speed / time_step) * time_step, 1, state, motion);

  std::vector<double> when, height;  // of the maxima, by the parabola through the three points around each
  for (std::size_t i = 1; i + 1 < motion.y.size(); ++i) {
    const double a = motion.y[i - 1], b = motion.y[i], c = motion.y[i + 1];
    if (motion.t[i] * speed < 0.5 * about || b <= 0.0 || b < a || b <= c) continue;
    const double p = 0.5 * (a - c) / (a - 2.0 * b + c);
    when.push_back(motion.t[i] + p * time_step);
    height.push_back(b - 0.25 * (a - c) * p);
  }
  const auto n = static_cast<std::size_t>(cycles);
  if (when.size() <= n) throw std::runtime_error("too few cycles");
  return {std::log(height[0] / height[n]) / cycles, speed * (when[n] - when[0]) / cycles};
}

/// Critical speed [km/h]: zero of the decrement, by the secant through two speeds near it, until it moves by less than
/// 1e-3 km/h.
inline double critical_speed(const Assumptions& assume, double start_kmh) {
  const auto decrement = [&](double kmh) { return oscillation(wheelset(assume, kmh / 3.6), 3).decrement; };
  double v0 = start_kmh, v1 = start_kmh + 4.0;
  double d0 = decrement(v0), d1 = decrement(v1);
  for (int i = 0; i < 8 && std::abs(v1 - v0) > 1e-3; ++i) {
    const double v2 = v1 - d1 * (v1 - v0) / (d1 - d0);
    v0 = v1;
    d0 = d1;
    v1 = v2;
    d1 = decrement(v1);
  }
  return v1;
}

}  // namespace railtab::hunting
