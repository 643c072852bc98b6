#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cassert>
#include <string>

#include "railtab/runtime/algebra/nested_dissection.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using LowestTree = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, NestedDissection>;

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

// Neighbouring columns that become one block: every column's structure, less its first row, lies in that of the
// column which this first row names; where that is the next one, both can share their rows.
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

// Blocks in an order in which none waits for the one before it: leaves of the elimination tree first, then what hangs
// on leaves only, and so on.
std::vector<Columns> by_height(const std::vector<Columns>& blocks, const Sparse& L) {
  std::vector<std::size_t> block_of(static_cast<std::size_t>(L.outerSize()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (int j = blocks[b].begin; j < blocks[b].end; ++j) block_of[static_cast<std::size_t>(j)] = b;
  }
  std::vector<int> height(blocks.size(), 0);
  std::vector<std::size_t> order(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    order[b] = b;
    if (blocks[b].below == 0) continue;
    int& parent = height[block_of[static_cast<std::size_t>(L.innerIndexPtr()[L.outerIndexPtr()[blocks[b].end - 1]])]];
    parent = std::max(parent, height[b] + 1);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return height[a] < height[b]; });
  std::vector<Columns> sorted;
  sorted.reserve(blocks.size());
  for (std::size_t b : order) sorted.push_back(blocks[b]);
  return sorted;
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

template <int n>
void narrow_backward(const NarrowBlock& block, double* own, const double* x) noexcept {
  std::array<Four, n> sum;
  sum.fill(Four::Zero());
  const double* column = block.value + triangle_room(n);
  for (int i = 0; i < block.below; i += 4, column += 4 * n) {
    const int* const row = block.row + i;
    const Four part(x[row[0]], x[row[1]], x[row[2]], x[row[3]]);
    for (int k = 0; k < n; ++k) sum[static_cast<std::size_t>(k)] += part * Eigen::Map<const Four>(column + 4 * k);
  }
  std::array<double, n> change;
  for (int k = 0; k < n; ++k) change[static_cast<std::size_t>(k)] = sum[static_cast<std::size_t>(k)].sum();
  const double* t = block.value;
  for (int j = 1; j < n; ++j) {
    for (int k = 0; k < j; ++k) change[static_cast<std::size_t>(k)] -= *t++ * own[j];
  }
  for (int k = 0; k < n; ++k) own[k] -= change[static_cast<std::size_t>(k)];
}

using NarrowForward = void (*)(const NarrowBlock&, double*, double*) noexcept;
using NarrowBackward = void (*)(const NarrowBlock&, double*, const double*) noexcept;
constexpr std::array<NarrowForward, narrow> forward_of{narrow_forward<1>, narrow_forward<2>, narrow_forward<3>,
                                                       narrow_forward<4>, narrow_forward<5>, narrow_forward<6>,
                                                       narrow_forward<7>, narrow_forward<8>};
constexpr std::array<NarrowBackward, narrow> backward_of{narrow_backward<1>, narrow_backward<2>, narrow_backward<3>,
                                                         narrow_backward<4>, narrow_backward<5>, narrow_backward<6>,
                                                         narrow_backward<7>, narrow_backward<8>};

/// sum <- sum + columns · factors, from row `begin` on, above which the columns are zero.
template <int number>
void add_columns(const double* column, int height, int begin, const double* factor, double* sum) {
  for (int i = begin; i < height; i += 4) {
    Four part = Eigen::Map<const Four>(sum + i);
    for (int k = 0; k < number; ++k) part += factor[k] * Eigen::Map<const Four>(column + k * height + i);
    Eigen::Map<Four>(sum + i) = part;
  }
}

/// Numbers and rows of all blocks, see SparseLdlt::store().
struct Room {
  std::size_t values = 0, rows = 0;
};

Room room_of(const std::vector<Columns>& blocks) {
  Room room;
  for (const Columns& columns : blocks) {
    const int n = columns.count(), below = in_fours(columns.below);
    room.rows += static_cast<std::size_t>(below);
    room.values +=
        static_cast<std::size_t>(n > narrow ? in_fours(n + columns.below) * n : triangle_room(n) + below * n);
  }
  return room;
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

SparseLdlt::SparseLdlt(const Sparse& matrix, const DofRange& range, std::string_view message, EliminationOrder order)
    : first_(static_cast<int>(range.begin)) {
  const Sparse& part =
      range.count == matrix.rows() ? matrix : Sparse(matrix.block(range.begin, range.begin, range.count, range.count));
  if (order == EliminationOrder::lowest_tree) {
    factorise<LowestTree>(part, message);
  } else {
    factorise<Eigen::SimplicialLDLT<Sparse>>(part, message);
  }
}

std::size_t SparseLdlt::entries_of_lowest_tree(const Sparse& matrix) {
  struct Symbolic : LowestTree {
    [[nodiscard]] Eigen::Index entries() const { return m_matrix.nonZeros(); }
  };
  Symbolic symbolic;
  symbolic.analyzePattern(matrix);
  return static_cast<std::size_t>(symbolic.entries());
}

template <class Simplicial>
void SparseLdlt::factorise(const Sparse& matrix, std::string_view message) {
  const Simplicial simplicial(matrix);
  if (simplicial.info() != Eigen::Success || !(simplicial.vectorD().minCoeff() > 0.0)) {
    throw ComputationError(std::string(message));
  }
  inverse_D_ = simplicial.vectorD().cwiseInverse();
  const auto& order = simplicial.permutationP().indices();
  position_.assign(order.data(), order.data() + order.size());
  const Sparse& L = simplicial.matrixL().nestedExpression();  // below the diagonal, compressed, rows ascending
  assert(L.isCompressed());
  entries_ = static_cast<std::size_t>(L.nonZeros());

  const std::vector<Columns> found = by_height(supernodes(L), L);
  const Room room = room_of(found);  // growing by themselves, vectors are there twice
  values_.reserve(room.values);
  rows_.reserve(room.rows);
  blocks_.reserve(found.size());
  block_of_.resize(position_.size());
  for (const Columns& columns : found) {
    Block block{columns.begin, columns.count(), columns.below, static_cast<int>(rows_.size()), values_.size(), -1};
    const int last = columns.end - 1;
    const int* const begin = L.innerIndexPtr() + L.outerIndexPtr()[last];
    rows_.insert(rows_.end(), begin, begin + columns.below);
    // The triangle's inverse in its place, and the rows below times that: substituting in a block is a product with
    // no column waiting for another.
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(block.columns + block.below, block.columns);
    for (int j = columns.begin; j < columns.end; ++j) {
      int place = 0;
      for (Sparse::InnerIterator entry(L, j); entry; ++entry) {
        const int row = static_cast<int>(entry.row());
        if (row < columns.end) {
          dense(row - columns.begin, j - columns.begin) = entry.value();
          continue;
        }
        while (rows_[static_cast<std::size_t>(block.rows + place)] != row) ++place;
        dense(block.columns + place, j - columns.begin) = entry.value();
      }
      block_of_[static_cast<std::size_t>(j)] = static_cast<int>(blocks_.size());
    }
    const Eigen::MatrixXd inverse = dense.topRows(block.columns)
                                        .triangularView<Eigen::UnitLower>()
                                        .solve(Eigen::MatrixXd::Identity(block.columns, block.columns));
    dense.topRows(block.columns) = inverse;
    dense.bottomRows(block.below) = (dense.bottomRows(block.below) * inverse).eval();
    store(dense, block);
    rows_.resize(static_cast<std::size_t>(block.rows + in_fours(block.below)), static_cast<int>(position_.size()));
    blocks_.push_back(block);
  }
  for (Block& block : blocks_) {
    if (block.below > 0) {
      block.parent = block_of_[static_cast<std::size_t>(rows_[static_cast<std::size_t>(block.rows)])];
    }
  }
}

// The block's numbers as its substitution reads them.
void SparseLdlt::store(const Eigen::MatrixXd& dense, const Block& block) {
  const int n = block.columns;
  const auto append = [&](int room) {
    values_.resize(values_.size() + static_cast<std::size_t>(room), 0.0);
    return values_.data() + values_.size() - room;
  };
  if (n > narrow) {
    const int height = in_fours(n + block.below);
    most_height_ = std::max(most_height_, height);
    Eigen::Map<Eigen::MatrixXd>(append(height * n), height, n).topRows(dense.rows()) = dense;
    return;
  }
  double* triangle = append(triangle_room(n));
  for (int j = 1; j < n; ++j) {
    for (int k = 0; k < j; ++k) *triangle++ = dense(j, k);
  }
  double* const below = append(in_fours(block.below) * n);
  for (int i = 0; i < block.below; ++i) {
    for (int k = 0; k < n; ++k) below[(i & ~3) * n + 4 * k + (i & 3)] = dense(n + i, k);
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

void SparseLdlt::into(const Vector& natural, Vector& ordered) const {
  ordered.resize(room());
  for (Eigen::Index i = 0; i < size(); ++i) ordered[position_[static_cast<std::size_t>(i)]] = natural[first_ + i];
  ordered[size()] = 0.0;
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

void SparseLdlt::add(const Path& path, const Vector& known, Vector& y) const {
  visit(path, [&](int first, int columns) { y.segment(first, columns) += known.segment(first, columns); });
}

void SparseLdlt::read(std::span<const int> few, const Vector& ordered, Vector& natural) const {
  for (int unknown : few) natural[unknown] = ordered[position(unknown)];
}

void SparseLdlt::forward(double* y, const Block& block, double* scratch) const {
  double* const own = y + block.first;
  if (block.columns <= narrow) {
    forward_of[static_cast<std::size_t>(block.columns - 1)](
        {values_.data() + block.value, rows_.data() + block.rows, block.below}, own, y);
    return;
  }
  const int height = in_fours(block.columns + block.below);
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

void SparseLdlt::backward(double* x, const Block& block, double* scratch) const {
  double* const own = x + block.first;
  if (block.columns <= narrow) {
    backward_of[static_cast<std::size_t>(block.columns - 1)](
        {values_.data() + block.value, rows_.data() + block.rows, block.below}, own, x);
    return;
  }
  const int height = in_fours(block.columns + block.below);
  const int* const row = rows_.data() + block.rows;
  std::copy(own, own + block.columns, scratch);
  double* const below = scratch + block.columns;
  for (int i = 0; i < block.below; ++i) below[i] = -x[row[i]];
  std::fill(below + block.below, scratch + height, 0.0);
  const double* const value = values_.data() + block.value;
  int k = 0;
  for (; k + 4 <= block.columns; k += 4) products<4>(value + k * height, height, k & ~3, scratch, own + k);
  for (; k < block.columns; ++k) products<1>(value + k * height, height, k & ~3, scratch, own + k);
}

void SparseLdlt::backward(const Vector& y, Vector& x, const Block& block, double* scratch) const {
  for (int j = block.first; j < block.first + block.columns; ++j) x[j] = y[j] * inverse_D_[j];
  backward(x.data(), block, scratch);
}

void SparseLdlt::forward(double* y) const {
  Vector scratch(most_height_);
  for (const Block& block : blocks_) forward(y, block, scratch.data());
}

void SparseLdlt::backward(double* x) const {
  Vector scratch(most_height_);
  Eigen::Map<Vector>(x, size()).array() *= inverse_D_.array();
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) backward(x, *block, scratch.data());
}

void SparseLdlt::forward(Vector& y, const Path& path) const {
  // Far from its load a solution decays until it is a denormal number, on which a processor is a hundred times slower.
  constexpr double nothing = 1e-40;
  Vector scratch(most_height_);
  for (int b : path.nodes()) {
    const Block& block = blocks_[static_cast<std::size_t>(b)];
    auto own = y.segment(block.first, block.columns);
    if ((own.cwiseAbs().array() < nothing).all()) {  // false for a NaN, which must reach the solution
      own.setZero();
    } else {
      forward(y.data(), block, scratch.data());
    }
  }
}

void SparseLdlt::backward(const Vector& y, Vector& x, const Path& path) const {
  Vector scratch(most_height_);
  for (auto b = path.nodes().rbegin(); b != path.nodes().rend(); ++b) {
    backward(y, x, blocks_[static_cast<std::size_t>(*b)], scratch.data());
  }
}

void SparseLdlt::backward_off(const Path& path, const Vector& y, Vector& x) const {
  Vector scratch(most_height_);
  for (std::size_t b = blocks_.size(); b-- > 0;) {
    if (!path.contains(static_cast<int>(b))) backward(y, x, blocks_[b], scratch.data());
  }
}

}  // namespace railtab
