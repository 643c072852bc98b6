#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "railtab/runtime/algebra/tree_path.hpp"

namespace railtab {

/// Few entries of the solution of L D Lᵀ x = b for loads b on few rows, six right-hand sides at once, at a cost that
/// depends on where they are and not on the size of the system.
///
/// Forward substitution changes only the rows on the paths from the loaded rows to the root of L's elimination tree,
/// and backward substitution needs, for the rows wanted, only those on their own paths [Davis2006, Sect. 3.2]. In a
/// long and narrow system these paths are short.
class SelectedSolve {
 public:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
  /// Memory besides L [bytes].
  static constexpr double bytes_per_row = 7.0 * sizeof(double) + sizeof(long) + sizeof(int);

  /// @param L strictly lower triangle of the unit lower factor, compressed or not; must live as long as this
  SelectedSolve(const Eigen::SparseMatrix<double>& L, Eigen::VectorXd D);

  /// Rows from which on a solution is wanted: their paths to the root.
  void want(std::span<const int> rows);
  /// Solve for the six right-hand sides that load() has put on `rows`; row k of the solution is x() row k, valid for
  /// the rows wanted last.
  void solve(std::span<const int> loaded_rows, const Columns& loads);
  [[nodiscard]] auto x(int row) const { return x_.row(row); }

 private:
  void collect(std::span<const int> rows, TreePath& path) const;
  [[nodiscard]] int column_end(int j) const noexcept;

  const Eigen::SparseMatrix<double>& L_;
  Eigen::VectorXd D_;
  std::vector<int> parent_;  // in the elimination tree; -1: a root
  TreePath loaded_, wanted_;
  Columns x_;
};

}  // namespace railtab
