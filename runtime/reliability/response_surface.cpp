#include "railtab/runtime/reliability/response_surface.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab {
namespace {

/// 1, u_j, u_j²
void set_terms(std::span<const double> u, Eigen::VectorXd& terms) {
  const auto n = static_cast<Eigen::Index>(u.size());
  const Eigen::Map<const Eigen::ArrayXd> values(u.data(), n);
  terms(0) = 1.0;
  terms.segment(1, n) = values;
  terms.tail(n) = values.square();
}

std::vector<double> finite_responses(std::span<const double> responses) {
  double largest = -INFINITY;
  for (const double y : responses) largest = std::isfinite(y) ? std::max(largest, y) : largest;
  if (!std::isfinite(largest)) largest = 0.0;
  std::vector<double> finite(responses.begin(), responses.end());
  for (double& y : finite) y = std::isfinite(y) ? y : largest;
  return finite;
}

}  // namespace

ResponseSurface::ResponseSurface(const std::vector<std::vector<double>>& points, std::span<const double> responses)
    : linear_(points.front().size(), 0.0), square_(points.front().size(), 0.0) {
  const auto n = static_cast<Eigen::Index>(points.front().size());
  const std::vector<double> y = finite_responses(responses);
  if (points.size() >= 3 * static_cast<std::size_t>(1 + 2 * n)) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(1 + 2 * n, 1 + 2 * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + 2 * n), terms(1 + 2 * n);
    for (std::size_t i = 0; i < points.size(); ++i) {
      set_terms(points[i], terms);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(terms);
      right += y[i] * terms;
    }
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();  // points that all lie on a plane have a fit too
    const Eigen::VectorXd c = symmetric_solution(normal, right);
    constant_ = c(0);
    Eigen::Map<Eigen::VectorXd>(linear_.data(), n) = c.segment(1, n);
    Eigen::Map<Eigen::VectorXd>(square_.data(), n) = c.tail(n);
  } else {
    for (const double value : y) constant_ += value / static_cast<double>(y.size());
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) squares += std::pow(y[i] - (*this)(points[i]), 2);
  deviation_ = std::sqrt(squares / static_cast<double>(points.size()));
}

double ResponseSurface::operator()(std::span<const double> u) const {
  double y = constant_;
  for (std::size_t j = 0; j < u.size(); ++j) y += u[j] * (linear_[j] + square_[j] * u[j]);
  return y;
}

}  // namespace railtab
