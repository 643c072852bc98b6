#include "railtab/runtime/structure/lowest_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {

namespace {

using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

/// Basis of the Krylov space of K⁻¹ M, M-orthonormal, with the projection of K⁻¹ M on it.
class BlockLanczos {
 public:
  BlockLanczos(const Sparse& stiffness, const Sparse& mass, Eigen::Index block)
      : mass_(mass), factor_(stiffness_factor(stiffness)), block_(block) {
    Matrix start(mass.rows(), block);
    for (double& value : start.reshaped()) value = random();
    append(factor_.solve_columns(mass * start), nullptr);
  }

  [[nodiscard]] Eigen::Index size() const { return size_; }

  /// One more block; false where the space cannot grow.
  bool extend() {
    if (added_ == 0) return false;  // no mass at all, or none that a number can hold
    const Eigen::Index last = size_ - added_, columns = added_;
    const Matrix next = factor_.solve_columns(mass_basis_.middleCols(last, columns));
    Matrix projected = Matrix::Zero(size_, columns);
    append(next, &projected);
    projection_.conservativeResize(size_, size_);
    projection_.rightCols(added_).setZero();
    projection_.bottomRows(added_).setZero();
    projection_.block(0, last, projected.rows(), columns) = projected;
    projection_.block(last, 0, columns, projected.rows()) = projected.transpose();
    return added_ > 0;
  }

  /// Ritz vectors of the largest `modes` eigenvalues of K⁻¹ M, and whether their residuals are below the tolerance.
  bool ritz(Eigen::Index modes, double tolerance, ModalBasis& basis) const {
    const Eigen::Index known = size_ - added_;  // columns of the projection that are complete
    if (known == 0) return false;
    const SymmetricSpectrum spectrum = symmetric_spectrum(projection_.topLeftCorner(known, known));
    const Eigen::Index positive = (spectrum.values.array() > 0.0).count();  // others are rounding of no mass
    const Eigen::Index count = std::min(modes, positive);
    if (count == 0) return false;
    const Matrix vectors = spectrum.vectors.rightCols(count).rowwise().reverse();
    const Eigen::VectorXd theta = spectrum.values.tail(count).reverse();
    const Matrix residual = projection_.block(known, 0, added_, known) * vectors;
    for (Eigen::Index k = 0; k < count; ++k) {
      if (!(std::isfinite(1.0 / theta[k]) && residual.col(k).norm() <= tolerance * theta[k])) {
        return false;
      }
    }
    basis.shape = basis_.leftCols(known) * vectors;
    basis.omega2 = theta.cwiseInverse();
    return count == modes || added_ == 0;
  }

 private:
  double random() { return std::uniform_real_distribution<double>(-1.0, 1.0)(generator_); }

  // Takes the block's components in the basis out (twice: once loses digits), then orthonormalises it column by column.
  void append(Matrix block, Matrix* projected) {
    const Eigen::Index before = size_;
    for (int pass = 0; pass < 2 && before > 0; ++pass) {
      const Matrix part = mass_basis_.leftCols(before).transpose() * block;
      block.noalias() -= basis_.leftCols(before) * part;
      if (projected) *projected += part;
    }
    if (size_ + block.cols() > basis_.cols()) {
      const Eigen::Index room = std::max(2 * basis_.cols(), size_ + 8 * block_);
      basis_.conservativeResize(mass_.rows(), room);
      mass_basis_.conservativeResize(mass_.rows(), room);
    }
    const double scale = block.size() > 0 ? block.cwiseAbs().maxCoeff() : 0.0;
    Matrix inner = Matrix::Zero(block.cols(), block.cols());
    added_ = 0;
    for (Eigen::Index k = 0; k < block.cols(); ++k) {
      Eigen::VectorXd column = block.col(k);
      for (int pass = 0; pass < 2; ++pass) {
        for (Eigen::Index i = 0; i < added_; ++i) {
          const double part = mass_basis_.col(before + i).dot(column);
          column -= part * basis_.col(before + i);
          inner(i, k) += part;
        }
      }
      const Eigen::VectorXd weighted = mass_ * column;
      const double square = column.dot(weighted);
      constexpr double rounding = 1e-9;
      if (square < 0.0 && square < -rounding * column.cwiseAbs().dot(mass_.cwiseAbs() * column.cwiseAbs())) {
        throw ComputationError("natural modes: a motion with negative mass: check the mass matrix");
      }
      const double norm = std::sqrt(std::max(0.0, square));
      if (!(norm > 1e-12 * scale) || before + added_ == mass_.rows()) continue;  // nothing new in this direction
      basis_.col(before + added_) = column / norm;
      mass_basis_.col(before + added_) = weighted / norm;
      inner(added_++, k) = norm;
    }
    size_ = before + added_;
    if (!projected) return;
    projected->conservativeResize(size_, block.cols());
    projected->bottomRows(added_) = inner.topRows(added_);
  }

  const Sparse& mass_;
  SparseLdlt factor_;
  Eigen::Index block_, size_ = 0, added_ = 0;
  Matrix basis_, mass_basis_, projection_;
  std::mt19937_64 generator_{20240607};
};

}  // namespace

ModalBasis lowest_modes(const Sparse& stiffness, const Sparse& mass, int modes, double tolerance) {
  const Eigen::Index wanted = std::min<Eigen::Index>(modes, mass.rows());
  constexpr Eigen::Index block = 8;  // vectors for which the factor is read once
  BlockLanczos lanczos(stiffness, mass, std::min(block, mass.rows()));
  // A space of some twice the modes has them. One that grows far beyond that never will.
  const Eigen::Index most = 20 * wanted + 200;
  ModalBasis basis;
  Eigen::Index next_look = wanted + wanted / 2 + 24;
  while (lanczos.size() <= most && lanczos.extend()) {
    if (lanczos.size() < next_look) continue;
    if (lanczos.ritz(wanted, tolerance, basis)) return basis;
    next_look = lanczos.size() + lanczos.size() / 4;
  }
  // The whole space, or one in which nothing new is found: it has all modes that there are.
  if (lanczos.ritz(wanted, tolerance, basis)) return basis;
  throw ComputationError(fmt::format(
      "natural modes: the lowest {} of {} degrees of freedom were not found in a Krylov space of {} vectors; "
      "check the scales of mass and stiffness",
      wanted, mass.rows(), lanczos.size()));
}

Matrix residual_shapes(const Sparse& stiffness, const ModalBasis& modes, const Matrix& forces) {
  constexpr double least = 1e-5;
  Matrix residual = stiffness_factor(stiffness).solve_columns(forces);
  const double largest = forces.cwiseProduct(residual).colwise().sum().maxCoeff();
  residual -= modes.shape * (modes.omega2.cwiseInverse().asDiagonal() * (modes.shape.transpose() * forces));
  const SymmetricSpectrum spectrum = symmetric_spectrum(forces.transpose() * residual);
  const Eigen::Index count = (spectrum.values.array() > least * largest).count();
  const double omega2 = modes.omega2[modes.omega2.size() - 1];
  const Eigen::VectorXd scale = (omega2 / spectrum.values.tail(count).array()).sqrt();
  return residual * (spectrum.vectors.rightCols(count) * scale.asDiagonal());
}

}  // namespace railtab
