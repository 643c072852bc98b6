#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/tables/power_coefficients.hpp"

namespace railtab {

/// Smooth functions of one positive argument over many powers of two: eight polynomial pieces per binade, chosen by
/// the floating-point bits of the argument, so that a logarithmic table needs no logarithm. `lanes` functions share a
/// piece and are evaluated side by side. Constant after construction. Covers [2^first, 2^(last+1)).
template <int lanes, int degree, int first, int last>
class BinadePolynomials {
 public:
  /// Interpolates f at Chebyshev nodes on every piece. @param f double -> std::array<double, lanes>
  template <class Function>
  explicit BinadePolynomials(const Function& f) {
    std::size_t piece = 0;
    for (int exponent = first; exponent <= last; ++exponent) {
      for (int i = 0; i < kPieces; ++i) {
        const double half = std::ldexp(0.5 / kPieces, exponent);
        pieces_[piece++] = fit(std::ldexp(1.0 + i / double{kPieces}, exponent) + half, half, f);
      }
    }
  }

  /// @param x in [2^first, 2^(last+1))
  [[nodiscard]] std::array<double, lanes> operator()(double x) const noexcept {
    const Place place(x);
    assert(place.piece < pieces_.size());
    Lanes sum;
    evaluate<degree>(pieces_[place.piece].data(), place.t, sum);
    std::array<double, lanes> value;
    std::memcpy(value.data(), &sum, sizeof sum);
    return value;
  }
  /// Derivatives of the polynomials.
  [[nodiscard]] std::array<double, lanes> slope(double x) const noexcept {
    const Place place(x);
    assert(place.piece < pieces_.size());
    const Coefficients& c = pieces_[place.piece];
    const auto power = [&](std::size_t k, Lanes& lane) { std::memcpy(&lane, c[k].data(), sizeof lane); };
    Lanes sum, next;
    power(degree, sum);
    sum *= double{degree};
    for (int k = degree - 1; k > 0; --k) {
      power(static_cast<std::size_t>(k), next);
      sum = place.t * sum + static_cast<double>(k) * next;
    }
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> 52;
    sum *= 2.0 * kPieces * std::bit_cast<double>((2046 - exponent) << 52);  // dt/dx, by the power of two below x
    std::array<double, lanes> value;
    std::memcpy(value.data(), &sum, sizeof sum);
    return value;
  }

 private:
  struct Place {
    std::size_t piece;
    double t;  ///< mantissa bits below the piece's, as a number in [1, 2), mapped to [-1, 1)

    explicit Place(double x) noexcept {
      const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
      piece = (bits >> (52 - kBits)) - static_cast<std::uint64_t>((1023 + first) * kPieces);
      const std::uint64_t rest = (bits << kBits) & 0x000fffffffffffffULL;
      t = 2.0 * std::bit_cast<double>(rest | 0x3ff0000000000000ULL) - 3.0;
    }
  };
  static constexpr int kBits = 3, kPieces = 1 << kBits;
  static_assert(std::has_single_bit(unsigned{lanes}));
  using Lanes = SideBySide<lanes>;
  using Coefficients =
      std::array<std::array<double, lanes>, degree + 1>;  ///< powers of t in [-1, 1], from the constant

  /// Σ c_k t^k by halves [Estrin1960]: as many steps, one after the other, as the degree has binary digits.
  template <int highest>
  static void evaluate(const std::array<double, lanes>* c, double t, Lanes& sum) noexcept {
    if constexpr (highest == 0) {
      std::memcpy(&sum, c->data(), sizeof sum);
    } else {
      constexpr int middle = std::bit_floor(unsigned{highest});
      double power = t;
      for (int k = 1; k < middle; k *= 2) power *= power;
      Lanes upper;
      evaluate<highest - middle>(c + middle, t, upper);
      evaluate<middle - 1>(c, t, sum);
      sum += power * upper;
    }
  }

  /// Powers of the polynomials through the Chebyshev nodes.
  template <class Function>
  static Coefficients fit(double middle, double half, const Function& f) {
    using Values = std::array<double, degree + 1>;
    Values node;
    std::array<Values, lanes> value;
    for (std::size_t i = 0; i <= degree; ++i) {
      node[i] = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / (degree + 1));
      const std::array<double, lanes> at_node = f(middle + half * node[i]);
      for (std::size_t l = 0; l < lanes; ++l) value[l][i] = at_node[l];
    }
    Coefficients power;
    for (std::size_t l = 0; l < lanes; ++l) {
      const Values of_lane = power_coefficients(node, value[l]);
      for (std::size_t k = 0; k <= degree; ++k) power[k][l] = of_lane[k];
    }
    return power;
  }

  std::array<Coefficients, std::size_t{(last - first + 1) * kPieces}> pieces_;
};

}  // namespace railtab
