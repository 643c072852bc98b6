#include "railtab/runtime/contact/kalker_asymptotes.hpp"

#include <cmath>
#include <numbers>

namespace railtab {

namespace {

using std::numbers::ln2;
using std::numbers::pi;

std::array<double, 4> wide_ellipse(double g, double nu) {
  const double c11 = pi * pi / (4.0 * (1.0 - nu));
  const double c22 = pi * pi / 4.0;
  const double c23 = pi * std::sqrt(g) / (3.0 * (1.0 - nu)) * (1.0 + nu * (std::log(16.0 / g) - 5.0));
  const double c33 = pi * pi / (16.0 * (1.0 - nu) * g);
  return {c11, c22, c23, c33};
}

std::array<double, 4> long_ellipse(double g, double nu) {
  const double L = 4.0 * ln2 - 2.0 * std::log(g);  // ln(16/g²)
  const double d11 = L - 2.0 * nu;
  const double d22 = (1.0 - nu) * L + 2.0 * nu;
  const double d33 = (1.0 - nu) * L - 2.0 + 4.0 * nu;
  const double k = 3.0 - 2.0 * ln2;
  const double c11 = 2.0 * pi / (d11 * g) * (1.0 + k / d11);
  const double c22 = 2.0 * pi / (d22 * g) * (1.0 + (1.0 - nu) * k / d22);
  const double c23 = 2.0 * pi / (3.0 * g * std::sqrt(g) * d33);
  const double c33 = pi / 4.0 * (1.0 - nu * (L - 2.0) / d33);
  return {c11, c22, c23, c33};
}

}  // namespace

std::array<double, 4> kalker_asymptotes(double ratio, double nu) noexcept {
  return ratio < 1.0 ? wide_ellipse(ratio, nu) : long_ellipse(1.0 / ratio, nu);
}

}  // namespace railtab
