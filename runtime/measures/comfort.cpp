#include "railtab/runtime/measures/comfort.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/measures/percentile.hpp"

namespace railtab {
namespace {

constexpr double median = 0.5, high = 0.95;  // shares of the windows [EN12299]

}  // namespace

WindowedRms::WindowedRms(double window, double step) : samples_(std::max(1L, std::lround(window / step))) {}

void WindowedRms::add(double weighted) {
  sum_ += weighted * weighted;
  if (++count_ < samples_) return;
  values_.push_back(std::sqrt(sum_ / static_cast<double>(samples_)));
  sum_ = 0.0;
  count_ = 0;
}

double mean_comfort(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
  return 6.0 * std::hypot(percentile(x, high), percentile(y, high), percentile(z, high));
}

double mean_comfort_standing(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
  return 3.0 * std::hypot(4.0 * percentile(x, median), 2.0 * percentile(y, median), percentile(z, median)) +
         5.0 * percentile(y, high);
}

double mean_comfort_seated(const std::vector<double>& z_floor, const std::vector<double>& y_pan,
                           const std::vector<double>& z_pan, const std::vector<double>& x_back) {
  return 4.0 * percentile(z_floor, high) + 2.0 * std::hypot(percentile(y_pan, high), percentile(z_pan, high)) +
         4.0 * percentile(x_back, high);
}

VibrationDose::VibrationDose(double step, double window)
    : step_(step), squares_(static_cast<std::size_t>(std::max(1L, std::lround(window / step))), 0.0) {}

void VibrationDose::add(double weighted) {
  const double square = weighted * weighted;
  fourth_ += square * square * step_;
  sum_ += square - squares_[at_];
  squares_[at_] = square;
  at_ = (at_ + 1) % squares_.size();
  filled_ = std::min(filled_ + 1, squares_.size());
  if (at_ == 0) {  // rounding must not gather
    sum_ = 0.0;
    for (const double s : squares_) sum_ += s;
  }
  if (filled_ < squares_.size()) return;
  largest_ = std::max(largest_, std::sqrt(std::max(0.0, sum_) / static_cast<double>(squares_.size())));
}

double VibrationDose::dose() const noexcept { return std::pow(fourth_, 0.25); }

double sperling_weighting(SperlingDirection direction, double frequency) noexcept {
  const double f2 = frequency * frequency;
  const double above = 1.911 * f2 + (0.25 * f2) * (0.25 * f2);
  const double left = 1.0 - 0.277 * f2, right = 1.563 * frequency - 0.0368 * f2 * frequency;
  const double vertical = 0.588 * std::sqrt(above / (left * left + right * right));
  return direction == SperlingDirection::vertical ? vertical : 1.25 * vertical;
}

SperlingIndex::SperlingIndex(SperlingDirection direction, double step, double window)
    : samples_(std::max(1L, std::lround(window / step))) {
  constexpr double lowest = 0.4, highest = 30.0;  // [Hz]
  const double length = step * static_cast<double>(samples_);
  constexpr double rounding =
      1e-3;  // of a line: a window that is no multiple of the step is a little longer or shorter
  for (long k = std::max(1L, std::lround(std::ceil(lowest * length - rounding)));
       static_cast<double>(k) / length <= highest; ++k) {
    if (2 * k >= samples_) break;
    const double turn = -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(samples_);
    lines_.push_back({sperling_weighting(direction, static_cast<double>(k) / length), std::polar(1.0, turn), 1.0, 0.0});
  }
}

void SperlingIndex::add(double acceleration) {
  for (Line& line : lines_) {
    line.sum += acceleration * line.at;
    line.at *= line.turn;
  }
  if (++count_ < samples_) return;
  constexpr double centimetres = 100.0;
  double cubes = 0.0;
  for (const Line& line : lines_) {
    const double amplitude = centimetres * 2.0 * std::abs(line.sum) / static_cast<double>(samples_);
    cubes += std::pow(amplitude * line.weight, 3);
  }
  values_.push_back(std::pow(cubes, 0.1));
  restart();
}

void SperlingIndex::restart() {
  count_ = 0;
  for (Line& line : lines_) {
    line.at = 1.0;
    line.sum = 0.0;
  }
}

}  // namespace railtab
