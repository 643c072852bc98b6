#include "railtab/runtime/contact/hertz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/hertz_ellipse.hpp"
#include "railtab/tables/binade_polynomials.hpp"

namespace railtab {

namespace {

using EllipseTable = BinadePolynomials<4, 6, -21, 0>;  // 2^-21 < 1e-6

/// The ellipse over min(A,B)/max(A,B) in [2^-21, 1]; the last piece reaches to 2 and is used at exactly 1 only.
const EllipseTable& ellipse_table() {
  static const EllipseTable table([](double x) -> std::array<double, 4> {
    // Above 1 the roles of A and B change: the same curve continued, so that the piece that starts at 1 is smooth
    // there.
    const HertzEllipse e = hertz_ellipse(x <= 1.0 ? x : 1.0 / x);
    return {e.stiffness, x <= 1.0 ? e.major : e.minor, x <= 1.0 ? e.minor : e.major,
            x <= 1.0 ? e.ratio : 1.0 / e.ratio};
  });
  return table;
}

/// x^(-1/3) to 2 ulp for normal positive x, a third of std::cbrt's time. The bit pattern of a floating-point number is
/// its logarithm, roughly, which gives 3 %; two steps of fourth order, y (1 - r)^{-1/3} with r = 1 - x y³, do the rest.
double inverse_cube_root(double x) {
  double y = std::bit_cast<double>(0x553ef0ff289dd796ULL - std::bit_cast<std::uint64_t>(x) / 3);
  for (int i = 0; i < 2; ++i) {
    const double r = 1.0 - x * y * y * y;
    y += y * r * (1.0 / 3.0 + r * (2.0 / 9.0 + r * (14.0 / 81.0)));
  }
  return y;
}

HertzContact contact_of(const HertzEllipse& e, double A, double B, const ElasticMaterial& material) {
  const double modulus = material.contact_modulus();
  const double sum = A + B;
  const double length = inverse_cube_root(modulus * sum);
  const double stiffness = e.stiffness * modulus / std::sqrt(sum);
  // The longer axis lies along the smaller curvature.
  const bool long_in_rolling = A <= B;
  const double a = long_in_rolling ? e.major : e.minor;
  const double b = long_in_rolling ? e.minor : e.major;
  return {stiffness, a * length, b * length, a / b};
}

}  // namespace

bool ElasticMaterial::has_contact_modulus(double modulus) const noexcept {
  return std::abs(modulus / contact_modulus() - 1.0) <= 1e-6;
}

void ElasticMaterial::validate() const {
  if (!(E >= 1e8 && E <= 1e15)) {
    throw input_error("material.E", fmt::format("{} Pa", E), "Young's modulus of 1e8 to 1e15 Pa");
  }
  if (!(nu >= 0.0 && nu <= 0.5)) {
    throw input_error("material.nu", fmt::format("{}", nu), "Poisson's ratio in 0..0.5");
  }
}

HertzContact hertz_contact_exact(double A, double B, const ElasticMaterial& material) {
  assert(A > 0.0 && B > 0.0);
  return contact_of(hertz_ellipse(std::min(A, B) / std::max(A, B)), A, B, material);
}

HertzContact hertz_contact(double A, double B, const ElasticMaterial& material) noexcept {
  assert(A > 0.0 && B > 0.0);
  const double ratio = std::min(A, B) / std::max(A, B);
  if (!(ratio >= 0x1p-21)) return hertz_contact_exact(A, B, material);
  const std::array<double, 4> e = ellipse_table()(ratio);
  return contact_of({e[0], e[1], e[2], e[3]}, A, B, material);
}

}  // namespace railtab
