#pragma once

#include <Eigen/Core>

namespace railtab {

/// Element of a straight bar along x that twists and warps, E I_ω φ'''' − GJ φ'' = m under a moment m per length
/// [Vlasov1961]. Its two nodes have the twist φ and its rate φ' = dφ/dx. Shapes are the exact ones of a bar that is
/// loaded at its nodes: constants, x, cosh(x/λ) and sinh(x/λ), with λ = √(E I_ω/GJ).
struct TorsionElement {
  double GJ = 0.0;              ///< torsional stiffness, > 0 [N m²]
  double warping_length = 0.0;  ///< λ, > 0 [m]
  double length = 0.0;          ///< > 0 [m]
};

/// Shapes of (φ_1, φ_1', φ_2, φ_2') at one place.
struct TorsionShape {
  Eigen::Vector4d twist;  ///< [-, m, -, m]
  Eigen::Vector4d rate;   ///< derivatives along x [1/m, -, 1/m, -]
};
/// @param s from the first node [m] @pre 0 <= s <= length
[[nodiscard]] TorsionShape torsion_shape(const TorsionElement& element, double s) noexcept;

/// Stiffness by (φ_1, φ_1', φ_2, φ_2').
[[nodiscard]] Eigen::Matrix4d torsion_stiffness(const TorsionElement& element) noexcept;
/// Consistent mass by the same. @param rotary_inertia about x, per length [kg m²/m]
[[nodiscard]] Eigen::Matrix4d torsion_mass(const TorsionElement& element, double rotary_inertia) noexcept;

/// Twist at x under a unit moment at `loaded`, both from the first node, of the element whose nodes neither twist nor
/// warp [rad/(N m)]. @pre both within 0..length
[[nodiscard]] double torsion_compliance(const TorsionElement& element, double x, double loaded) noexcept;

/// Shapes and compliance at one place, which share their exponential functions.
struct TorsionPlace {
  TorsionShape shape;  ///< torsion_shape(element, s)
  double compliance;   ///< torsion_compliance(element, s, s)
  double slope;        ///< derivative of the compliance along s [rad/(N m²)]
};
/// @pre 0 <= s <= length
[[nodiscard]] TorsionPlace torsion_place(const TorsionElement& element, double s) noexcept;

}  // namespace railtab
