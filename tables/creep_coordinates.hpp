#pragma once

#include <array>

namespace railtab {

/// Factors that make the three creepages comparable at one a/b, u = (x υx, y υy, spin φ), and the size of the moment.
struct CreepScale {
  double x, y, spin, moment;
  double alpha, beta;  ///< how much α and β are spread around υx = 0 and υy = 0, see CreepPoint
};

/// Closed forms: x and y follow c11 and c22 of linear theory for a/b up to 20 (any smooth choice is right, this one
/// keeps the force nearly the same along a/b); spin is the root mean square of the slip it makes under Hertz's
/// pressure, √((x² b² + y² a²)/5), √(ab) = 1, and moment √(a² + b²)/√2.
[[nodiscard]] CreepScale creep_scale(double ratio) noexcept;

/// Bounded coordinates of a creepage, after the two exact symmetries have folded it into υx >= 0, φ >= 0:
/// t = |u|/(|u| + unit), tan α = |(u_y, u_spin)|/(q_α u_x), tan β = u_spin/(q_β u_y), with the spreads q of CreepScale.
/// t = 0 is zero creepage, t = 1 infinite creepage. α = 0 is pure longitudinal creepage, where all β are one point.
struct CreepPoint {
  double t;      ///< 0..1
  double alpha;  ///< 0..π/2 [rad]
  double beta;   ///< 0..π [rad]; π is 0 with the signs of F_y and M_z turned
};

/// Creepages (υx, υy, φ) at a point with t < 1: the inverse of what CreepTable does with a query.
[[nodiscard]] std::array<double, 3> creepage_at(const CreepPoint& point, const CreepScale& scale,
                                                double radius_unit) noexcept;

/// The axis of a/b is uniform in x/√(1 + x²), x = ln(a/b)/stretch: dense in the middle, sparse at the ends.
[[nodiscard]] double squeezed_ratio(double ratio, double stretch) noexcept;
[[nodiscard]] double ratio_at(double squeezed, double stretch) noexcept;

}  // namespace railtab
