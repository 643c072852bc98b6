#include "railtab/runtime/line/irregularity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/interval_search.hpp"

namespace railtab {
namespace {

void check_column(const std::vector<double>& x, const std::vector<double>& column, const char* name) {
  const std::string place = fmt::format("irregularity: {}", name);
  if (column.size() != x.size()) {
    throw input_error(place, fmt::format("{} points", column.size()), fmt::format("{}", x.size()));
  }
  for (size_t i = 0; i < column.size(); ++i) {
    if (std::isfinite(column[i])) continue;
    throw input_error(fmt::format("{}, point {}", place, i + 1), fmt::format("{}", column[i]), "a finite number");
  }
}

void check_positions(const std::vector<double>& x) {
  if (x.size() < 2) throw input_error("irregularity", fmt::format("{} points", x.size()), "at least 2");
  check_column(x, x, "x");
  for (size_t i = 1; i < x.size(); ++i) {
    if (x[i] > x[i - 1]) continue;
    throw input_error(fmt::format("irregularity: x, point {}", i + 1), fmt::format("{}", x[i]),
                      fmt::format("more than the point before, {}", x[i - 1]));
  }
}

/// Second derivatives of the natural cubic spline at the points: the tridiagonal system by forward elimination and
/// back-substitution.
std::vector<double> natural_curvatures(const std::vector<double>& x, const std::vector<double>& value) {
  const size_t n = x.size();
  std::vector<double> curvature(n, 0.0), upper(n, 0.0);
  for (size_t i = 1; i + 1 < n; ++i) {
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
    const double bend = 6 * ((value[i + 1] - value[i]) / h1 - (value[i] - value[i - 1]) / h0);
    const double pivot = 2 * (h0 + h1) - h0 * upper[i - 1];
    upper[i] = h1 / pivot;
    curvature[i] = (bend - h0 * curvature[i - 1]) / pivot;
  }
  for (size_t i = n - 1; i-- > 1;) curvature[i] -= upper[i] * curvature[i + 1];
  return curvature;
}

/// Where between two points a distance h apart, from 0 to 1, their spline is level: the roots b of
/// (v1 − v0)/h² + ((1 − 3(1 − b)²) m0 + (3b² − 1) m1)/6 = 0. Other numbers where there are none.
std::array<double, 2> level_places(double v0, double v1, double m0, double m1, double h) {
  const double p = 0.5 * (m1 - m0), q = m0, r = (v1 - v0) / (h * h) - (2.0 * m0 + m1) / 6.0;
  const double root = q * q - 4.0 * p * r;
  if (!(root >= 0.0)) return {-1.0, -1.0};
  const double s = -0.5 * (q + std::copysign(std::sqrt(root), q));  // [Press2007, Eq. 5.6.4]
  return {p != 0.0 ? s / p : -1.0, s != 0.0 ? r / s : -1.0};
}

}  // namespace

Irregularity::Irregularity(std::vector<double> x, std::vector<double> y_left, std::vector<double> z_left,
                           std::vector<double> y_right, std::vector<double> z_right)
    : x_(std::move(x)) {
  check_positions(x_);
  knots_.resize(x_.size());
  const std::pair<const char*, const std::vector<double>&> columns[] = {
      {"y_left", y_left}, {"z_left", z_left}, {"y_right", y_right}, {"z_right", z_right}};
  for (size_t c = 0; c < 4; ++c) {
    const auto& [name, column] = columns[c];
    check_column(x_, column, name);
    const std::vector<double> curvature = natural_curvatures(x_, column);
    for (size_t i = 0; i < x_.size(); ++i) {
      knots_[i].value[c] = column[i];
      knots_[i].curvature[c] = curvature[i];
    }
  }
}

double Irregularity::largest() const noexcept {
  double largest = 0.0;
  for (const Knot& knot : knots_) {
    for (const double value : knot.value) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

double Irregularity::largest_mean_height() const noexcept {
  constexpr std::size_t z_left = 1, z_right = 3;
  double largest = 0.0;
  for (const Knot& knot : knots_) largest = std::max(largest, 0.5 * std::abs(knot.value[z_left] + knot.value[z_right]));
  return largest;
}

Irregularity::Extreme Irregularity::farthest_out() const noexcept {
  Extreme farthest;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto less = [c](const Knot& a, const Knot& b) { return a.value[c] < b.value[c]; };
    const auto [lowest, highest] = std::minmax_element(knots_.begin(), knots_.end(), less);
    if (lowest == knots_.end() || lowest->value[c] == highest->value[c]) continue;  // straight
    const double low = lowest->value[c], high = highest->value[c];
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      const double h = x_[i + 1] - x_[i];
      const double v0 = knots_[i].value[c], v1 = knots_[i + 1].value[c];
      const double m0 = knots_[i].curvature[c], m1 = knots_[i + 1].curvature[c];
      for (const double b : level_places(v0, v1, m0, m1, h)) {
        if (!(b > 0.0 && b < 1.0)) continue;
        const double a = 1 - b;
        const double value = a * v0 + b * v1 + (a * (a * a - 1) * m0 + b * (b * b - 1) * m1) * h * h / 6;
        const double beyond = std::max(low - value, value - high) / (high - low);
        if (beyond > farthest.beyond) farthest = {c, i, x_[i] + b * h, value, beyond};
      }
    }
  }
  return farthest;
}

RailDeviation Irregularity::at(RailSide side, double x) const noexcept {
  if (empty() || !(x >= x_.front() && x <= x_.back())) return {};
  const size_t i = interval_at(x_, x);
  const double h = x_[i + 1] - x_[i];
  const double b = (x - x_[i]) / h, a = 1 - b;
  // value, first and second derivative of one column, [Press2007, Eqs. 3.3.3 to 3.3.6]
  const auto evaluate = [&](size_t c, double& value, double& slope, double& curvature) {
    const double v0 = knots_[i].value[c], v1 = knots_[i + 1].value[c];
    const double m0 = knots_[i].curvature[c], m1 = knots_[i + 1].curvature[c];
    value = a * v0 + b * v1 + (a * (a * a - 1) * m0 + b * (b * b - 1) * m1) * h * h / 6;
    slope = (v1 - v0) / h + ((1 - 3 * a * a) * m0 + (3 * b * b - 1) * m1) * h / 6;
    curvature = a * m0 + b * m1;
  };
  const size_t first_column = side == RailSide::left ? 0 : 2;
  RailDeviation deviation;
  evaluate(first_column, deviation.y, deviation.dy_dx, deviation.ddy_dx2);
  evaluate(first_column + 1, deviation.z, deviation.dz_dx, deviation.ddz_dx2);
  return deviation;
}

}  // namespace railtab
