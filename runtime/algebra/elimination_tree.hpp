#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <vector>

#include "railtab/runtime/base/dof_range.hpp"

namespace railtab {

/// The factor L of a symmetric matrix before its numbers: which columns are stored together, and the rows they have.
///
/// Neighbouring columns of (nearly) equal structure are a block, a dense triangle with one list of rows below it
/// [Davis2006, Sect. 4.8]. Every block hangs on the block of its first row below; the blocks are in postorder, so that
/// those that hang on a block come right before it.
struct EliminationTree {
  int range_begin;                   ///< unknown that the range begins with, from which all are counted
  std::vector<int> unknown;          ///< eliminated k-th
  std::vector<int> position;         ///< of an unknown in the order of elimination
  std::vector<int> first;            ///< column of each block, and the number of columns
  std::vector<std::size_t> row_end;  ///< of each block in `row`
  std::vector<int> row;              ///< below each block's triangle, increasing
  std::vector<int> parent;           ///< block; -1: a root
  /// The last of the blocks that hang on a block, and the one before of those that hang on the same; -1: none.
  std::vector<int> last_child, sibling;
  std::size_t entries = 0;  ///< of L below the diagonal, without the zeros that blocks store
  int largest_front = 0;    ///< most rows of a block, its triangle's among them
  /// Most numbers of update matrices that wait for their parents at a time (multifrontal.hpp).
  std::size_t waiting = 0;

  /// @param order as of elimination_order(), of the same matrix and range
  EliminationTree(const Eigen::SparseMatrix<double>& matrix, const DofRange& range, std::vector<int> order);

  /// Calls visitor(row, value) for the matrix's entries of column k, both in the order of elimination.
  template <class Visitor>
  void visit_column(const Eigen::SparseMatrix<double>& matrix, int k, Visitor&& visitor) const {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, range_begin + unknown[static_cast<std::size_t>(k)]);
         entry; ++entry) {
      const auto i = static_cast<std::size_t>(entry.row() - range_begin);  // less than 0: huge
      if (i < position.size()) visitor(position[i], entry.value());
    }
  }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(unknown.size()); }
  [[nodiscard]] int blocks() const noexcept { return static_cast<int>(parent.size()); }
  [[nodiscard]] int columns(int block) const noexcept {
    return first[static_cast<std::size_t>(block) + 1] - first[static_cast<std::size_t>(block)];
  }
  [[nodiscard]] std::span<const int> rows(int block) const noexcept {
    const auto b = static_cast<std::size_t>(block);
    const std::size_t begin = b == 0 ? 0 : row_end[b - 1];
    return {row.data() + begin, row_end[b] - begin};
  }
};

}  // namespace railtab
