#include "railtab/runtime/algebra/multifrontal.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Matrix = Eigen::MatrixXd;
using MatrixMap = Eigen::Map<Matrix>;

class Elimination {
 public:
  Elimination(const Sparse& matrix, const EliminationTree& tree)
      : matrix_(matrix),
        tree_(tree),
        place_(tree.unknown.size()),
        front_(Eigen::VectorXd::Zero(Eigen::Index{tree.largest_front} * tree.largest_front)),
        waiting_(tree.waiting) {}

  /// @return false where a pivot is not positive
  [[nodiscard]] bool eliminate(int b, EliminatedBlock& block) {
    const Eigen::Index n = tree_.columns(b), below = static_cast<Eigen::Index>(tree_.rows(b).size());
    MatrixMap front(front_.data(), n + below, n + below);
    assemble(b, front);
    auto own = front.topLeftCorner(n, n);
    // With the root of D in the triangle, C Cᵀ, products need no factor between them.
    if (!take_root(own)) return false;
    block.inverse.setIdentity(n, n);
    own.template triangularView<Eigen::Lower>().solveInPlace(block.inverse);
    block.below.resize(below, n);
    if (below > 0) {
      auto beside = front.bottomLeftCorner(below, n);
      block.below.noalias() = beside * block.inverse.transpose().template triangularView<Eigen::Upper>();
      wait(block.below, front.bottomRightCorner(below, below));
      beside.noalias() = block.below * block.inverse.template triangularView<Eigen::Lower>();
      block.below = beside;
    }
    block.D = own.diagonal().array().square();
    block.inverse = own.diagonal().asDiagonal() * block.inverse;
    return true;
  }

 private:
  // The matrix's entries in the block's columns and what its children have left for its rows; lower triangle.
  void assemble(int b, MatrixMap& front) {
    const int begin = tree_.first[index(b)], n = tree_.columns(b);
    const std::span<const int> rows = tree_.rows(b);
    for (int j = 0; j < n; ++j) place_[index(begin + j)] = j;
    for (std::size_t k = 0; k < rows.size(); ++k) place_[index(rows[k])] = n + static_cast<int>(k);
    for (Eigen::Index j = 0; j < front.cols(); ++j) front.col(j).tail(front.rows() - j).setZero();
    for (int j = 0; j < n; ++j) {
      tree_.visit_column(matrix_, begin + j, [&](int i, double value) {
        if (i >= begin + j) front(place_[index(i)], j) += value;
      });
    }
    for (int c = tree_.last_child[index(b)]; c >= 0; c = tree_.sibling[index(c)]) {  // the last one waits on top
      const std::span<const int> from = tree_.rows(c);
      top_ -= from.size() * from.size();
      const double* column = waiting_.data() + top_;
      for (std::size_t j = 0; j < from.size(); ++j, column += from.size()) {
        double* const to = &front(0, place_[index(from[j])]);
        for (std::size_t i = j; i < from.size(); ++i) to[place_[index(from[i])]] += column[i];
      }
    }
  }

  // What the block changes in the rows below it, for the parent's front. @param rows  B C⁻ᵀ @param front  its rows
  // below
  template <class Corner>
  void wait(const Matrix& rows, Corner front) {
    constexpr Eigen::Index small = 32;  // up to which a product is faster whole than as a triangle
    if (rows.rows() <= small) {
      front.noalias() -= rows.lazyProduct(rows.transpose());
    } else {
      front.template selfadjointView<Eigen::Lower>().rankUpdate(rows, -1.0);
    }
    MatrixMap(waiting_.data() + top_, rows.rows(), rows.rows()).template triangularView<Eigen::Lower>() = front;
    top_ += static_cast<std::size_t>(rows.rows() * rows.rows());
  }

  // A = C Cᵀ in the lower triangle.
  template <class Block>
  [[nodiscard]] static bool take_root(Block&& A) {
    constexpr Eigen::Index small = 8;
    if (A.rows() > small) {
      Eigen::Ref<Matrix> there(A);
      return Eigen::LLT<Eigen::Ref<Matrix>>(there).info() == Eigen::Success && A.diagonal().minCoeff() > 0.0;
    }
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      const double pivot = A(j, j) - A.row(j).head(j).squaredNorm();
      if (!(pivot > 0.0)) return false;
      A(j, j) = std::sqrt(pivot);
      for (Eigen::Index i = j + 1; i < A.rows(); ++i) {
        A(i, j) = (A(i, j) - A.row(i).head(j).dot(A.row(j).head(j))) / A(j, j);
      }
    }
    return true;
  }

  const Sparse& matrix_;
  const EliminationTree& tree_;
  std::vector<int> place_;       // of a row in the front
  Eigen::VectorXd front_;        // begins at a full register: Eigen's sums depend on the place of their numbers
  std::vector<double> waiting_;  // lower triangles in square matrices, one on top of the other
  std::size_t top_ = 0;
};

}  // namespace

bool factorise(const Sparse& matrix, const EliminationTree& tree,
               const std::function<void(int, const EliminatedBlock&)>& store) {
  Elimination elimination(matrix, tree);
  EliminatedBlock block;
  for (int b = 0; b < tree.blocks(); ++b) {
    if (!elimination.eliminate(b, block)) return false;
    store(b, block);
  }
  return true;
}

}  // namespace railtab
