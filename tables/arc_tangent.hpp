#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/tables/power_coefficients.hpp"

namespace railtab {

/// arctan without branches or tables, of a number or of numbers side by side, to some units in the last place: q g(q²)
/// with a polynomial g for |q| <= tan(π/8), turned by −π/4 beyond.
class ArcTangent {
 public:
  ArcTangent() {
    // g(z) = arctan(√z)/√z at Chebyshev nodes.
    std::array<long double, degree + 1> node, value;
    for (std::size_t i = 0; i <= degree; ++i) {
      const auto angle = std::numbers::pi_v<long double> * (static_cast<long double>(i) + 0.5L) / (degree + 1);
      node[i] = 0.5L * largest * largest * (1.0L + std::cos(angle));
      value[i] = std::atan(std::sqrt(node[i])) / std::sqrt(node[i]);
    }
    const std::array<long double, degree + 1> power = power_coefficients(node, value);
    for (std::size_t k = 0; k <= degree; ++k) coefficient_[k] = static_cast<double>(power[k]);
  }

  /// Of (x, y) with y >= 0 to (1, 0), 0..π; 0 at (0, 0), NaN where x or y is.
  template <class V>
  [[nodiscard]] V angle(const V& y, const V& x) const noexcept {
    using std::abs;
    const V width = abs(x), zero{}, one = broadcast<V>(1.0);
    const auto steep = y > width;
    const V larger = select(steep, y, width), smaller = select(steep, width, y);
    const auto turned = smaller > largest * larger;
    const V below = select(turned, smaller + larger, larger);
    const V q = select(turned, smaller - larger, smaller) / select(larger <= zero, one, below);
    const V z = q * q, zz = z * z;
    V even = broadcast<V>(coefficient_[degree - 1]), odd = broadcast<V>(coefficient_[degree]);
    for (std::size_t k = degree - 1; k > 0; k -= 2) {
      even = even * zz + coefficient_[k - 2];
      odd = odd * zz + coefficient_[k - 1];
    }
    const V first = q * (even + z * odd) + select(turned, broadcast<V>(0.25 * std::numbers::pi), zero);
    const V folded = select(steep, 0.5 * std::numbers::pi - first, first);
    return select(x < zero, std::numbers::pi - folded, folded);
  }

 private:
  static constexpr std::size_t degree = 11;
  static_assert(degree % 2 == 1, "even and odd powers are summed side by side, in as many steps");
  static constexpr double largest = std::numbers::sqrt2 - 1.0;  // tan(π/8)
  std::array<double, degree + 1> coefficient_;
};

}  // namespace railtab
