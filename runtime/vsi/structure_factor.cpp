#include "railtab/runtime/vsi/structure_factor.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Columns [begin, end) of the factor and what storing them as one dense block costs.
struct Columns {
  int begin, end;
  int below;    // rows below the triangle, those of the last column
  long stored;  // entries of the factor in them

  [[nodiscard]] int count() const { return end - begin; }
  [[nodiscard]] long dense() const {
    const long n = count();
    return n * (n - 1) / 2 + n * below;
  }
};

// Zeros that a block may store for being larger: they cost traffic, small blocks cost indices and loop overhead.
bool worth_merging(const Columns& merged) {
  constexpr int small = 8;                            // columns: one register of doubles
  constexpr double share = 0.10, small_share = 0.30;  // of zeros
  const double zeros = 1.0 - static_cast<double>(merged.stored) / static_cast<double>(std::max(1L, merged.dense()));
  return zeros <= (merged.count() <= small ? small_share : share);
}

// Neighbouring columns that become one block: every column's structure, less its first row, lies in that of the column
// which this first row names; where that is the next one, both can share their rows.
std::vector<Columns> supernodes(const Sparse& L) {
  const int* const begin = L.outerIndexPtr();
  std::vector<Columns> blocks;
  for (int j = 0; j < L.outerSize(); ++j) {
    const int count = begin[j + 1] - begin[j];
    Columns block{j, j + 1, count, count};
    while (!blocks.empty()) {
      const Columns& before = blocks.back();
      const int last = before.end - 1;
      const bool hangs = begin[last + 1] > begin[last] && L.innerIndexPtr()[begin[last]] < block.end;
      const Columns merged{before.begin, block.end, block.below, before.stored + block.stored};
      if (!hangs || !worth_merging(merged)) break;
      block = merged;
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

StructureFactor::StructureFactor(const Sparse& matrix, const DofRange& range) : first_(static_cast<int>(range.begin)) {
  // minimum degree: the fewest entries
  const Eigen::SimplicialLDLT<Sparse> simplicial(
      range.count == matrix.rows() ? matrix : Sparse(matrix.block(range.begin, range.begin, range.count, range.count)));
  if (simplicial.info() != Eigen::Success || !(simplicial.vectorD().minCoeff() > 0.0)) {
    throw ComputationError("the structure's effective matrix is not positive definite: check supports and stiffnesses");
  }
  inverse_D_ = simplicial.vectorD().cwiseInverse();
  const auto& order = simplicial.permutationP().indices();
  position_.assign(order.data(), order.data() + order.size());
  Sparse L = simplicial.matrixL().nestedExpression();  // below the diagonal, rows ascending
  L.makeCompressed();

  const std::vector<Columns> found = supernodes(L);
  block_of_.resize(position_.size());
  for (const Columns& columns : found) {
    Block block{columns.begin, columns.count(), columns.below, static_cast<int>(rows_.size()), values_.size(), -1};
    const int last = columns.end - 1;
    const int* const begin = L.innerIndexPtr() + L.outerIndexPtr()[last];
    rows_.insert(rows_.end(), begin, begin + columns.below);
    const int height = block.columns + block.below;
    values_.resize(values_.size() + static_cast<std::size_t>(block.columns) * static_cast<std::size_t>(height), 0.0);
    for (int j = columns.begin; j < columns.end; ++j) {
      double* const column = values_.data() + block.value + static_cast<std::size_t>((j - columns.begin) * height);
      int place = 0;
      for (Sparse::InnerIterator entry(L, j); entry; ++entry) {
        const int row = static_cast<int>(entry.row());
        if (row < columns.end) {
          column[row - columns.begin] = entry.value();
          continue;
        }
        while (rows_[static_cast<std::size_t>(block.rows + place)] != row) ++place;
        column[block.columns + place] = entry.value();
      }
      block_of_[static_cast<std::size_t>(j)] = static_cast<int>(blocks_.size());
    }
    most_below_ = std::max(most_below_, block.below);
    blocks_.push_back(block);
  }
  for (Block& block : blocks_) {
    if (block.below > 0) {
      block.parent = block_of_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(block.rows)])];
    }
  }
}

std::size_t StructureFactor::bytes() const noexcept {
  return values_.size() * sizeof(double) + rows_.size() * sizeof(int) + blocks_.size() * sizeof(Block);
}

void StructureFactor::find_path(std::span<const int> unknowns, Path& path) const {
  path.mark_.resize(blocks_.size(), 0);
  path.blocks_.clear();
  ++path.collection_;
  for (int unknown : unknowns) {
    for (int b = block_of_[static_cast<std::size_t>(position(unknown))];
         b >= 0 && path.mark_[static_cast<std::size_t>(b)] != path.collection_;
         b = blocks_[static_cast<std::size_t>(b)].parent) {
      path.mark_[static_cast<std::size_t>(b)] = path.collection_;
      path.blocks_.push_back(b);
    }
  }
  std::sort(path.blocks_.begin(), path.blocks_.end());
}

void StructureFactor::into(const Vector& natural, Vector& ordered) const {
  ordered.resize(size());
  for (Eigen::Index i = 0; i < size(); ++i) ordered[position_[static_cast<std::size_t>(i)]] = natural[first_ + i];
}

void StructureFactor::out_of(const Vector& ordered, Vector& natural) const {
  natural.conservativeResize(std::max(natural.size(), first_ + size()));
  for (Eigen::Index i = 0; i < size(); ++i) natural[first_ + i] = ordered[position_[static_cast<std::size_t>(i)]];
}

void StructureFactor::forward(double* y, const Block& block, double* scratch) const {
  using Column = Eigen::Map<const Vector>;
  const int height = block.columns + block.below;
  const double* column = values_.data() + block.value;
  double* const own = y + block.first;
  Eigen::Map<Vector> change(scratch, block.below);
  change.setZero();
  for (int k = 0; k < block.columns; ++k, column += height) {
    const double value = own[k];
    for (int i = k + 1; i < block.columns; ++i) own[i] -= column[i] * value;
    change += value * Column(column + block.columns, block.below);
  }
  const int* const row = rows_.data() + block.rows;
  for (int i = 0; i < block.below; ++i) y[row[i]] -= scratch[i];
}

void StructureFactor::backward(double* x, const Block& block, double* scratch) const {
  using Column = Eigen::Map<const Vector>;
  const int height = block.columns + block.below;
  const int* const row = rows_.data() + block.rows;
  for (int i = 0; i < block.below; ++i) scratch[i] = x[row[i]];
  const Column below(scratch, block.below);
  double* const own = x + block.first;
  const double* column = values_.data() + block.value + static_cast<std::size_t>((block.columns - 1) * height);
  for (int k = block.columns - 1; k >= 0; --k, column -= height) {
    double sum = Column(column + block.columns, block.below).dot(below);
    for (int i = k + 1; i < block.columns; ++i) sum += column[i] * own[i];
    own[k] -= sum;
  }
}

void StructureFactor::forward(Vector& y) const {
  Vector scratch(most_below_);
  for (const Block& block : blocks_) forward(y.data(), block, scratch.data());
}

void StructureFactor::backward(Vector& x) const {
  Vector scratch(most_below_);
  x.array() *= inverse_D_.array();
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) backward(x.data(), *block, scratch.data());
}

void StructureFactor::forward(Vector& y, const Path& path) const {
  Vector scratch(most_below_);
  for (int b : path.blocks_) forward(y.data(), blocks_[static_cast<std::size_t>(b)], scratch.data());
}

void StructureFactor::backward(const Vector& y, Vector& x, const Path& path) const {
  Vector scratch(most_below_);
  for (auto b = path.blocks_.rbegin(); b != path.blocks_.rend(); ++b) {
    const Block& block = blocks_[static_cast<std::size_t>(*b)];
    x.segment(block.first, block.columns) =
        y.segment(block.first, block.columns).cwiseProduct(inverse_D_.segment(block.first, block.columns));
    backward(x.data(), block, scratch.data());
  }
}

StructureFactor::Vector StructureFactor::solve(const Vector& load) const {
  Vector ordered, natural = Vector::Zero(load.size());
  into(load, ordered);
  forward(ordered);
  backward(ordered);
  out_of(ordered, natural);
  return natural;
}

}  // namespace railtab
