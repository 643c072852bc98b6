#include "railtab/runtime/measures/weighting.hpp"

#include <cmath>
#include <numbers>

namespace railtab {
namespace {

using Complex = std::complex<double>;

/// (n0 + n1 s + n2 s²)/(d0 + d1 s + d2 s²)
struct Section {
  double n0, n1, n2, d0, d1, d2;
  [[nodiscard]] Complex value(Complex s) const { return (n0 + s * (n1 + s * n2)) / (d0 + s * (d1 + s * d2)); }
};

std::vector<Section> sections(const Weighting& w) {
  const auto omega = [](double f) { return 2.0 * std::numbers::pi * f; };
  const double root = std::numbers::sqrt2;
  const double w1 = omega(w.f1), w2 = omega(w.f2), w3 = omega(w.f3), w4 = omega(w.f4);
  std::vector<Section> result{{0.0, 0.0, 1.0, w1 * w1, root * w1, 1.0},
                              {w2 * w2, 0.0, 0.0, w2 * w2, root * w2, 1.0},
                              {w4 * w4, w4 * w4 / w3, 0.0, w4 * w4, w4 / w.Q4, 1.0}};
  if (w.f5 > 0.0) {
    const double w5 = omega(w.f5), w6 = omega(w.f6);
    result.push_back({w.K, w.K / (w.Q5 * w5), w.K / (w5 * w5), 1.0, 1.0 / (w.Q6 * w6), 1.0 / (w6 * w6)});
  }
  return result;
}

}  // namespace

std::complex<double> Weighting::response(double frequency) const noexcept {
  Complex product = 1.0;
  for (const Section& section : sections(*this)) product *= section.value({0.0, 2.0 * std::numbers::pi * frequency});
  return product;
}

std::vector<PoleTerm> Weighting::terms() const {
  const std::vector<Section> all = sections(*this);
  std::vector<PoleTerm> result;
  for (const Section& own : all) {
    // complex: all quality factors exceed 1/2
    const double real = -0.5 * own.d1 / own.d2, imaginary = std::sqrt(own.d0 / own.d2 - real * real);
    const Complex p(real, imaginary);
    Complex residue = (own.n0 + p * (own.n1 + p * own.n2)) / (own.d1 + 2.0 * own.d2 * p);
    for (const Section& other : all) {
      if (&other != &own) residue *= other.value(p);
    }
    result.push_back({p, 2.0 * residue});
  }
  return result;
}

}  // namespace railtab
