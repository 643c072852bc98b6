#include "railtab/runtime/contact/hertz_ellipse.hpp"

#include <algorithm>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace railtab {

namespace {

using std::numbers::pi;

/// Complete elliptic integrals of parameter m = 1 - g²: K = R_F(0,g²,1), D = (K-E)/m = R_D(0,g²,1)/3 (DLMF 19.25.1),
/// E = K - m D, B = K - D.
struct CompleteIntegrals {
  double K, E, B, D;
  explicit CompleteIntegrals(double g2)
      : K(boost::math::ellint_rf(0.0, g2, 1.0)), D(boost::math::ellint_rd(0.0, g2, 1.0) / 3.0) {
    E = K - (1.0 - g2) * D;
    B = K - D;
  }
};

/// d ln(B/(g² D)) / d ln g, from dK/dm = B/(2g²) and dB/dm = (D - B)/(2m), which tends to π/32 for the circle.
double log_slope(const CompleteIntegrals& c, double g2) {
  const double m = 1.0 - g2;
  const double dB_dm = m > 1e-4 ? (c.D - c.B) / (2.0 * m) : pi / 32.0;
  return -2.0 * g2 * dB_dm * (1.0 / c.B + 1.0 / c.D) + c.B / c.D - 2.0;
}

/// ln g for a given ln(max/min), by Newton. The slope of ln(max/min) over ln g lies between -3/2 (circle) and -2
/// (line), which brackets the root from the start and makes the function nearly straight.
double log_axis_ratio(double log_curvature_ratio) {
  double low = -2.0 / 3.0 * log_curvature_ratio;
  double high = -0.5 * log_curvature_ratio;
  double x = low;
  for (int i = 0; i < 40; ++i) {
    const double g2 = std::exp(2.0 * x);
    const CompleteIntegrals c(g2);
    const double residual = std::log(c.B / c.D) - 2.0 * x - log_curvature_ratio;
    (residual > 0.0 ? low : high) = x;
    const double step = residual / log_slope(c, g2);
    const double next = x - step;
    // A bracket that has closed onto the root may exclude it by a rounding error, so only real steps are checked.
    const bool inside = next >= low && next <= high;
    x = inside || std::abs(step) < 1e-13 ? next : 0.5 * (low + high);
    if (std::abs(step) <= 2.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(x))) break;
  }
  return std::min(x, 0.0);
}

}  // namespace

HertzEllipse hertz_ellipse(double curvature_ratio) {
  assert(curvature_ratio > 0.0 && curvature_ratio <= 1.0);
  const double g = std::exp(log_axis_ratio(-std::log(curvature_ratio)));
  const CompleteIntegrals c(g * g);
  const double major = std::cbrt(3.0 * c.E / (2.0 * pi * g * g));
  return {2.0 * pi / 3.0 * std::sqrt(c.E / c.K) / (c.K * g), major, major * g, g};
}

}  // namespace railtab
