#include "railtab/runtime/measures/low_pass.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace railtab {
namespace {

constexpr int order = 4;
const double edge = std::numbers::sqrt2 - 1.0;

/// Two stable poles of (FM1), each for its conjugate too, residues doubled.
std::vector<PoleTerm> low_pass_terms(double cut_off) {
  using std::numbers::pi;
  const double omega = 2.0 * pi * cut_off * std::pow(edge, -1.0 / (2 * order));
  std::vector<PoleTerm> terms;
  for (int k = 1; 2 * k <= order; ++k) {
    const std::complex<double> p = std::polar(omega, pi * (2 * k + order - 1) / (2 * order));
    terms.push_back({p, -p / static_cast<double>(order)});
  }
  return terms;
}

}  // namespace

double low_pass_gain(double frequency, double cut_off) noexcept {
  return 1.0 / (1.0 + edge * std::pow(frequency / cut_off, 2 * order));
}

LowPassSum low_pass_sum(double cut_off, double step) {
  assert(cut_off > 0.0 && samples_fast_enough(cut_off, step));
  constexpr double decayed = 32.0;  // e^-32 = 1e-14
  LowPassSum sum;
  sum.terms = low_pass_terms(cut_off);
  double slowest = INFINITY;
  for (const PoleTerm& term : sum.terms) {
    sum.centre += term.r.real();
    slowest = std::min(slowest, -term.p.real());
  }
  sum.look_ahead = static_cast<std::size_t>(std::ceil(decayed / (slowest * step)));
  sum.unit = 1.0 / (2.0 * PoleSum(sum.terms, step).of_constant() - sum.centre);
  return sum;
}

ZeroPhaseLowPass::ZeroPhaseLowPass(double cut_off, double step) {
  const LowPassSum sum = low_pass_sum(cut_off, step);
  forward_ = backward_ = PoleSum(sum.terms, step);
  unit_ = sum.unit;
  centre_ = sum.centre;
  look_ahead_ = sum.look_ahead;
}

void ZeroPhaseLowPass::add(double sample, std::vector<double>& filtered) {
  if (!begun_) forward_.begin_at(sample);
  begun_ = true;
  sample_.push_back(sample);
  forward_sum_.push_back(forward_.add(sample));
  if (sample_.size() == 2 * look_ahead_) run_back(look_ahead_, filtered);
}

void ZeroPhaseLowPass::finish(std::vector<double>& filtered) {
  if (!sample_.empty()) run_back(sample_.size(), filtered);
  begun_ = false;
}

void ZeroPhaseLowPass::run_back(std::size_t emitted, std::vector<double>& filtered) {
  result_.resize(sample_.size());
  backward_.begin_at(sample_.back());
  for (std::size_t k = sample_.size(); k-- > 0;) {
    result_[k] = unit_ * (forward_sum_[k] + backward_.add(sample_[k]) - centre_ * sample_[k]);
  }
  const auto count = static_cast<std::ptrdiff_t>(emitted);
  filtered.insert(filtered.end(), result_.begin(), result_.begin() + count);
  sample_.erase(sample_.begin(), sample_.begin() + count);
  forward_sum_.erase(forward_sum_.begin(), forward_sum_.begin() + count);
}

std::vector<double> low_passed(const std::vector<double>& samples, double cut_off, double step) {
  ZeroPhaseLowPass filter(cut_off, step);
  std::vector<double> filtered;
  filtered.reserve(samples.size());
  for (const double sample : samples) filter.add(sample, filtered);
  filter.finish(filtered);
  return filtered;
}

}  // namespace railtab
