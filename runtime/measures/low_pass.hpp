#pragma once

#include <cstddef>
#include <vector>

#include "railtab/runtime/measures/pole_sum.hpp"

namespace railtab {

/// Low-pass without phase: a Butterworth filter of order 4 run forward and backward in time, its amplitude
///   G(f) = 1/(1 + (√2 − 1)(f/f_c)^8)                                                                       (FM1)
/// so that 1/√2 remains at the cut-off f_c after both passes. The impulse response, Re Σ r_i e^{p_i |t|} with the four
/// stable poles of (FM1) and residues −p/8, is summed over the samples: there is no error but aliasing, below 4e-4 of
/// unit gain up to f_c where f_c Δt <= 1/4. Before its first sample and after its last one a series counts as constant.
///
/// Samples go in one by one and come out later, as many and in the same order, in bounded memory: twice the time in
/// which the response decays to 1e-14, 1.6 s at 30 Hz. All at once or one by one, the results are the same to 1e-13 of
/// the largest sample.
class ZeroPhaseLowPass {
 public:
  /// @param cut_off f_c > 0 [Hz] @param step between samples [s] @pre cut_off·step <= 1/4, see samples_fast_enough()
  ZeroPhaseLowPass(double cut_off, double step);
  /// Takes a sample and appends those that are finished to `filtered`.
  void add(double sample, std::vector<double>& filtered);
  /// After the last sample: appends the rest.
  void finish(std::vector<double>& filtered);

 private:
  void run_back(std::size_t emitted, std::vector<double>& filtered);

  PoleSum forward_, backward_;
  double unit_ = 1.0, centre_ = 0.0;  // 1/(sum of a constant), h(0)
  std::size_t look_ahead_ = 1;        // samples
  bool begun_ = false;
  std::vector<double> sample_, forward_sum_;
  std::vector<double> result_;
};

/// The constants of (FM1) as a sum over samples.
struct LowPassSum {
  std::vector<PoleTerm> terms;
  double unit = 1.0, centre = 0.0;  ///< 1/(sum of a constant), h(0)
  std::size_t look_ahead = 1;       ///< samples in which the response decays to 1e-14
};
/// @pre as ZeroPhaseLowPass
[[nodiscard]] LowPassSum low_pass_sum(double cut_off, double step);

/// Whether samples `step` [s] apart are near enough for a cut-off [Hz], and the longest such step.
[[nodiscard]] constexpr bool samples_fast_enough(double cut_off, double step) noexcept {
  return cut_off * step <= 0.25;
}
[[nodiscard]] constexpr double longest_low_pass_step(double cut_off) noexcept { return 0.25 / cut_off; }

/// A whole series. @pre as ZeroPhaseLowPass
[[nodiscard]] std::vector<double> low_passed(const std::vector<double>& samples, double cut_off, double step);

/// (FM1)
[[nodiscard]] double low_pass_gain(double frequency, double cut_off) noexcept;

}  // namespace railtab
