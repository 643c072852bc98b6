#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "railtab/runtime/vehicle/force_element.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab::testing {

inline constexpr double m = 1000.0, k = 4e5;                             // kg, N/m
inline const double period = 2.0 * std::numbers::pi * std::sqrt(m / k);  // s

/// A mass above a wheelset that is held, on one suspension unit.
inline VehicleModel mass_on(const NonlinearUnit& vertical, double damping = 0.0, double series = 0.0,
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
        compliance_(vehicle_, separate_systems(vehicle_).front(), response_.inverse(), hht.load_weight()),
        elements_(vehicle_, separate_systems(vehicle_).front()),
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
    response_.find_free_increment(hht_, load_, motion_, prediction_);
    const Eigen::VectorXd& increment = prediction_.increment;
    const Eigen::VectorXd guess = prediction_.displacement + motion_.acceleration / hht_.acceleration_rate();
    elements_.begin({energy ? ElementRule::energy : ElementRule::endpoint, hht_.time_step, hht_.velocity_rate(),
                     energy ? 1.0 / (hht_.gamma() * hht_.load_weight()) : 1.0},
                    {motion_, friction_, prediction_, guess});
    const Eigen::MatrixXd& rows = vehicle_.elements.rows;
    const Eigen::VectorXd free = prediction_.displacement + increment;
    ASSERT_TRUE(elements_.solve(compliance_, rows * free));
    const Eigen::VectorXd force = -rows.transpose() * elements_.share();
    const Eigen::VectorXd moved = increment + hht_.load_weight() * (response_.inverse() * force);
    EXPECT_NEAR((rows * (prediction_.displacement + moved) - elements_.elongation()).norm(), 0.0, 1e-12);
    account(moved);
    close_load(hht_, force, motion_.contact_load, motion_.step_load);
    motion_.contact_load = -rows.transpose() * elements_.end_force();
    elements_.store_friction(friction_);
    update(hht_, prediction_, moved, motion_);
  }

  [[nodiscard]] double z() const { return motion_.displacement[0]; }
  [[nodiscard]] double rate() const { return motion_.velocity[0]; }
  /// What springs, stops, sticking friction and mass hold, and what has been dissipated [J].
  [[nodiscard]] double energy() const {
    double sum = 0.5 * m * rate() * rate() + 0.5 * motion_.displacement.dot(vehicle_.stiffness * motion_.displacement);
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

}  // namespace railtab::testing
