#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/vsi/hht.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"

namespace railtab {

/// What deflects rail heads between the nodes of their elements: forces g, which follow the contact forces f by
///
///     τ dg/dt + g = f.
///
/// τ stands for the inertia of a rail between its nodes, which lets it follow forces up to some kHz. All vectors have 3
/// numbers per wheel: lateral and vertical force [N], moment about x [N m].
struct ElementDeflection {
  Eigen::VectorXd force;        ///< g
  Eigen::VectorXd rate;         ///< dg/dt
  Eigen::VectorXd slope_force;  ///< that the last step's slopes belong to: g at its beginning
};

/// A step of g with the velocities of HHT: at its end
///     g = free + share·f,   dg/dt = rate·(g − g(t)) − back·dg/dt(t).
struct ElementStep {
  static constexpr double time_constant = 1e-4;  ///< τ [s]
  double rate, back, share;

  explicit ElementStep(const HhtScheme& hht) noexcept
      : rate(hht.velocity_rate()), back(rate * hht.time_step - 1.0), share(1.0 / (1.0 + time_constant * rate)) {}
  /// The part of g that no force of this step changes. Refers to `begin`.
  [[nodiscard]] auto free(const ElementDeflection& begin) const {
    return share * time_constant * (rate * begin.force + back * begin.rate);
  }
  /// @param end g at the end of the step; is replaced
  void close(Eigen::VectorXd& end, ElementDeflection& deflection) const {
    deflection.rate = rate * (end - deflection.force) - back * deflection.rate;
    deflection.slope_force.swap(deflection.force);
    deflection.force.swap(end);
  }
};

/// Motion of every rail head between the nodes of its element, those held, under forces g that travel at speed V. With
/// C = element_compliance() and C' = dC/dx: displacement C g, and of the material under the wheel the velocity
/// C dg/dt + ½ V C' g and the slopes ½ C' g; the other half of C' belongs to the load's own travel. Rail heads on one
/// element displace each other.
/// @param slope_force the g of the terms with C' @param motion per wheel
void element_motion(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force, const Eigen::VectorXd& rate,
                    const Eigen::VectorXd& slope_force, double speed, std::vector<RailHeadMotion>& motion);

/// Of a vector with 12 numbers per wheelset, the three of every rail head.
[[nodiscard]] Eigen::VectorXd rail_part(const Eigen::VectorXd& of_wheelsets);
/// Adds them, weighted, to a vector of three per wheel.
void add_rail_part(double weight, const Eigen::VectorXd& of_wheelsets, Eigen::VectorXd& sum);

inline void add_slopes(const RailHeadMotion& motion, RailHeadMotion& head) noexcept {
  head.yaw += motion.yaw;
  head.slope += motion.slope;
}

}  // namespace railtab
