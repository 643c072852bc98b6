#pragma once

#include <complex>
#include <vector>

namespace railtab {

/// A linear filter by its impulse response, h(t) = Re Σ r_i e^{p_i t} for t >= 0, Re p_i < 0. Of a pair of conjugate
/// poles one term stands for both.
struct PoleTerm {
  std::complex<double> p;  ///< [1/s]
  std::complex<double> r;  ///< [1/s]
};

/// The sum of a series' samples with that response, one sample after the other: s_i ← e^{p_i Δt} s_i + x,
/// Re Σ r_i s_i = Σ_j h(jΔt) x_{k−j}. It has no error of a time step besides that of sampling (aliasing).
class PoleSum {
 public:
  PoleSum() = default;
  /// @param step between samples [s], > 0
  PoleSum(const std::vector<PoleTerm>& terms, double step);
  /// As if the series had been `value` for ever.
  void begin_at(double value);
  /// @return the sum with this sample [unit of the samples, 1/s]
  double add(double x) noexcept;
  /// Σ_j h(jΔt): the sum of a series that is constant at 1.
  [[nodiscard]] double of_constant() const noexcept;

 private:
  struct Term {
    std::complex<double> factor, r, sum;
  };
  std::vector<Term> terms_;
};

}  // namespace railtab
