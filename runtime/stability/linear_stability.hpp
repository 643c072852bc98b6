#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// A vehicle that runs at constant speed about rest in the middle of straight rigid rails: mass, and damping and
/// stiffness with the contacts,
///     M ü + (C + V/R0 G − ∂f/∂u̇) u̇ + (K − ∂f/∂u) u,
/// with the contact forces f of the wheels by central differences of the force that runs have: normal contact, creep
/// with spin, contact angles. The matrices are not symmetric.
/// @param model of one vehicle or one train with joints, its force elements by linear stand-ins; structure, deviations
///        and loads play no part
/// @param conicity in place of what the contact says of the yaw moment by lateral shift, −2 f₁₁ b γ_e y/R0: the
///        equivalent conicity of a finite amplitude
/// @pre model.normal_contact is hertz
/// @throws ComputationError where the train does not come to rest
[[nodiscard]] VehicleModel running_vehicle(const VsiModel& model, double speed, std::optional<double> conicity = {});

/// The least stable lateral motion of a train on straight rigid rails: more than half of its kinetic energy is in y,
/// roll and yaw.
struct LeastStableMotion {
  double speed = 0.0;      ///< V [m/s]
  double growth = 0.0;     ///< Re λ [1/s], positive where the motion grows
  double frequency = 0.0;  ///< |Im λ|/2π [Hz]; 0: no oscillation
  /// −Re λ/|λ|: damping ratio, negative where the motion grows.
  double damping = 0.0;

  /// By more than the rounding of eigenvalues: motions that no damper meets have Re λ = 0.
  [[nodiscard]] bool grows() const noexcept { return damping < -1e-6; }
};

/// By the eigenvalues λ of running_vehicle(), without the rotations of wheelsets, which nothing resists.
/// @param motion 1 for the least stable, 2 for the next
/// @pre, @throws as running_vehicle()
[[nodiscard]] LeastStableMotion least_stable_motion(const VsiModel& model, double speed,
                                                    std::optional<double> conicity = {}, int motion = 1);

/// least_stable_motion() if it grows. Shapes, which tell lateral motions from others, are computed only where some
/// motion grows. @pre, @throws as running_vehicle()
[[nodiscard]] std::optional<LeastStableMotion> growing_motion(const VsiModel& model, double speed,
                                                              std::optional<double> conicity = {});

/// An eigenvalue λ [1/s] of running_vehicle() and its shape.
struct LinearShape {
  std::complex<double> value;
  Eigen::VectorXcd displacement;  ///< dofs; 0 in rows without mass
};
/// The lateral motions in the order of their growth, the least stable first, of each pair of eigenvalues one.
/// @pre, @throws as running_vehicle()
[[nodiscard]] std::vector<LinearShape> lateral_shapes(const VsiModel& model, double speed,
                                                      std::optional<double> conicity = {});

struct SpeedSearch {
  double low = 5.0, high = 150.0, step = 2.5;  ///< [m/s]
  double tolerance = 1e-4;                     ///< of the critical speed [m/s]
  int motion = 1;  ///< how many motions shall grow there: the bogies of a vehicle may hunt in several ways
};

struct LinearCriticalSpeed {
  std::optional<LeastStableMotion> critical;  ///< at the lowest critical speed; none up to SpeedSearch::high
  std::vector<LeastStableMotion> searched;    ///< at the speeds of the search
};

/// The lowest speed from which on a small motion (SpeedSearch::motion: so many) grows, by bisection between two steps
/// of the search.
[[nodiscard]] LinearCriticalSpeed linear_critical_speed(const VsiModel& model, const SpeedSearch& search = {},
                                                        std::optional<double> conicity = {});

}  // namespace railtab
