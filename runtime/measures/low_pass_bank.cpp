#include "railtab/runtime/measures/low_pass_bank.hpp"

#include <algorithm>
#include <cassert>
#include <complex>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/measures/low_pass.hpp"

namespace railtab {

LowPassBank::LowPassBank(std::size_t series, double cut_off, double step) : series_(series), result_(series) {
  const LowPassSum sum = low_pass_sum(cut_off, step);
  look_ahead_ = sum.look_ahead;
  unit_ = sum.unit;
  centre_ = sum.centre;
  for (const PoleTerm& term : sum.terms) {
    const std::complex<double> factor = std::exp(term.p * step), constant = 1.0 / (1.0 - factor);
    forward_.push_back({factor.real(), factor.imag(), term.r.real(), term.r.imag(), constant.real(), constant.imag(),
                        std::vector<double>(2 * series, 0.0)});
  }
  backward_ = forward_;
}

void LowPassBank::begin_at(const double* values, std::vector<Pole>& poles) const {
  for (Pole& pole : poles) {
    for (std::size_t i = 0; i < series_; ++i) {
      pole.sum[i] = values[i] * pole.constant_re;
      pole.sum[series_ + i] = values[i] * pole.constant_im;
    }
  }
}

void LowPassBank::advance(const double* samples, std::vector<Pole>& poles, double* result) const {
  for (Pole& pole : poles) {
    const double factor_re = pole.factor_re, factor_im = pole.factor_im, r_re = pole.r_re, r_im = pole.r_im;
    double *re = pole.sum.data(), *im = re + series_;
    for (std::size_t i = 0; i < series_; ++i) {
      const double before = re[i];
      re[i] = factor_re * before - factor_im * im[i] + samples[i];
      im[i] = factor_re * im[i] + factor_im * before;
      result[i] += r_re * re[i] - r_im * im[i];
    }
  }
}

void LowPassBank::add(std::span<const double> samples, const Taker& taker) {
  assert(samples.size() == series_);
  if (held_ == 0 && emitted_ == 0) begin_at(samples.data(), forward_);
  sample_.insert(sample_.end(), samples.begin(), samples.end());
  forward_sum_.resize(forward_sum_.size() + series_, 0.0);
  advance(samples.data(), forward_, forward_sum_.data() + held_ * series_);
  if (++held_ == 2 * look_ahead_) run_back(look_ahead_, taker);
}

void LowPassBank::finish(const Taker& taker) {
  if (held_ > 0) run_back(held_, taker);
  emitted_ = 0;
}

void LowPassBank::run_back(std::size_t emitted, const Taker& taker) {
  begin_at(sample_.data() + (held_ - 1) * series_, backward_);
  for (std::size_t k = held_; k-- > 0;) {
    const double* samples = sample_.data() + k * series_;
    std::fill(result_.begin(), result_.end(), 0.0);
    advance(samples, backward_, result_.data());
    if (k >= emitted) continue;
    double* sum = forward_sum_.data() + k * series_;
    for (std::size_t i = 0; i < series_; ++i) sum[i] = unit_ * (sum[i] + result_[i] - centre_ * samples[i]);
  }
  for (std::size_t k = 0; k < emitted; ++k) {
    taker(emitted_++, std::span<const double>(forward_sum_.data() + k * series_, series_));
  }
  const auto gone = static_cast<std::ptrdiff_t>(emitted * series_);
  sample_.erase(sample_.begin(), sample_.begin() + gone);
  forward_sum_.erase(forward_sum_.begin(), forward_sum_.begin() + gone);
  held_ -= emitted;
}

std::size_t LowPassBank::capacity() const noexcept { return 3 + (4 * look_ahead_ + 2 * forward_.size()) * series_; }

void LowPassBank::pack(std::vector<double>& numbers) const {
  numbers.insert(numbers.end(),
                 {static_cast<double>(series_), static_cast<double>(held_), static_cast<double>(emitted_)});
  const auto append = [&](const std::vector<double>& values) {
    numbers.insert(numbers.end(), values.begin(), values.end());
  };
  for (const Pole& pole : forward_) append(pole.sum);
  append(sample_);
  append(forward_sum_);
}

void LowPassBank::unpack(std::span<const double>& numbers) {
  const auto wrong = [&] { return InputError("a checkpoint whose filters are not those of this run"); };
  if (numbers.size() < 3 || numbers[0] != static_cast<double>(series_)) throw wrong();
  if (!(numbers[1] >= 0.0 && numbers[1] < 2.0 * static_cast<double>(look_ahead_))) throw wrong();
  held_ = static_cast<std::size_t>(numbers[1]);
  emitted_ = static_cast<long>(numbers[2]);
  numbers = numbers.subspan(3);
  const auto take = [&](std::vector<double>& values, std::size_t count) {
    if (numbers.size() < count) throw wrong();
    values.assign(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count));
    numbers = numbers.subspan(count);
  };
  for (Pole& pole : forward_) take(pole.sum, 2 * series_);
  take(sample_, held_ * series_);
  take(forward_sum_, held_ * series_);
}

}  // namespace railtab
