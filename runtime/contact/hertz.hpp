#pragma once

namespace railtab {

/// Linear elastic material, the same for wheel and rail (the quasi-identical case of Kalker's theory).
struct ElasticMaterial {
  double E = 210e9;  ///< Young's modulus, 1e8..1e15 [Pa]
  double nu = 0.28;  ///< Poisson's ratio [-], 0..0.5

  [[nodiscard]] constexpr double shear_modulus() const noexcept { return E / (2.0 * (1.0 + nu)); }
  /// Contact modulus E* of two equal bodies: E / (2(1 - nu²)) [Pa].
  [[nodiscard]] constexpr double contact_modulus() const noexcept { return E / (2.0 * (1.0 - nu * nu)); }
  /// Whether a table that was made for this contact modulus [Pa] is one for this material: to 1e-6.
  [[nodiscard]] bool has_contact_modulus(double modulus) const noexcept;
  void validate() const;  ///< @throws InputError naming the member out of range
};

/// Hertz contact of two bodies whose undeformed distance is A x² + B y², x in the rolling direction:
/// everything that does not depend on the load. F = stiffness·d^{3/2} (Eq. 11), semi-axes a = a1·F^{1/3}, b =
/// b1·F^{1/3}.
struct HertzContact {
  double stiffness;  ///< K_h [N/m^{3/2}]
  double a1, b1;     ///< semi-axis along (a) and across (b) the rolling direction at unit load [m/N^{1/3}]
  double ratio;      ///< a/b [-]
};

/// Exact: complete elliptic integrals, ellipse ratio by Newton to rounding. A, B > 0 [1/m].
[[nodiscard]] HertzContact hertz_contact_exact(double A, double B, const ElasticMaterial& material);

/// The same from a one-dimensional table of the ellipse over A/B, for the hot path: relative error below 1e-9 for A/B
/// in 1e-6..1e6 (outside, the exact route). Allocation-free, thread-safe.
[[nodiscard]] HertzContact hertz_contact(double A, double B, const ElasticMaterial& material) noexcept;

}  // namespace railtab
