#pragma once

// Model C of [MontenegroCalcada2023, section 4.3]: the suspended wheelset with wheels that have flanges, and what
// happens when these meet the rails. The paper's profiles are not published: stand-ins take their place, at the half
// distance of Table 2, under the load to which the ellipse of Table 2 belongs.

#include <algorithm>
#include <array>
#include <cmath>

#include "hunting_model.hpp"
#include "runge_kutta.hpp"

namespace railtab::hunting {

/// realistic: cone, R14, flank. simplified: two chords in place of the arc, so that no convex rail meets a concave
/// wheel, but for corners rounded with R3.
enum class FlangeRoot { realistic, simplified };

constexpr double wheel_load = 50e3;           // N, of the ellipse in Table 2 for R0 and a crown of 300 mm
constexpr double flange_speed = 250.0 / 3.6;  // m/s
constexpr double flange_start_yaw = 0.8e-3;   // rad: lateral amplitude of 3 mm, as after the paper's impulse
constexpr double flange_friction = 0.3;
constexpr double crown_radius = 0.6;  // m, of the rail where the cone rolls

/// The root of the conic-arc wheel, between the last knot on the flank and the first on the cone, by two chords.
inline ProfileKnots with_chords(const ProfileKnots& wheel) {
  constexpr double flank = 70.0 * std::numbers::pi / 180.0, rounding = 3e-3, root_radius = 14e-3, same = 1e-6;
  const double cone = std::atan(1.0 / 40.0);
  const auto slope = [&](std::size_t i) { return std::atan2(-wheel.dz[i], wheel.dy[i]); };
  std::size_t begin = 0, end = 0;  // of the root
  for (std::size_t i = 0; i < wheel.s.size(); ++i) {
    if (std::abs(slope(i) - flank) < same) begin = i;
    if (end == 0 && begin > 0 && slope(i) < cone + same) end = i;
  }
  ProfileKnots result;
  result.name = wheel.name + ", chords for root";
  const auto add = [&](double y, double z, double angle) {
    result.s.push_back(result.s.empty() ? 0.0 : result.s.back() + std::hypot(y - result.y.back(), z - result.z.back()));
    result.y.push_back(y);
    result.z.push_back(z);
    result.dy.push_back(std::cos(angle));
    result.dz.push_back(-std::sin(angle));
  };
  for (std::size_t i = 0; i < begin; ++i) add(wheel.y[i], wheel.z[i], slope(i));
  // Concave corners: the centre of their arcs lies outside of the wheel.
  const auto round_corner = [&](double y, double z, double before, double after) {
    const double reach = rounding * std::tan(0.5 * (before - after));
    constexpr int parts = 8;  // of the arc
    const double y0 = y - reach * std::cos(before), z0 = z + reach * std::sin(before);
    for (int k = 0; k <= parts; ++k) {
      const double angle = before + (after - before) * k / parts;
      add(y0 + rounding * (std::sin(before) - std::sin(angle)), z0 + rounding * (std::cos(before) - std::cos(angle)),
          angle);
    }
  };
  const double middle = 0.5 * (flank + cone), quarter = 0.25 * (flank - cone);
  const double chord = 2.0 * root_radius * std::sin(quarter);  // its length
  const double y_middle = wheel.y[begin] + chord * std::cos(flank - quarter);
  const double z_middle = wheel.z[begin] - chord * std::sin(flank - quarter);
  round_corner(wheel.y[begin], wheel.z[begin], flank, flank - quarter);
  round_corner(y_middle, z_middle, middle + quarter, middle - quarter);
  round_corner(wheel.y[end], wheel.z[end], cone + quarter, cone);
  for (std::size_t i = end + 1; i < wheel.s.size(); ++i) add(wheel.y[i], wheel.z[i], slope(i));
  return result;
}

inline WheelRailPair flanged_pair(FlangeRoot root) {
  PairDimensions dimensions;
  const double shift = 2.0 * (Lcp - (0.5 * dimensions.flange_back + PairDimensions::tape_circle_to_flange_back));
  dimensions.flange_back += shift;
  dimensions.track_gauge += shift;
  dimensions.nominal_radius = R0;
  const ProfileKnots wheel = standard_profile(ProfileKind::wheel, "conic-arc-stand-in", 0.0);
  return WheelRailPair(ProfileCurve(root == FlangeRoot::realistic ? wheel : with_chords(wheel)),
                       ProfileCurve(standard_profile(ProfileKind::rail, "JIS60-stand-in", 1.0 / 40.0)), dimensions);
}

/// Model C at `speed` [m/s]: roll free and normal forces with their lateral components, since wheels would lift and
/// flanges not guide without; no spin, no gyroscopic moments; creep forces linear, saturated at Coulomb's bound.
inline VsiModel flanged_wheelset(FlangeRoot root, double speed = flange_speed) {
  VsiModel model = wheelset({.roll = Roll::free, .gravitational_stiffness = GravitationalStiffness::included}, speed);
  model.geometry = std::make_shared<const ContactGeometry>(ContactSearch(flanged_pair(root)));
  model.contact.geometry = model.geometry.get();
  model.contact.friction = flange_friction;
  std::get<LinearCreep>(model.contact.creep_law).saturated = true;
  model.vehicle.static_load[model.vehicle.dof[1][2]] = 2.0 * wheel_load;
  return model;
}

/// Eq. 18 of the same wheelset as long as no flange touches: lateral shift and yaw, saturated creep forces under
/// constant wheel loads, conicity with the roll of the wheelset (docs/validation). State: y, y', yaw, yaw'.
class EquationsOfMotion {
 public:
  explicit EquationsOfMotion(double speed) : V_(speed) {}

  using State = std::array<double, 4>;
  [[nodiscard]] State rate(const State& s) const {
    constexpr double m = 1568.0, Iz = 656.0, kx = 135e3, ky = 250e3, gamma0 = 0.025;
    constexpr double Gab = 82e9 * 5.667e-3 * 4.284e-3, fx = 4.523 * Gab, fy = 4.121 * Gab;
    const double conicity = gamma0 * (Lcp + crown_radius * gamma0) / Lcp;
    const double creep_x = Lcp * s[3] / V_ + conicity * s[0] / R0;  // of the left wheel; the right one's is opposite
    const double creep_y = s[1] / V_ - s[2];
    const double force = std::hypot(fx * creep_x, fy * creep_y) / (flange_friction * wheel_load);
    const double share = force < 3.0 ? 1.0 - force / 3.0 + force * force / 27.0 : 1.0 / force;
    return {s[1], (-2.0 * fy * share * creep_y - 2.0 * ky * s[0]) / m, s[3],
            (-2.0 * Lcp * fx * share * creep_x - 2.0 * kx * l * l * s[2]) / Iz};
  }
  void step(double dt, State& s) const {
    runge_kutta_step([this](const State& at) { return rate(at); }, dt, s);
  }

 private:
  double V_;
};

struct FlangeImpact {
  double begin = 0, end = 0;  ///< of the flange's contact [s]
  double largest_Y = 0;       ///< lateral force on the rail [N]
  double approach = 0;        ///< lateral speed of the wheelset when the flange touched [m/s]
  double created = 0;         ///< energy that the time integration of the contacts made during it [J]

  [[nodiscard]] double kinetic_energy() const { return 0.5 * 1568.0 * approach * approach; }  ///< lateral [J]
};

struct FlangeRun {
  std::vector<double> t, y, z, roll, Y_left, Y_right;
  std::vector<FlangeImpact> impacts;
  EnergyBalance energy;
};

/// The wheelset, set off with `yaw` [rad] and rolling along it, until `duration` [s].
inline FlangeRun run_flanged(const VsiModel& model, ContactForceRule rule, double time_step, double yaw,
                             double duration) {
  const DofIndices& dof = model.vehicle.dof[1];
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) throw std::runtime_error("no equilibrium");
  state.vehicle[0].displacement[dof[5]] += yaw;
  state.vehicle[0].velocity[dof[1]] = model.contact.speed * yaw;
  FlangeRun result;
  bool touched = false;
  double created_before = 0.0;
  RunObserver observer;
  observer.energy = [&](const EnergyBalance& balance) { result.energy = balance; };
  observer.record = [&](const StepRecord& record) {
    constexpr double flange_angle = 0.3;  // rad; the treads' is 0.025
    bool touches = false;
    for (const WheelRecord& wheel : record.wheels) {
      // The patch with the larger force, or the next one beside it on the gauge side.
      touches = touches || std::abs(wheel.angle) > flange_angle ||
                (wheel.second_normal_force > 0.0 && wheel.second_y_rail < wheel.y_rail - 5e-3);
    }
    result.t.push_back(record.time);
    result.y.push_back(record.bodies.at(1).displacement[1]);
    result.z.push_back(record.bodies.at(1).displacement[2]);
    result.roll.push_back(record.bodies.at(1).displacement[3]);
    result.Y_left.push_back(record.wheels[0].Y);
    result.Y_right.push_back(record.wheels[1].Y);
    if (touches && !touched) {
      result.impacts.push_back({.begin = record.time, .approach = record.bodies.at(1).velocity[1]});
      created_before = result.energy.contact_gain;
    }
    if (touches || touched) {
      FlangeImpact& impact = result.impacts.back();
      impact.end = record.time;
      impact.created = result.energy.contact_gain - created_before;
      for (const WheelRecord& wheel : record.wheels) impact.largest_Y = std::max(impact.largest_Y, std::abs(wheel.Y));
    }
    touched = touches;
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  integration.contact_force = rule;
  const RunSummary summary = simulate(model, integration, duration, 1, state, observer);
  if (!summary.complete) throw std::runtime_error(summary.message);
  return result;
}

}  // namespace railtab::hunting
