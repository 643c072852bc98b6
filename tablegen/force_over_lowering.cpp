#include "railtab/tablegen/force_over_lowering.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "railtab/runtime/profile/cubic_spline.hpp"

namespace railtab {

ForceOverLowering::ForceOverLowering(std::vector<double> lowering, const std::vector<double>& force)
    : lowering_(std::move(lowering)), work_{0.0} {
  assert(lowering_.size() == force.size() && force.size() >= 3 && lowering_.front() == 0.0 && force.front() == 0.0);
  for (const double f : force) root_.push_back(std::cbrt(f * f));
  slope_ = natural_spline_slopes(lowering_, root_);
  for (std::size_t i = 0; i + 1 < lowering_.size(); ++i) {
    work_.push_back(work_[i] + work_in(i, lowering_[i + 1] - lowering_[i]));
  }
}

double ForceOverLowering::force_in(std::size_t i, double from_begin) const {
  const double width = lowering_[i + 1] - lowering_[i], rise = root_[i + 1] - root_[i], t = from_begin / width;
  const double begins = width * slope_[i] - rise, ends = rise - width * slope_[i + 1];
  return std::pow(root_[i] + t * rise + t * (1.0 - t) * ((1.0 - t) * begins + t * ends), 1.5);
}

/// Gauss's rule with five points.
double ForceOverLowering::work_in(std::size_t i, double from_begin) const {
  constexpr std::array place{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                              0.2369268850561891};
  double sum = 0.0;
  for (std::size_t k = 0; k < place.size(); ++k) sum += weight[k] * force_in(i, 0.5 * from_begin * (1.0 + place[k]));
  return 0.5 * from_begin * sum;
}

double ForceOverLowering::force(double lowering) const {
  const auto above = std::upper_bound(lowering_.begin() + 1, lowering_.end() - 1, lowering);
  const auto i = static_cast<std::size_t>(above - lowering_.begin()) - 1;
  return force_in(i, lowering - lowering_[i]);
}

double ForceOverLowering::lowering_at(double work) const {
  const auto above = std::upper_bound(work_.begin() + 1, work_.end() - 1, work);
  const auto i = static_cast<std::size_t>(above - work_.begin()) - 1;
  const double width = lowering_[i + 1] - lowering_[i];
  // The force rises: Newton's method comes to the root from one side, quadratically.
  double from_begin = width;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const double change = (work - work_[i] - work_in(i, from_begin)) / force_in(i, from_begin);
    from_begin += change;
    if (std::abs(change) < 1e-14 * width) break;
  }
  return lowering_[i] + from_begin;
}

}  // namespace railtab
