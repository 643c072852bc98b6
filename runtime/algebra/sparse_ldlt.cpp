#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "railtab/runtime/algebra/multifrontal.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Blocks in an order in which none waits for the one before it: leaves of the elimination tree first, then what hangs
// on leaves only, and so on; of these, equal ones follow each other, for which a processor predicts branches rightly.
std::vector<int> by_height(const EliminationTree& tree) {
  std::vector<int> height(tree.parent.size(), 0), order(tree.parent.size());
  std::iota(order.begin(), order.end(), 0);
  for (const int b : order) {
    if (tree.parent[index(b)] < 0) continue;
    int& parent = height[index(tree.parent[index(b)])];
    parent = std::max(parent, height[index(b)] + 1);
  }
  const auto key = [&](int b) { return std::tuple(height[index(b)], tree.columns(b), tree.rows(b).size()); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

// Rows are taken four at a time; what lacks to a multiple of four is stored as zeros in a row that nobody reads.
int in_fours(int rows) { return (rows + 3) & ~3; }

using Four = Eigen::Array4d;

// Blocks of up to this many columns, nearly all, are substituted in with their part of the vector in registers.
constexpr int narrow = 8;

// Where the rows below a narrow block's triangle begin.
constexpr int triangle_room(int columns) { return (columns * (columns - 1) / 2 + 3) & ~3; }

/// A block's numbers in the order in which its substitution reads them: of a narrow one the strict triangle row by
/// row, then the rows below, four of every column at a time.
struct NarrowBlock {
  const double* value;
  const int* row;
  int below;
};

template <int n>
void narrow_forward(const NarrowBlock& block, double* own, double* y) noexcept {
  if constexpr (n == 1) {
    for (int i = 0; i < block.below; ++i) y[block.row[i]] -= block.value[i] * *own;
    return;
  }
  std::array<double, n> old;
  std::copy(own, own + n, old.begin());
  const double* t = block.value;
  for (int j = 1; j < n; ++j) {
    double sum = old[static_cast<std::size_t>(j)];
    for (int k = 0; k < j; ++k) sum += *t++ * old[static_cast<std::size_t>(k)];
    own[j] = sum;
  }
  const double* column = block.value + triangle_room(n);
  for (int i = 0; i < block.below; i += 4, column += 4 * n) {
    Four part = old[0] * Eigen::Map<const Four>(column);
    for (int k = 1; k < n; ++k) part += old[static_cast<std::size_t>(k)] * Eigen::Map<const Four>(column + 4 * k);
    for (int r = 0; r < 4; ++r) y[block.row[i + r]] -= part[r];
  }
}

/// @param inverse_D of the block's columns @param y where they stand in L⁻¹ of the load; own may be the same
template <int n>
void narrow_backward(const NarrowBlock& block, const double* inverse_D, const double* y, double* own,
                     const double* x) noexcept {
  if constexpr (n == 1) {
    double sum = *y * *inverse_D;
    for (int i = 0; i < block.below; ++i) sum -= block.value[i] * x[block.row[i]];
    *own = sum;
    return;
  }
  std::array<Four, n> sum;
  sum.fill(Four::Zero());
  const double* column = block.value + triangle_room(n);
  for (int i = 0; i < block.below; i += 4, column += 4 * n) {
    const int* const row = block.row + i;
    const Four part(x[row[0]], x[row[1]], x[row[2]], x[row[3]]);
    for (int k = 0; k < n; ++k) sum[static_cast<std::size_t>(k)] += part * Eigen::Map<const Four>(column + 4 * k);
  }
  std::array<double, n> solved, known;
  for (std::size_t k = 0; k < n; ++k) {
    known[k] = y[k] * inverse_D[k];
    solved[k] = known[k] - sum[k].sum();
  }
  const double* t = block.value;
  for (std::size_t j = 1; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) solved[k] += *t++ * known[j];
  }
  std::copy(solved.begin(), solved.end(), own);
}

/// Calls visitor.operator()<columns>(). @pre 1 <= columns <= narrow
template <class Visitor>
void with_columns(int columns, Visitor&& visitor) {
  const auto is = [&]<int n>() {
    if (columns != n) return false;
    visitor.template operator()<n>();
    return true;
  };
  [&]<int... n>(std::integer_sequence<int, n...>) { (is.template operator()<n + 1>() || ...); }
  (std::make_integer_sequence<int, narrow>());
}

/// sum <- sum + columns · factors, from row `begin` on, above which the columns are zero.
template <int number>
void add_columns(const double* column, int height, int begin, const double* factor, double* sum) {
  for (int i = begin; i < height; i += 4) {
    Four part = Eigen::Map<const Four>(sum + i);
    for (int k = 0; k < number; ++k) part += factor[k] * Eigen::Map<const Four>(column + k * height + i);
    Eigen::Map<Four>(sum + i) = part;
  }
}

// Numbers of a block, see SparseLdlt::store().
std::size_t numbers_of(int columns, int below) {
  return index(columns > narrow ? in_fours(columns + below) * columns
                                : triangle_room(columns) + in_fours(below) * columns);
}

/// result <- columnsᵀ · vector, from row `begin` on.
template <int number>
void products(const double* column, int height, int begin, const double* vector, double* result) {
  std::array<Four, number> sum;
  sum.fill(Four::Zero());
  for (int i = begin; i < height; i += 4) {
    const Four part = Eigen::Map<const Four>(vector + i);
    for (int k = 0; k < number; ++k) {
      sum[static_cast<std::size_t>(k)] += part * Eigen::Map<const Four>(column + k * height + i);
    }
  }
  for (int k = 0; k < number; ++k) result[k] = sum[static_cast<std::size_t>(k)].sum();
}

}  // namespace

SparseLdlt::SparseLdlt(const Sparse& matrix, const DofRange& range, std::string_view message, EliminationOrder order,
                       std::span<const int> node)
    : first_(static_cast<int>(range.begin)) {
  const EliminationTree tree(matrix, range, elimination_order(matrix, range, order, node));
  const std::vector<int> stored_at = place(tree);
  if (!factorise(matrix, tree,
                 [&](int b, const EliminatedBlock& block) { store(blocks_[index(stored_at[index(b)])], block); })) {
    throw ComputationError(std::string(message));
  }
}

SparseLdlt::Memory SparseLdlt::memory(const Sparse& matrix, const DofRange& range, EliminationOrder order,
                                      std::span<const int> node) {
  const EliminationTree tree(matrix, range, elimination_order(matrix, range, order, node));
  const std::size_t n = tree.unknown.size(), blocks = tree.parent.size(), nonzeros = matrix.nonZeros();
  Memory memory{.stored = blocks * sizeof(Block) + n * (2 * sizeof(int) + sizeof(double)), .entries = tree.entries};
  for (int b = 0; b < tree.blocks(); ++b) {
    const auto below = static_cast<int>(tree.rows(b).size());
    memory.stored += index(in_fours(below)) * sizeof(int) + numbers_of(tree.columns(b), below) * sizeof(double);
  }
  // METIS works on six copies of the pattern, Eigen's minimum degree on 13.
  const std::size_t patterns = order == EliminationOrder::nested_dissection ? 6 : 13;
  const std::size_t of_tree = (tree.row.size() + 8 * n) * sizeof(int) + blocks * sizeof(std::size_t);
  const std::size_t front = index(tree.largest_front) * index(tree.largest_front);
  memory.made = std::max(patterns * nonzeros * sizeof(int), of_tree + (front + tree.waiting) * sizeof(double));
  return memory;
}

// Everything but the numbers. @return where each block of the tree is in blocks_
std::vector<int> SparseLdlt::place(const EliminationTree& tree) {
  const int n = tree.size();
  position_ = tree.position;
  inverse_D_.resize(n);
  block_of_.resize(position_.size());
  std::vector<int> stored_at(tree.parent.size());
  const std::vector<int> order = by_height(tree);
  std::size_t rows = 0, values = 0;
  for (const int b : order) rows += index(in_fours(static_cast<int>(tree.rows(b).size())));
  rows_.reserve(rows);
  blocks_.reserve(order.size());
  for (const int b : order) {
    const std::span<const int> below = tree.rows(b);
    const Block block{tree.first[index(b)],           tree.columns(b), static_cast<int>(below.size()),
                      static_cast<int>(rows_.size()), values,          -1};
    rows_.insert(rows_.end(), below.begin(), below.end());
    rows_.resize(static_cast<std::size_t>(block.rows + in_fours(block.below)), n);
    values += numbers_of(block.columns, block.below);
    if (block.columns > narrow) most_height_ = std::max(most_height_, in_fours(block.columns + block.below));
    stored_at[index(b)] = static_cast<int>(blocks_.size());
    for (int j = 0; j < block.columns; ++j) block_of_[index(block.first + j)] = stored_at[index(b)];
    blocks_.push_back(block);
  }
  for (Block& block : blocks_) {
    if (block.below > 0) block.parent = block_of_[index(rows_[index(block.rows)])];
  }
  values_.resize(values);
  return stored_at;
}

// The block's numbers as its substitution reads them.
void SparseLdlt::store(const Block& block, const EliminatedBlock& from) {
  const int n = block.columns;
  inverse_D_.segment(block.first, n) = from.D.cwiseInverse();
  double* to = values_.data() + block.value;
  if (n > narrow) {
    Eigen::Map<Eigen::MatrixXd> dense(to, in_fours(n + block.below), n);
    dense.topRows(n) = from.inverse;
    dense.middleRows(n, block.below) = from.below;
    return;
  }
  for (int j = 1; j < n; ++j) {
    for (int k = 0; k < j; ++k) *to++ = from.inverse(j, k);
  }
  double* const below = values_.data() + block.value + triangle_room(n);
  for (int i = 0; i < block.below; ++i) {
    for (int k = 0; k < n; ++k) below[(i & ~3) * n + 4 * k + (i & 3)] = from.below(i, k);
  }
}

std::size_t SparseLdlt::bytes() const noexcept {
  return values_.size() * sizeof(double) + rows_.size() * sizeof(int) + blocks_.size() * sizeof(Block);
}

std::size_t SparseLdlt::stored_bytes() const noexcept {
  return bytes() + (block_of_.size() + position_.size()) * sizeof(int) +
         static_cast<std::size_t>(inverse_D_.size()) * sizeof(double);
}

void SparseLdlt::find_path(std::span<const int> unknowns, Path& path) const {
  path.clear(blocks_.size());
  for (int unknown : unknowns) {
    path.add(block_of_[static_cast<std::size_t>(position(unknown))],
             [&](int b) { return blocks_[static_cast<std::size_t>(b)].parent; });
  }
  path.sort();
}

bool SparseLdlt::covers(const Path& path, std::span<const int> unknowns) const {
  return std::all_of(unknowns.begin(), unknowns.end(), [&](int unknown) {
    assert(unknown >= first_ && unknown - first_ < size());
    return path.contains(block_of_[static_cast<std::size_t>(position(unknown))]);
  });
}

void SparseLdlt::into(const Vector& natural, Vector& ordered) const {
  ordered.resize(room());
  for (Eigen::Index i = 0; i < size(); ++i) ordered[position_[static_cast<std::size_t>(i)]] = natural[first_ + i];
  ordered.tail(room() - size()).setZero();
}

void SparseLdlt::into(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const {
  ordered.setZero(room());
  for (int unknown : few) ordered[position(unknown)] = weight * natural[unknown];
}

void SparseLdlt::out_of(const Vector& ordered, Vector& natural) const {
  natural.conservativeResize(std::max(natural.size(), first_ + size()));
  for (Eigen::Index i = 0; i < size(); ++i) natural[first_ + i] = ordered[position_[static_cast<std::size_t>(i)]];
}

void SparseLdlt::load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
                      Vector& ordered) const {
  visit(path, [&](int first, int columns) { ordered.segment(first, columns).setZero(); });
  for (int unknown : few) ordered[position(unknown)] = weight * natural[unknown];
}

void SparseLdlt::read(std::span<const int> few, const Vector& ordered, Vector& natural) const {
  for (int unknown : few) natural[unknown] = ordered[position(unknown)];
}

void SparseLdlt::forward(double* y, const Block& block) const {
  double* const own = y + block.first;
  if (block.columns <= narrow) {
    const NarrowBlock numbers{values_.data() + block.value, rows_.data() + block.rows, block.below};
    with_columns(block.columns, [&]<int n>() { narrow_forward<n>(numbers, own, y); });
    return;
  }
  const int height = in_fours(block.columns + block.below);
  double* const scratch = work_space(y);
  Eigen::Map<Vector>(scratch, height).setZero();
  const double* const value = values_.data() + block.value;
  int k = 0;
  for (; k + 4 <= block.columns; k += 4) add_columns<4>(value + k * height, height, k & ~3, own + k, scratch);
  for (; k < block.columns; ++k) add_columns<1>(value + k * height, height, k & ~3, own + k, scratch);
  std::copy(scratch, scratch + block.columns, own);
  const int* const row = rows_.data() + block.rows;
  const double* const change = scratch + block.columns;
  for (int i = 0; i < block.below; ++i) y[row[i]] -= change[i];
}

void SparseLdlt::backward(const double* y, double* x, const Block& block) const {
  double* const own = x + block.first;
  const double *const inverse_D = inverse_D_.data() + block.first, *const load = y + block.first;
  if (block.columns <= narrow) {
    const NarrowBlock numbers{values_.data() + block.value, rows_.data() + block.rows, block.below};
    with_columns(block.columns, [&]<int n>() { narrow_backward<n>(numbers, inverse_D, load, own, x); });
    return;
  }
  const int height = in_fours(block.columns + block.below);
  const int* const row = rows_.data() + block.rows;
  double* const scratch = work_space(x);
  for (int j = 0; j < block.columns; ++j) scratch[j] = load[j] * inverse_D[j];
  double* const below = scratch + block.columns;
  for (int i = 0; i < block.below; ++i) below[i] = -x[row[i]];
  std::fill(below + block.below, scratch + height, 0.0);
  const double* const value = values_.data() + block.value;
  int k = 0;
  for (; k + 4 <= block.columns; k += 4) products<4>(value + k * height, height, k & ~3, scratch, own + k);
  for (; k < block.columns; ++k) products<1>(value + k * height, height, k & ~3, scratch, own + k);
}

void SparseLdlt::forward(double* y) const {
  for (const Block& block : blocks_) forward(y, block);
}

void SparseLdlt::backward(double* x) const {
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) backward(x, x, *block);
}

void SparseLdlt::forward(Vector& y, const Path& path, const Vector& known) const {
  // Far from its load a solution decays until it is a denormal number, on which a processor is a hundred times slower.
  constexpr double nothing = 1e-40;
  for (int b : path.nodes()) {
    const Block& block = blocks_[static_cast<std::size_t>(b)];
    auto own = y.segment(block.first, block.columns);
    if ((own.cwiseAbs().array() < nothing).all()) {  // false for a NaN, which must reach the solution
      own.setZero();
    } else {
      forward(y.data(), block);
    }
    own += known.segment(block.first, block.columns);  // no block after this one reads them
  }
}

void SparseLdlt::backward(const Vector& y, Vector& x, const Path& path) const {
  for (auto b = path.nodes().rbegin(); b != path.nodes().rend(); ++b) {
    backward(y.data(), x.data(), blocks_[static_cast<std::size_t>(*b)]);
  }
}

void SparseLdlt::backward_off(const Path& path, const Vector& y, Vector& x) const {
  for (std::size_t b = blocks_.size(); b-- > 0;) {
    if (!path.contains(static_cast<int>(b))) backward(y.data(), x.data(), blocks_[b]);
  }
}

Eigen::Map<const Eigen::MatrixXd> SparseLdlt::wide(const Block& block) const {
  return {values_.data() + block.value, in_fours(block.columns + block.below), block.columns};
}

void SparseLdlt::forward(Eigen::MatrixXd& y, const Block& block, Eigen::MatrixXd& scratch) const {
  if (block.columns <= narrow) {
    for (Eigen::Index k = 0; k < y.cols(); ++k) forward(y.col(k).data(), block);
    return;
  }
  auto own = y.middleRows(block.first, block.columns);
  auto change = scratch.topLeftCorner(in_fours(block.columns + block.below), y.cols());
  change.noalias() = wide(block) * own;
  own = change.topRows(block.columns);
  const int* const row = rows_.data() + block.rows;
  for (int i = 0; i < block.below; ++i) y.row(row[i]) -= change.row(block.columns + i);
}

void SparseLdlt::backward(Eigen::MatrixXd& x, const Block& block, Eigen::MatrixXd& scratch) const {
  if (block.columns <= narrow) {
    for (Eigen::Index k = 0; k < x.cols(); ++k) backward(x.col(k).data(), x.col(k).data(), block);
    return;
  }
  auto own = x.middleRows(block.first, block.columns);
  auto known = scratch.topLeftCorner(in_fours(block.columns + block.below), x.cols());
  known.topRows(block.columns) = inverse_D_.segment(block.first, block.columns).asDiagonal() * own;
  const int* const row = rows_.data() + block.rows;
  for (int i = 0; i < block.below; ++i) known.row(block.columns + i) = -x.row(row[i]);
  known.bottomRows(known.rows() - block.columns - block.below).setZero();
  own.noalias() = wide(block).transpose() * known;
}

Eigen::MatrixXd SparseLdlt::solve_columns(const Eigen::MatrixXd& loads) const {
  constexpr Eigen::Index together = 16;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(loads.rows(), loads.cols());
  for (Eigen::Index first = 0; first < loads.cols(); first += together) {
    const Eigen::Index count = std::min(together, loads.cols() - first);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(size() + 1, count), scratch(most_height_, count);
    for (Eigen::Index i = 0; i < size(); ++i) {
      x.row(position_[static_cast<std::size_t>(i)]) = loads.row(first_ + i).segment(first, count);
    }
    for (const Block& block : blocks_) forward(x, block, scratch);
    for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) backward(x, *block, scratch);
    for (Eigen::Index i = 0; i < size(); ++i) {
      result.row(first_ + i).segment(first, count) = x.row(position_[static_cast<std::size_t>(i)]);
    }
  }
  return result;
}

}  // namespace railtab
