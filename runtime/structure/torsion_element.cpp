#include "railtab/runtime/structure/torsion_element.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace railtab {
namespace {

/// sinh x over ½ e^x, from e^−x − 1.
double sinh_over_half_exp(double fading) noexcept { return -fading * (2.0 + fading); }

/// Three solutions about the middle of the element, z = (s − L/2)/λ and h = L/(2λ). Hyperbolic functions are kept
/// over e^h, which no length lets overflow.
class Solutions {
 public:
  explicit Solutions(const TorsionElement& element)
      : lambda_(element.warping_length), h_(0.5 * element.length / lambda_) {
    const double fading = std::expm1(-2.0 * h_);
    sinh_h_ = -0.5 * fading;
    cosh_h_ = 1.0 + 0.5 * fading;
    of_twisted_ = h_ - sinh_h_ / cosh_h_;
    of_odd_ = 1.0 - h_ * cosh_h_ / sinh_h_;
  }

  struct Value {
    double value, slope;
  };
  /// One place, s from the first node.
  struct At {
    double s;            ///< [m]
    double first, last;  ///< e^−x − 1 of the distances x from both ends, over λ
    Value twisted;       ///< φ = ∓1, φ' = 0 at the two ends
    Value even;          ///< φ = 0, φ' = ∓1
    Value odd;           ///< φ = 0, φ' = 1 at both
  };
  [[nodiscard]] At at(double s) const noexcept {
    const double z = s / lambda_ - h_, first = std::expm1(-s / lambda_), last = std::expm1(s / lambda_ - 2.0 * h_);
    const double sinh_z = 0.5 * (last - first), cosh_z = 1.0 + 0.5 * (last + first);
    return {s,
            first,
            last,
            {(z - sinh_z / cosh_h_) / of_twisted_, (1.0 - cosh_z / cosh_h_) / (lambda_ * of_twisted_)},
            {lambda_ * (cosh_z - cosh_h_) / sinh_h_, sinh_z / sinh_h_},
            {lambda_ * (z - h_ * sinh_z / sinh_h_) / of_odd_, (1.0 - h_ * cosh_z / sinh_h_) / of_odd_}};
  }

  [[nodiscard]] double sinh_of_length_over_half_exp() const noexcept { return 4.0 * sinh_h_ * (1.0 - sinh_h_); }
  /// Torque of the first and of the third, by GJ [1/m, -].
  [[nodiscard]] double torque_of_twisted() const noexcept { return 1.0 / (lambda_ * of_twisted_); }
  [[nodiscard]] double torque_of_odd() const noexcept { return 1.0 / of_odd_; }
  /// Bimoments at the ends of the second and of the third, by GJ [m].
  [[nodiscard]] double bimoment_of_even() const noexcept { return lambda_ * cosh_h_ / sinh_h_; }
  [[nodiscard]] double bimoment_of_odd() const noexcept { return -lambda_ * h_ / of_odd_; }

 private:
  double lambda_, h_, sinh_h_, cosh_h_, of_twisted_, of_odd_;
};

/// Twist at x under a unit moment at a >= x, by 1/GJ: between forks, which let the ends warp, less what the bimoments
/// that hold the rates there take back.
double twist_under(const TorsionElement& element, const Solutions& solutions, const Solutions::At& x,
                   const Solutions::At& a) noexcept {
  const double L = element.length, lambda = element.warping_length;
  const double warping = 0.5 * lambda * std::exp((x.s - a.s) / lambda) * sinh_over_half_exp(x.first) *
                         sinh_over_half_exp(a.last) / solutions.sinh_of_length_over_half_exp();
  return x.s * (L - a.s) / L - warping - 0.5 * x.even.value * a.even.value / solutions.bimoment_of_even() -
         0.5 * x.odd.value * a.odd.value / solutions.bimoment_of_odd();
}

TorsionShape shape_at(const Solutions::At& x) noexcept {
  const auto shapes = [](double twisted, double even, double odd, double one) {
    return Eigen::Vector4d(0.5 * (one - twisted), 0.5 * (odd - even), 0.5 * (one + twisted), 0.5 * (odd + even));
  };
  return {shapes(x.twisted.value, x.even.value, x.odd.value, 1.0),
          shapes(x.twisted.slope, x.even.slope, x.odd.slope, 0.0)};
}

}  // namespace

TorsionShape torsion_shape(const TorsionElement& element, double s) noexcept {
  assert(element.length > 0 && s >= 0 && s <= element.length);
  return shape_at(Solutions(element).at(s));
}

TorsionPlace torsion_place(const TorsionElement& element, double s) noexcept {
  assert(element.length > 0 && s >= 0 && s <= element.length);
  const Solutions solutions(element);
  const Solutions::At x = solutions.at(s);
  const double between_forks =
      (element.length - 2.0 * s) / element.length -
      (sinh_over_half_exp(x.last) - sinh_over_half_exp(x.first)) / solutions.sinh_of_length_over_half_exp();
  const double held_back = x.even.value * x.even.slope / solutions.bimoment_of_even() +
                           x.odd.value * x.odd.slope / solutions.bimoment_of_odd();
  return {shape_at(x), twist_under(element, solutions, x, x) / element.GJ, (between_forks - held_back) / element.GJ};
}

Eigen::Matrix4d torsion_stiffness(const TorsionElement& element) noexcept {
  const Solutions solutions(element);
  const double torque = 0.5 * solutions.torque_of_twisted(), couple = -0.5 * solutions.torque_of_odd();
  const double even = 0.5 * solutions.bimoment_of_even(), odd = 0.5 * solutions.bimoment_of_odd();
  Eigen::Matrix4d K;
  K << torque, couple, -torque, couple,         //
      couple, odd + even, -couple, odd - even,  //
      -torque, -couple, torque, -couple,        //
      couple, odd - even, -couple, odd + even;
  return element.GJ * K;
}

Eigen::Matrix4d torsion_mass(const TorsionElement& element, double rotary_inertia) noexcept {
  // Gauss's eight points on −1..1: place and weight of those on one side.
  constexpr std::array<std::array<double, 2>, 4> points{{{0.1834346424956498, 0.3626837833783620},
                                                         {0.5255324099163290, 0.3137066458778873},
                                                         {0.7966664774136267, 0.2223810344533745},
                                                         {0.9602898564975363, 0.1012285362903763}}};
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  for (const auto& [place, weight] : points) {
    for (const double t : {-place, place}) {
      const Eigen::Vector4d N = torsion_shape(element, 0.5 * element.length * (1.0 + t)).twist;
      M += 0.5 * element.length * weight * rotary_inertia * N * N.transpose();
    }
  }
  return M;
}

double torsion_compliance(const TorsionElement& element, double x, double loaded) noexcept {
  const Solutions solutions(element);
  const Solutions::At near = solutions.at(std::min(x, loaded)), far = solutions.at(std::max(x, loaded));
  return twist_under(element, solutions, near, far) / element.GJ;  // by Maxwell's theorem
}

}  // namespace railtab
