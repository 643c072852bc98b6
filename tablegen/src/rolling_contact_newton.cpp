#include "rolling_contact_newton.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr int kBasis = 60;  // GMRES vectors; it is not restarted

}  // namespace

RollingContactNewton::RollingContactNewton(const RollingContactGrid& grid, double nu)
    : grid_(grid), product_(grid.n, grid.dx, grid.dy, nu) {
  const int n = grid.n;
  for (int c = 0; c < 2; ++c) {
    Eigen::MatrixXd row(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) row(i, j) = product_.in_row(c, j - i);
    }
    for (int length = 1; length <= n; ++length) {
      run_inverse_[c].push_back(row.topLeftCorner(length, length).inverse());
    }
    diagonal_[c] = product_.in_row(c, 0);
    ahead_[c] = product_.in_row(c, 1);
  }
  state_.assign(static_cast<std::size_t>(n * n), State::outside);
  tangent_x_ = tangent_y_ = stiffness_ = Eigen::VectorXd::Zero(n * n);
  right_side_ = solution_ = expanded_ = scratch_ = ElementField::Zero(2 * n * n);
  basis_.assign(kBasis + 1, right_side_);
}

double RollingContactNewton::residual(const ElementField& traction, const ElementField& slip) const {
  const int m = grid_.n * grid_.n;
  double sum = 0.0;
  for (const int k : grid_.inside) {
    const double px = traction[k], py = traction[m + k];
    const double qx = px - slip[k] / diagonal_[0], qy = py - slip[m + k] / diagonal_[0];
    const double q = std::hypot(qx, qy);
    const double shrink = q > grid_.bound[k] ? grid_.bound[k] / q : 1.0;
    sum += std::hypot(px - shrink * qx, py - shrink * qy);
  }
  return sum * grid_.area;
}

/// Elements at the bound slip while slip opposes them; the right side is that of Newton's equation, −s in adhesion and
/// −t·s in slip.
void RollingContactNewton::classify(const ElementField& traction, const ElementField& slip) {
  const int m = grid_.n * grid_.n;
  right_side_.setZero();
  for (const int k : grid_.inside) {
    const double px = traction[k], py = traction[m + k], g = grid_.bound[k];
    const double sx = slip[k], sy = slip[m + k];
    const double against = -(px * sx + py * sy);
    const bool slips = px * px + py * py >= g * g * (1.0 - 1e-12) && against > 0.0;
    state_[k] = slips ? State::slip : State::adhesion;
    if (!slips) {
      right_side_[k] = -sx;
      right_side_[m + k] = -sy;
      continue;
    }
    tangent_x_[k] = -py / g;
    tangent_y_[k] = px / g;
    stiffness_[k] = against / (g * g);
    right_side_[k] = -(tangent_x_[k] * sx + tangent_y_[k] * sy);
  }
}

/// Traction change of the unknowns: both components in adhesion, along the tangent in slip.
void RollingContactNewton::direction_step(const ElementField& unknown, ElementField& traction) const {
  const int m = grid_.n * grid_.n;
  traction = unknown;
  for (const int k : grid_.inside) {
    if (state_[k] != State::slip) continue;
    traction[k] = tangent_x_[k] * unknown[k];
    traction[m + k] = tangent_y_[k] * unknown[k];
  }
}

void RollingContactNewton::linear_operator(const ElementField& unknown, ElementField& result) {
  const int m = grid_.n * grid_.n;
  direction_step(unknown, expanded_);
  product_.apply(expanded_, scratch_);
  result.setZero();
  for (const int k : grid_.inside) {
    if (state_[k] == State::adhesion) {
      result[k] = scratch_[k];
      result[m + k] = scratch_[m + k];
    } else {
      result[k] = tangent_x_[k] * scratch_[k] + tangent_y_[k] * scratch_[m + k] + stiffness_[k] * unknown[k];
    }
  }
}

/// Row by row from the leading edge: exact on runs of adhering elements, two-diagonal on slipping ones.
void RollingContactNewton::precondition(const ElementField& residual, ElementField& unknown) const {
  const int n = grid_.n, m = n * n;
  unknown.setZero();
  for (int j = 0; j < n; ++j) {
    for (int i = n - 1; i >= 0; --i) {
      const int k = j * n + i;
      if (state_[k] == State::outside) continue;
      if (state_[k] == State::slip) {
        const double tx = tangent_x_[k], ty = tangent_y_[k];
        double right = residual[k];
        if (i + 1 < n && state_[k + 1] == State::slip) {
          right -= (ahead_[0] * tx * tangent_x_[k + 1] + ahead_[1] * ty * tangent_y_[k + 1]) * unknown[k + 1];
        }
        unknown[k] = right / (diagonal_[0] * tx * tx + diagonal_[1] * ty * ty + stiffness_[k]);
        continue;
      }
      int first = i;
      while (first > 0 && state_[j * n + first - 1] == State::adhesion) --first;
      const int length = i - first + 1;
      for (int c = 0; c < 2; ++c) {
        unknown.segment(c * m + j * n + first, length).noalias() =
            run_inverse_[c][static_cast<std::size_t>(length - 1)] * residual.segment(c * m + j * n + first, length);
      }
      i = first;
    }
  }
}

/// GMRES with the preconditioner on the right; solution_ from right_side_. @returns products used
int RollingContactNewton::solve_linear(double tolerance) {
  const double start = right_side_.norm();
  solution_.setZero();
  if (start == 0.0) return 0;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(kBasis + 1, kBasis);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(kBasis + 1), cosine(kBasis), sine(kBasis);
  ElementField preconditioned(right_side_.size());
  basis_[0] = right_side_ / start;
  g[0] = start;
  int k = 0;
  while (k < kBasis && std::abs(g[k]) > tolerance * start) {
    precondition(basis_[k], preconditioned);
    linear_operator(preconditioned, basis_[k + 1]);
    for (int i = 0; i <= k; ++i) {
      h(i, k) = basis_[i].dot(basis_[k + 1]);
      basis_[k + 1] -= h(i, k) * basis_[i];
    }
    h(k + 1, k) = basis_[k + 1].norm();
    if (h(k + 1, k) > 0.0) basis_[k + 1] /= h(k + 1, k);
    for (int i = 0; i < k; ++i) {
      const double upper = cosine[i] * h(i, k) + sine[i] * h(i + 1, k);
      h(i + 1, k) = -sine[i] * h(i, k) + cosine[i] * h(i + 1, k);
      h(i, k) = upper;
    }
    const double length = std::hypot(h(k, k), h(k + 1, k));
    if (length == 0.0) break;
    cosine[k] = h(k, k) / length;
    sine[k] = h(k + 1, k) / length;
    h(k, k) = length;
    g[k + 1] = -sine[k] * g[k];
    g[k] *= cosine[k];
    ++k;
  }
  const Eigen::VectorXd y = h.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
  right_side_.setZero();
  for (int i = 0; i < k; ++i) right_side_ += y[i] * basis_[i];
  precondition(right_side_, solution_);
  return k;
}

/// Take the step; whatever leaves the friction circle comes back to it radially.
void RollingContactNewton::update(ElementField& traction) {
  const int m = grid_.n * grid_.n;
  direction_step(solution_, expanded_);
  traction += expanded_;
  for (const int k : grid_.inside) {
    const double p = std::hypot(traction[k], traction[m + k]), g = grid_.bound[k];
    if (p <= g && state_[k] != State::slip) continue;
    traction[k] *= g / p;
    traction[m + k] *= g / p;
  }
}

RollingContactNewton::Outcome RollingContactNewton::solve(const ElementField& rigid_slip, ElementField& traction,
                                                          double tolerance, int max_iterations) {
  Outcome outcome{0.0, 0, 0, false};
  ElementField slip(traction.size());
  double before = 1.0;
  for (;; ++outcome.iterations) {
    product_.apply(traction, slip);
    ++outcome.products;
    slip += rigid_slip;
    outcome.residual = residual(traction, slip);
    outcome.converged = outcome.residual <= tolerance;
    if (outcome.converged || outcome.iterations >= max_iterations) return outcome;
    classify(traction, slip);
    outcome.products += solve_linear(std::clamp(0.1 * outcome.residual / before, 1e-4, 0.05));
    before = outcome.residual;
    update(traction);
  }
}

}  // namespace railtab
