#include "railtab/tablegen/force_over_lowering.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cassert>
#include <cmath>

#include "railtab/runtime/profile/cubic_spline.hpp"
#include "railtab/tables/hermite_basis.hpp"

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
  const double width = lowering_[i + 1] - lowering_[i];
  const HermiteBasis basis(from_begin / width, width);
  return std::pow(HermiteBasis::sum(basis.value, {root_[i], slope_[i], root_[i + 1], slope_[i + 1]}), 1.5);
}

double ForceOverLowering::work_in(std::size_t i, double from_begin) const {
  const auto force = [&](double at) { return force_in(i, at); };
  return boost::math::quadrature::gauss<double, 5>::integrate(force, 0.0, from_begin);
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
