#include "railtab/runtime/algebra/paired_product.hpp"

#include "railtab/runtime/base/index.hpp"

namespace railtab {

PairedProduct::PairedProduct(const Eigen::SparseMatrix<double>& stiffness, const Eigen::SparseMatrix<double>& damping) {
  using Sparse = Eigen::SparseMatrix<double>;
  // The union of both patterns and the diagonal: a zero keeps an entry's place.
  Sparse diagonal(stiffness.rows(), stiffness.cols());
  diagonal.setIdentity();
  const Sparse pattern = (stiffness + damping + diagonal).triangularView<Eigen::Lower>();
  begin_.push_back(0);
  for (int j = 0; j < pattern.outerSize(); ++j) {
    for (Sparse::InnerIterator entry(pattern, j); entry; ++entry) row_.push_back(static_cast<int>(entry.row()));
    begin_.push_back(static_cast<int>(row_.size()));
  }
  entry_.resize(row_.size());
  const auto fill = [&](const Sparse& matrix, double Entry::*value) {
    for (int j = 0; j < matrix.outerSize(); ++j) {
      int p = begin_[index(j)];
      for (Sparse::InnerIterator entry(matrix, j); entry; ++entry) {
        if (entry.row() < j) continue;
        while (row_[index(p)] != entry.row()) ++p;
        entry_[index(p)].*value = entry.value();
      }
    }
  };
  fill(stiffness, &Entry::stiffness);
  fill(damping, &Entry::damping);
}

void PairedProduct::subtract(const double* u, const double* v, const DofRange& range, double* f) const noexcept {
  const int last = static_cast<int>(range.end());
  const int *const begin = begin_.data(), *const row = row_.data();
  const Entry* const entry = entry_.data();
  for (int j = static_cast<int>(range.begin); j < last; ++j) {
    const double u_j = u[j], v_j = v[j];
    int p = begin[j];
    double sum = entry[p].stiffness * u_j + entry[p].damping * v_j;
    for (++p; p < begin[j + 1] && row[p] < last; ++p) {
      const auto [k, c] = entry[p];
      const int i = row[p];
      sum += k * u[i] + c * v[i];
      f[i] -= k * u_j + c * v_j;
    }
    f[j] -= sum;
  }
}

}  // namespace railtab
