#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "railtab/runtime/base/dof_range.hpp"

namespace railtab {

/// Products with stiffness and damping in one pass over the memory: their lower triangles, entry by entry beside each
/// other.
class PairedProduct {
 public:
  PairedProduct() = default;
  /// @param stiffness, damping symmetric, whole pattern
  PairedProduct(const Eigen::SparseMatrix<double>& stiffness, const Eigen::SparseMatrix<double>& damping);

  /// f <- f − K u − C v of the unknowns in the range, all others being zero.
  void subtract(const double* u, const double* v, const DofRange& range, double* f) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return begin_.empty(); }
  /// What it takes, and what subtract() reads [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept {
    return entry_.size() * (sizeof(Entry) + sizeof(int)) + begin_.size() * sizeof(int);
  }

 private:
  struct Entry {
    double stiffness = 0.0, damping = 0.0;
  };
  std::vector<Entry> entry_;      ///< column by column, each from its diagonal on
  std::vector<int> row_, begin_;  ///< of every entry; of every column
};

}  // namespace railtab
