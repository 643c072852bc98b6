#pragma once

#include <Eigen/Core>

namespace railtab {

/// Section of a straight beam along x; the shear centre and the centroid coincide with the axis.
struct BeamSection {
  double E = 0;               ///< Young's modulus [Pa]
  double A = 0;               ///< area [m²]
  double Iy = 0;              ///< second moment of area about y: vertical bending [m⁴]
  double Iz = 0;              ///< about z: lateral bending [m⁴]
  double GJ = 0;              ///< torsional stiffness [N m²]
  double mass = 0;            ///< per length [kg/m]
  double rotary_inertia = 0;  ///< about x, per length [kg m²/m]
};

/// Two nodes, each x, y, z, roll, pitch, yaw; the second node is `length` ahead in x.
using BeamMatrix = Eigen::Matrix<double, 12, 12>;
using BeamShape = Eigen::Matrix<double, 6, 12>;

/// Stiffness of an Euler–Bernoulli beam element, 12 × 12 [N/m, N, N m]. z points down and the axes are right-handed, so
/// yaw = dy/dx and pitch = -dz/dx. [Przemieniecki1968, Eq. 5.116 without shear]
[[nodiscard]] BeamMatrix beam_stiffness(const BeamSection& section, double length);

/// Consistent mass of the same element, 12 × 12 [kg, kg m, kg m²]; the rotary inertia of bending is left out.
/// [Przemieniecki1968, Eq. 11.25 without rotary inertia]
[[nodiscard]] BeamMatrix beam_mass(const BeamSection& section, double length);

/// Motion (x, y, z, roll, pitch, yaw) of the axis at distance `s` from the first node: cubic Hermite for bending,
/// linear for x and roll. The transpose spreads a force and moment at that point over the nodes consistently.
/// @pre 0 <= s <= length
[[nodiscard]] BeamShape beam_shape(double length, double s) noexcept;

/// Rayleigh coefficients C = mass_factor·M + stiffness_factor·K with damping ratio `ratio` at two circular frequencies.
struct RayleighDamping {
  double mass_factor = 0;       ///< [1/s]
  double stiffness_factor = 0;  ///< [s]
};
/// @pre omega_1, omega_2 > 0 [rad/s]
[[nodiscard]] RayleighDamping rayleigh_damping(double ratio, double omega_1, double omega_2) noexcept;

/// n-th circular frequency of a simply supported beam in vertical bending, (nπ/L)²·sqrt(E·Iy/m) [rad/s].
[[nodiscard]] double simply_supported_frequency(const BeamSection& section, double length, int n) noexcept;

}  // namespace railtab
