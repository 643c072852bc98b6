#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/tablegen/loaded_contact.hpp"
#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {

/// How a wheel rolls over a loaded contact.
struct LoadedRollingOptions {
  double friction = 0.3;           ///< μ, 1e-6..2
  double speed = 1.0;              ///< V, what creepages are divided by, 1e-6..1000 [m/s]
  RollingContactOptions solution;  ///< elements and their size are those of the normal contact
  /// Rigid slip of the true kinematics, or that of a plane contact with one set of creepages for all bands, those at
  /// the centre of pressure: w = (υx − φ s, υy + φ x), as programs with a planar contact reference take it.
  enum class SlipField { curved, planar } slip = SlipField::curved;

  /// @throws InputError
  void validate() const;
};

/// Friction of one band.
struct BandFriction {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the wheel, track axes [N]
  double x = 0.0, y = 0.0;                          ///< on the wheel, along x and the rail's local lateral tangents [N]
  double moment = 0.0;                              ///< on the wheel, about the normal at the centre of pressure [N m]
  PatchCreepage creepage;                           ///< wheel against rail at the centre of pressure
};

/// Steady rolling with friction on the true contact area.
struct LoadedRolling {
  RailWrench on_rail;               ///< by friction alone; the force on the wheel is its opposite
  std::vector<BandFriction> bands;  ///< those of the normal contact
  /// On the wheel, of the elements [Pa]: along x, and along the rail's lateral tangents. As LoadedContact::pressure.
  Eigen::VectorXd traction_x, traction_y;
  RollingContactSolution solution;  ///< what proves it; forces and tractions in units of G over the pressed rectangle
};

/// Tangential tractions of a converged normal contact: Kalker's exact theory of steady rolling on the elements with
/// pressure, with the bound μp and the rigid slip of the true kinematics at each row of elements:
///
///   w_x = (v + ω × arm)·x/V,   w_y = (v + ω × arm)·t/V + (ω·n/V)(x − x_c),
///
/// arm from the wheelset centre to the wheel's deepest point at x_c on that line of the rail, undeformed; t, n the
/// rail's local tangent and normal. Bands feel each other through the half-space of the developed surface.
/// Wheel and rail as quasi-identical: 1/G = ½(1/G_w + 1/G_r), ν/G = ½(ν_w/G_w + ν_r/G_r).
/// @param motion of the wheelset against the rail, its rotation about the axle included, track axes @throws InputError
[[nodiscard]] LoadedRolling loaded_rolling(const WheelRailPair& pair, const LoadedContact& contact,
                                           const LoadedContactOptions& material, const RelativeMotion& motion,
                                           const LoadedRollingOptions& options);

/// Motion of a wheelset that runs along the track at `speed` in a constant pose and turns about its axle with
/// `pitch_rate`, negative when rolling forward [rad/s].
[[nodiscard]] RelativeMotion running_motion(const WheelsetPose& pose, double speed, double pitch_rate);

}  // namespace railtab
