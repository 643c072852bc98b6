#include "railtab/runtime/measures/pole_sum.hpp"

namespace railtab {

PoleSum::PoleSum(const std::vector<PoleTerm>& terms, double step) {
  for (const PoleTerm& term : terms) terms_.push_back({std::exp(term.p * step), term.r, 0.0});
}

void PoleSum::begin_at(double value) {
  for (Term& term : terms_) term.sum = value / (1.0 - term.factor);
}

double PoleSum::add(double x) noexcept {
  double result = 0.0;
  for (Term& term : terms_) {
    term.sum = term.factor * term.sum + x;
    result += term.r.real() * term.sum.real() - term.r.imag() * term.sum.imag();
  }
  return result;
}

double PoleSum::of_constant() const noexcept {
  double result = 0.0;
  for (const Term& term : terms_) result += (term.r / (1.0 - term.factor)).real();
  return result;
}

}  // namespace railtab
