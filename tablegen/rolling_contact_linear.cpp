#include "railtab/tablegen/rolling_contact_linear.hpp"

#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab {

namespace {

constexpr int kBasis = 60;  // GMRES vectors; it is not restarted

}  // namespace

RollingContactLinear::RollingContactLinear(const RollingContactGrid& grid, const RollingContactProduct& product)
    : grid_(grid), product_(product), hessenberg_(kBasis + 1, kBasis), rotated_(kBasis + 1), cosine_(kBasis) {
  const int n = grid.nx, m = grid.count();
  for (int c = 0; c < 2; ++c) {
    diagonal_[c] = product.in_row(c, 0);
    ahead_[c] = static_cast<float>(product.in_row(c, 1));
    Eigen::MatrixXd row(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) row(i, j) = product.in_row(c, j - i) / diagonal_[c];
    }
    for (int length = 1; length <= n; ++length) {
      run_inverse_[c].emplace_back(dense_inverse(row.topLeftCorner(length, length)).cast<float>());
    }
  }
  state_.assign(static_cast<std::size_t>(m), State::outside);
  tangent_x_ = tangent_y_ = scale_ = stiffness_ = Eigen::VectorXf::Zero(m);
  unknown_ = traction_ = slip_ = ElementFieldSingle::Zero(2 * m);
  basis_.assign(kBasis + 1, unknown_);
  sine_ = cosine_;
}

void RollingContactLinear::slip(int element, double tx, double ty, double stiffness) {
  state_[element] = State::slip;
  const double d = diagonal_[0] * tx * tx + diagonal_[1] * ty * ty + stiffness;
  tangent_x_[element] = static_cast<float>(tx);
  tangent_y_[element] = static_cast<float>(ty);
  scale_[element] = static_cast<float>(1.0 / d);
  stiffness_[element] = static_cast<float>(stiffness / d);
}

/// basis_[0], of length one. @returns its length before
double RollingContactLinear::set_right_side(const ElementField& slip) {
  const int m = grid_.count();
  ElementField right = ElementField::Zero(2 * m);
  for (const int k : grid_.inside) {
    if (state_[k] == State::adhesion) {
      right[k] = -slip[k] / diagonal_[0];
      right[m + k] = -slip[m + k] / diagonal_[1];
    } else {
      right[k] = -scale_[k] * (tangent_x_[k] * slip[k] + tangent_y_[k] * slip[m + k]);
    }
  }
  const double largest = right.cwiseAbs().maxCoeff();  // of creepages whose squares overflow
  const double length = largest > 0.0 ? largest * (right / largest).norm() : 0.0;
  if (length > 0.0) basis_[0] = (right / length).cast<float>();
  return length;
}

/// Traction change of the unknowns (both components in adhesion, along the tangent in slip), and the scaled equations.
void RollingContactLinear::multiply(const ElementFieldSingle& unknown, ElementFieldSingle& result) {
  const int m = grid_.count();
  traction_ = unknown;
  for (const int k : grid_.inside) {
    if (state_[k] != State::slip) continue;
    traction_[k] = tangent_x_[k] * unknown[k];
    traction_[m + k] = tangent_y_[k] * unknown[k];
  }
  product_.apply(traction_, slip_);
  const auto x = static_cast<float>(1.0 / diagonal_[0]), y = static_cast<float>(1.0 / diagonal_[1]);
  result.setZero();
  for (const int k : grid_.inside) {
    if (state_[k] == State::adhesion) {
      result[k] = x * slip_[k];
      result[m + k] = y * slip_[m + k];
    } else {
      result[k] = scale_[k] * (tangent_x_[k] * slip_[k] + tangent_y_[k] * slip_[m + k]) + stiffness_[k] * unknown[k];
    }
  }
}

/// Row by row from the leading edge: exact on runs of adhering elements, two-diagonal on slipping ones.
void RollingContactLinear::precondition(const ElementFieldSingle& residual, ElementFieldSingle& unknown) const {
  const int n = grid_.nx, m = grid_.count();
  unknown.setZero();
  for (int j = 0; j < grid_.ny; ++j) {
    for (int i = n - 1; i >= 0; --i) {
      const int k = j * n + i;
      if (state_[k] == State::outside) continue;
      if (state_[k] == State::slip) {
        unknown[k] = residual[k];
        if (i + 1 < n && state_[k + 1] == State::slip) {
          const float coupling =
              ahead_[0] * tangent_x_[k] * tangent_x_[k + 1] + ahead_[1] * tangent_y_[k] * tangent_y_[k + 1];
          unknown[k] -= scale_[k] * coupling * unknown[k + 1];
        }
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

/// Column k of the Hessenberg matrix, turned to upper triangular. @returns its last element, 0 where it is singular
float RollingContactLinear::orthogonalise(int k) {
  auto column = hessenberg_.col(k);
  for (int i = 0; i <= k; ++i) {
    column[i] = basis_[i].dot(basis_[k + 1]);
    basis_[k + 1] -= column[i] * basis_[i];
  }
  column[k + 1] = basis_[k + 1].norm();
  if (column[k + 1] > 0.0F) basis_[k + 1] /= column[k + 1];
  for (int i = 0; i < k; ++i) {
    const float upper = cosine_[i] * column[i] + sine_[i] * column[i + 1];
    column[i + 1] = -sine_[i] * column[i] + cosine_[i] * column[i + 1];
    column[i] = upper;
  }
  const float length = std::hypot(column[k], column[k + 1]);
  if (!(length > 0.0F)) return 0.0F;
  cosine_[k] = column[k] / length;
  sine_[k] = column[k + 1] / length;
  rotated_[k + 1] = -sine_[k] * rotated_[k];
  rotated_[k] *= cosine_[k];
  return column[k] = length;
}

/// GMRES with the preconditioner on the right: unknown_ from basis_[0]. @returns products used
int RollingContactLinear::iterate(float tolerance) {
  rotated_[0] = 1.0F;
  int k = 0;
  while (k < kBasis && std::abs(rotated_[k]) > tolerance) {
    precondition(basis_[k], unknown_);
    multiply(unknown_, basis_[k + 1]);
    if (orthogonalise(k) == 0.0F) break;
    ++k;
  }
  const Eigen::VectorXf y = hessenberg_.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(rotated_.head(k));
  traction_.setZero();
  for (int i = 0; i < k; ++i) traction_ += y[i] * basis_[i];
  precondition(traction_, unknown_);
  return k;
}

int RollingContactLinear::solve(const ElementField& slip, double tolerance, ElementField& step) {
  const int m = grid_.count();
  step.setZero();
  const double length = set_right_side(slip);
  if (length == 0.0) return 0;
  const int products = iterate(static_cast<float>(tolerance));
  for (const int k : grid_.inside) {
    const double u = length * unknown_[k];
    const bool slips = state_[k] == State::slip;
    step[k] = slips ? tangent_x_[k] * u : u;
    step[m + k] = slips ? tangent_y_[k] * u : length * unknown_[m + k];
  }
  return products;
}

}  // namespace railtab
