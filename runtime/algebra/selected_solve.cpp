#include "railtab/runtime/algebra/selected_solve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace railtab {

namespace {

constexpr int columns = 6;

// Far from its load a compliance (1e-9 m/N under it) decays until it is a denormal number, on which a processor is a
// hundred times slower: below 1e-40 it is set to zero. Returns whether all six are.
bool flush(double* x) {
  bool zero = true;
  for (int k = 0; k < columns; ++k) {
    if (std::abs(x[k]) < 1e-40) x[k] = 0.0;
    zero = zero && x[k] == 0.0;
  }
  return zero;
}

}  // namespace

SelectedSolve::SelectedSolve(const Eigen::SparseMatrix<double>& L, Eigen::VectorXd D) : L_(L), D_(std::move(D)) {
  const auto n = static_cast<int>(L_.outerSize());
  parent_.assign(static_cast<std::size_t>(n), -1);
  for (int j = 0; j < n; ++j) {
    const int* const begin = L_.innerIndexPtr() + L_.outerIndexPtr()[j];
    const int* const end = L_.innerIndexPtr() + column_end(j);
    if (begin != end) parent_[static_cast<std::size_t>(j)] = *std::min_element(begin, end);
  }
  x_.setZero(n, columns);
}

int SelectedSolve::column_end(int j) const noexcept {
  const int* const count = L_.innerNonZeroPtr();  // null where compressed
  return count ? L_.outerIndexPtr()[j] + count[j] : L_.outerIndexPtr()[j + 1];
}

void SelectedSolve::collect(std::span<const int> rows, TreePath& path) const {
  path.clear(parent_.size());
  for (int row : rows) path.add(row, [&](int j) { return parent_[static_cast<std::size_t>(j)]; });
  path.sort();
}

void SelectedSolve::want(std::span<const int> rows) { collect(rows, wanted_); }

void SelectedSolve::solve(std::span<const int> loaded_rows, const Columns& loads) {
  collect(loaded_rows, loaded_);
  for (int j : wanted_.nodes()) x_.row(j).setZero();
  for (int j : loaded_.nodes()) x_.row(j).setZero();
  for (std::size_t i = 0; i < loaded_rows.size(); ++i)
    x_.row(loaded_rows[i]) += loads.row(static_cast<Eigen::Index>(i));

  const int* const row = L_.innerIndexPtr();
  const double* const value = L_.valuePtr();
  double* const data = x_.data();
  for (int j : loaded_.nodes()) {
    const double* const xj = data + columns * j;
    if (flush(data + columns * j)) continue;
    for (int p = L_.outerIndexPtr()[j], end = column_end(j); p < end; ++p) {
      double* const xi = data + columns * row[p];
      for (int k = 0; k < columns; ++k) xi[k] -= value[p] * xj[k];
    }
  }
  for (auto at = wanted_.nodes().rbegin(); at != wanted_.nodes().rend(); ++at) {
    const int j = *at;
    double sum[columns];
    for (int k = 0; k < columns; ++k) sum[k] = data[columns * j + k] / D_[j];
    for (int p = L_.outerIndexPtr()[j], end = column_end(j); p < end; ++p) {
      const double* const xi = data + columns * row[p];
      for (int k = 0; k < columns; ++k) sum[k] -= value[p] * xi[k];
    }
    for (int k = 0; k < columns; ++k) data[columns * j + k] = sum[k];
    flush(data + columns * j);
  }
}

}  // namespace railtab
