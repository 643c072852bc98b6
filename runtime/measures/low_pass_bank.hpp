#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace railtab {

/// ZeroPhaseLowPass for many series at once, in bounded memory: four numbers per series for each sample of its
/// look-ahead. Its results are those of ZeroPhaseLowPass to rounding.
class LowPassBank {
 public:
  /// @param cut_off [Hz] @param step between samples [s] @pre as ZeroPhaseLowPass
  LowPassBank(std::size_t series, double cut_off, double step);

  /// One filtered sample of every series; `sample` counts from 0.
  using Taker = std::function<void(long sample, std::span<const double> filtered)>;
  /// Takes a sample of every series and hands out those that are finished.
  void add(std::span<const double> samples, const Taker& taker);
  /// After the last sample: hands out the rest.
  void finish(const Taker& taker);

  /// Numbers of what it holds, for checkpoints: appended, and taken from the front of `numbers`.
  /// @throws InputError where they are none of a bank of so many series
  void pack(std::vector<double>& numbers) const;
  void unpack(std::span<const double>& numbers);
  /// At most [numbers].
  [[nodiscard]] std::size_t capacity() const noexcept;

 private:
  /// e^{pΔt} and r of a pole; the sums of all series, real parts, then imaginary parts.
  struct Pole {
    double factor_re, factor_im, r_re, r_im, constant_re, constant_im;
    std::vector<double> sum;
  };
  void begin_at(const double* values, std::vector<Pole>& poles) const;
  /// Takes the next samples into the sums and adds Re Σ r s to `result`.
  void advance(const double* samples, std::vector<Pole>& poles, double* result) const;
  void run_back(std::size_t emitted, const Taker& taker);

  std::size_t series_, look_ahead_, held_ = 0;
  long emitted_ = 0;
  double unit_, centre_;
  std::vector<Pole> forward_, backward_;
  std::vector<double> sample_, forward_sum_;  // samples held × series
  std::vector<double> result_;
};

}  // namespace railtab
