#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "railtab/runtime/algebra/multifrontal.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// A narrow block's numbers in the order in which its substitution reads them: the strict triangle row by row, then the
/// rows below. A block by itself has both filled up to fours, and of the rows four of every column at a time; of blocks
/// side by side each number stands beside those of the others.
struct NarrowBlock {
  const double* value;
  const int* row;
  int below;
};

namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Rows are taken four at a time; what lacks to a multiple of four is stored as zeros in a row that nobody reads.
int in_fours(int rows) { return (rows + 3) & ~3; }

using Four = Eigen::Array4d;

// Blocks of up to this many columns, nearly all, are substituted in with their part of the vector in registers.
constexpr int narrow = 8;

// Where the rows below a narrow block's triangle begin.
constexpr int triangle_room(int columns) { return (columns * (columns - 1) / 2 + 3) & ~3; }

template <int n>
void forward_narrow(const NarrowBlock& block, double* own, double* y) noexcept {
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
void backward_narrow(const NarrowBlock& block, const double* inverse_D, const double* y, double* own,
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

// The rows `row` of a vector.
template <int count>
SideBySide<count> gathered(const double* x, const int* row) noexcept {
  using V = SideBySide<count>;
  V at;
  for (int r = 0; r < V::registers; ++r, row += V::width) {
    // Number by number into an array, a register would have to wait for the memory.
    if constexpr (V::width == 8) {
      at.part[r] =
          typename V::Register{x[row[0]], x[row[1]], x[row[2]], x[row[3]], x[row[4]], x[row[5]], x[row[6]], x[row[7]]};
    } else if constexpr (V::width == 4) {
      at.part[r] = typename V::Register{x[row[0]], x[row[1]], x[row[2]], x[row[3]]};
    } else {
      at.part[r] = typename V::Register{x[row[0]], x[row[1]]};
    }
  }
  return at;
}

template <int count>
SideBySide<count> loaded(const double* from) noexcept {
  SideBySide<count> numbers;
  std::memcpy(&numbers, from, sizeof numbers);
  return numbers;
}

// Which of the blocks side by side are meant: a bit for each. Every bit stands for the group, of whatever size.
constexpr unsigned whole_group = ~0U;
constexpr unsigned bit(int lane) noexcept { return 1U << static_cast<unsigned>(lane); }

template <int count>
bool is_whole(unsigned which) noexcept {
  constexpr unsigned every = bit(count) - 1;
  return (which & every) == every;
}

template <int count>
void set(const SideBySide<count>& numbers, unsigned which, double* to) noexcept {
  if (is_whole<count>(which)) {
    std::memcpy(to, &numbers, sizeof numbers);
    return;
  }
  for (int b = 0; b < count; ++b) {
    if ((which & bit(b)) != 0) to[b] = numbers[b];
  }
}

/// Of `count` blocks with n columns each side by side: numbers, rows and columns of the first, those of the others
/// beside them. @param which blocks are meant; to the bit, they are computed as with the others
template <int n, int count>
void forward_side_by_side(const NarrowBlock& block, unsigned which, double* own, double* y) noexcept {
  SideBySide<count> old[n];
  for (int k = 0; k < n; ++k) old[k] = loaded<count>(own + count * k);
  const double* value = block.value;
  for (int j = 1; j < n; ++j) {
    SideBySide<count> sum = old[j];
    for (int k = 0; k < j; ++k, value += count) sum += loaded<count>(value) * old[k];
    set(sum, which, own + count * j);
  }
  const int* row = block.row;
  for (int i = 0; i < block.below; ++i, row += count) {
    SideBySide<count> change = loaded<count>(value) * old[0];
    value += count;
    for (int k = 1; k < n; ++k, value += count) change += loaded<count>(value) * old[k];
    for (int b = 0; b < count; ++b) {  // several blocks may have the same row
      if ((which & bit(b)) != 0) y[row[b]] -= change[b];
    }
  }
}

template <int n, int count>
void backward_side_by_side(const NarrowBlock& block, unsigned which, const double* inverse_D, const double* y,
                           double* own, const double* x) noexcept {
  SideBySide<count> known[n], solved[n];
  for (int k = 0; k < n; ++k) {
    solved[k] = known[k] = loaded<count>(y + count * k) * loaded<count>(inverse_D + count * k);
  }
  const double* value = block.value + count * (n * (n - 1) / 2);
  const int* row = block.row;
  for (int i = 0; i < block.below; ++i, row += count) {
    const SideBySide<count> part = gathered<count>(x, row);
    for (int k = 0; k < n; ++k, value += count) solved[k] -= loaded<count>(value) * part;
  }
  value = block.value;
  for (int j = 1; j < n; ++j) {
    for (int k = 0; k < j; ++k, value += count) solved[k] += loaded<count>(value) * known[j];
  }
  for (int k = 0; k < n; ++k) set(solved[k], which, own + count * k);
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
std::size_t numbers_of(int columns, int below, int together) {
  if (together > 1) return index(columns * (columns - 1) / 2 + below * columns);
  return index(columns > narrow ? in_fours(columns + below) * columns
                                : triangle_room(columns) + in_fours(below) * columns);
}

// Row numbers that a block stores.
int rows_of(int below, int together) { return together > 1 ? below : in_fours(below); }

/// Blocks in the order in which they are substituted in.
struct Sequence {
  std::vector<int> block;
  std::vector<int> together;  ///< of each of them: how many it is taken side by side with
};

// Leaves of the elimination tree first, then what hangs on leaves only, and so on: blocks of one height do not wait for
// each other. Of these, equal ones follow each other, narrow ones in eights and fours side by side.
Sequence by_height(const EliminationTree& tree) {
  std::vector<int> height(tree.parent.size(), 0);
  Sequence sequence{std::vector<int>(tree.parent.size()), {}};
  std::vector<int>& order = sequence.block;
  std::iota(order.begin(), order.end(), 0);
  for (const int b : order) {
    if (tree.parent[index(b)] < 0) continue;
    int& parent = height[index(tree.parent[index(b)])];
    parent = std::max(parent, height[index(b)] + 1);
  }
  const auto key = [&](int b) { return std::tuple(height[index(b)], tree.columns(b), tree.rows(b).size()); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](int b) { return key(b) != key(*first); });
    for (auto left = last - first; left > 0;) {
      const int together = tree.columns(*first) > narrow || left < 4 ? 1 : left < 8 ? 4 : 8;
      sequence.together.insert(sequence.together.end(), index(together), together);
      left -= together;
    }
    first = last;
  }
  return sequence;
}

/// Numbers of rows and values.
struct Room {
  std::size_t rows = 0, values = 0;
};

/// Calls visitor(at, room) for the first of blocks side by side: its place in the sequence, and where rows and values
/// of them all begin. @return what is needed for all
template <class Visitor>
Room assign_room(const EliminationTree& tree, const Sequence& sequence, Visitor&& visitor) {
  Room room;
  for (std::size_t at = 0; at < sequence.block.size(); at += index(sequence.together[at])) {
    const int together = sequence.together[at], columns = tree.columns(sequence.block[at]);
    const auto below = static_cast<int>(tree.rows(sequence.block[at]).size());
    if (together > 1) room.values = (room.values + 7) & ~std::size_t{7};  // to a line of the cache
    visitor(at, std::as_const(room));
    room.rows += index(together * rows_of(below, together));
    room.values += index(together) * numbers_of(columns, below, together);
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
  const auto [rows, values] = assign_room(tree, by_height(tree), [](std::size_t, const Room&) {});
  const std::size_t n = tree.unknown.size(), blocks = tree.parent.size(), nonzeros = matrix.nonZeros();
  Memory memory{.stored = blocks * sizeof(Block) + n * (2 * sizeof(int) + sizeof(double)) + rows * sizeof(int) +
                          values * sizeof(double),
                .entries = tree.entries};
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
  const Sequence sequence = by_height(tree);
  std::vector<int> place_of(index(n)), stored_at(tree.parent.size());  // of a column, of a block of the tree
  blocks_.resize(tree.parent.size());
  block_of_.resize(index(n));
  int next = 0;
  // Eights begin at lines of the cache, fours at their halves: where a group begins is a multiple of its size (lane()).
  for (const int together : {8, 4, 1}) {
    for (std::size_t at = 0; at < blocks_.size(); at += index(sequence.together[at])) {
      if (sequence.together[at] != together) continue;
      assert(next % together == 0);
      const int columns = tree.columns(sequence.block[at]);
      for (int k = 0; k < together; ++k) {
        const std::size_t stored = at + index(k);
        const int b = sequence.block[stored];
        blocks_[stored] = {next + k, columns, static_cast<int>(tree.rows(b).size()), 0, 0, -1, together};
        stored_at[index(b)] = static_cast<int>(stored);
        for (int j = 0; j < columns; ++j) {
          const int place = blocks_[stored].column(j);
          place_of[index(tree.first[index(b)] + j)] = place;
          block_of_[index(place)] = static_cast<int>(stored);
        }
      }
      next += together * columns;
    }
  }
  position_ = tree.position;
  for (int& position : position_) position = place_of[index(position)];
  const Room room = assign_room(tree, sequence, [&](std::size_t at, const Room& begin) {
    for (int k = 0; k < sequence.together[at]; ++k) {
      blocks_[at + index(k)].rows = static_cast<int>(begin.rows) + k;
      blocks_[at + index(k)].value = begin.values + index(k);
    }
  });
  rows_.assign(room.rows, n);
  values_.setZero(static_cast<Eigen::Index>(room.values));
  inverse_D_.resize(n);
  for (std::size_t at = 0; at < blocks_.size(); ++at) {
    Block& block = blocks_[at];
    int* row = rows_.data() + block.rows;
    for (const int below : tree.rows(sequence.block[at])) {
      *row = place_of[index(below)];
      row += block.together;
    }
    if (block.below > 0) block.parent = block_of_[index(rows_[index(block.rows)])];
    if (block.columns > narrow) most_height_ = std::max(most_height_, in_fours(block.columns + block.below));
  }
  return stored_at;
}

// The block's numbers as its substitution reads them.
void SparseLdlt::store(const Block& block, const EliminatedBlock& from) {
  const int n = block.columns;
  for (int j = 0; j < n; ++j) inverse_D_[block.column(j)] = 1.0 / from.D[j];
  double* to = values_.data() + block.value;
  if (n > narrow) {
    Eigen::Map<Eigen::MatrixXd> dense(to, in_fours(n + block.below), n);
    dense.topRows(n) = from.inverse;
    dense.middleRows(n, block.below) = from.below;
    return;
  }
  for (int j = 1; j < n; ++j) {
    for (int k = 0; k < j; ++k, to += block.together) *to = from.inverse(j, k);
  }
  if (block.together > 1) {
    for (int i = 0; i < block.below; ++i) {
      for (int k = 0; k < n; ++k, to += block.together) *to = from.below(i, k);
    }
    return;
  }
  double* const below = values_.data() + block.value + triangle_room(n);
  for (int i = 0; i < block.below; ++i) {
    for (int k = 0; k < n; ++k) below[(i & ~3) * n + 4 * k + (i & 3)] = from.below(i, k);
  }
}

std::size_t SparseLdlt::bytes() const noexcept {
  return static_cast<std::size_t>(values_.size()) * sizeof(double) + rows_.size() * sizeof(int) +
         blocks_.size() * sizeof(Block);
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
  for (const int b : path.nodes()) {
    const Block& block = blocks_[index(b)];
    for (int j = 0; j < block.columns; ++j) ordered[block.column(j)] = 0.0;
  }
  for (int unknown : few) ordered[position(unknown)] = weight * natural[unknown];
}

void SparseLdlt::read(std::span<const int> few, const Vector& ordered, Vector& natural) const {
  for (int unknown : few) natural[unknown] = ordered[position(unknown)];
}

NarrowBlock SparseLdlt::narrow_block(const Block& block) const noexcept {
  return {values_.data() + block.value, rows_.data() + block.rows, block.below};
}

void SparseLdlt::forward(double* y, const Block& block) const {
  double* const own = y + block.first;
  if (block.columns <= narrow) {
    const NarrowBlock numbers = narrow_block(block);
    return with_columns(block.columns, [&]<int n>() { forward_narrow<n>(numbers, own, y); });
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
    const NarrowBlock numbers = narrow_block(block);
    return with_columns(block.columns, [&]<int n>() { backward_narrow<n>(numbers, inverse_D, load, own, x); });
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

void SparseLdlt::forward_group(double* y, std::size_t first, unsigned which) const {
  const Block& block = blocks_[first];
  if (block.together == 1) return forward(y, block);
  const NarrowBlock numbers = narrow_block(block);
  double* const own = y + block.first;
  with_columns(block.columns, [&]<int n>() {
    block.together == 8 ? forward_side_by_side<n, 8>(numbers, which, own, y)
                        : forward_side_by_side<n, 4>(numbers, which, own, y);
  });
}

void SparseLdlt::backward_group(const double* y, double* x, std::size_t first, unsigned which) const {
  const Block& block = blocks_[first];
  if (block.together == 1) return backward(y, x, block);
  const NarrowBlock numbers = narrow_block(block);
  const double *const inverse_D = inverse_D_.data() + block.first, *const load = y + block.first;
  double* const own = x + block.first;
  with_columns(block.columns, [&]<int n>() {
    block.together == 8 ? backward_side_by_side<n, 8>(numbers, which, inverse_D, load, own, x)
                        : backward_side_by_side<n, 4>(numbers, which, inverse_D, load, own, x);
  });
}

void SparseLdlt::forward(double* y) const {
  visit_groups([&](std::size_t group) { forward_group(y, group, whole_group); });
}

void SparseLdlt::backward(double* x) const {
  visit_groups_from_last([&](std::size_t group) { backward_group(x, x, group, whole_group); });
}

void SparseLdlt::forward(Vector& y, const Path& path, const Vector& known) const {
  // Far from its load a solution decays until it is a denormal number, on which a processor is a hundred times slower.
  constexpr double nothing = 1e-40;
  const std::span<const int> nodes = path.nodes();
  for (std::size_t next = 0; next < nodes.size();) {
    const std::size_t group = first_of_group(nodes[next]), end = group + index(blocks_[group].together), from = next;
    unsigned alive = 0;
    for (; next < nodes.size() && index(nodes[next]) < end; ++next) {
      const Block& block = blocks_[index(nodes[next])];
      bool fades = true;  // not for a NaN, which must reach the solution
      for (int j = 0; j < block.columns; ++j) fades = fades && std::abs(y[block.column(j)]) < nothing;
      if (!fades) alive |= bit(block.lane());
      for (int j = 0; fades && j < block.columns; ++j) y[block.column(j)] = 0.0;
    }
    if (alive != 0) forward_group(y.data(), group, alive);
    for (std::size_t k = from; k < next; ++k) {  // no block after these reads them
      const Block& block = blocks_[index(nodes[k])];
      for (int j = 0; j < block.columns; ++j) y[block.column(j)] += known[block.column(j)];
    }
  }
}

void SparseLdlt::backward(const Vector& y, Vector& x, const Path& path) const {
  const std::span<const int> nodes = path.nodes();
  for (std::size_t end = nodes.size(); end > 0;) {
    const std::size_t group = first_of_group(nodes[end - 1]);
    unsigned which = 0;
    for (; end > 0 && index(nodes[end - 1]) >= group; --end) which |= bit(blocks_[index(nodes[end - 1])].lane());
    backward_group(y.data(), x.data(), group, which);
  }
}

void SparseLdlt::backward_off(const Path& path, const Vector& y, Vector& x) const {
  visit_groups_from_last([&](std::size_t group) {
    unsigned off = 0;
    for (int k = 0; k < blocks_[group].together; ++k) {
      if (!path.contains(static_cast<int>(group) + k)) off |= bit(k);
    }
    if (off != 0) backward_group(y.data(), x.data(), group, off);
  });
}

Eigen::Map<const Eigen::MatrixXd> SparseLdlt::wide(const Block& block) const {
  return {values_.data() + block.value, in_fours(block.columns + block.below), block.columns};
}

void SparseLdlt::forward(Eigen::MatrixXd& y, std::size_t first, Eigen::MatrixXd& scratch) const {
  const Block& block = blocks_[first];
  if (block.columns <= narrow) {
    for (Eigen::Index k = 0; k < y.cols(); ++k) forward_group(y.col(k).data(), first, whole_group);
    return;
  }
  auto own = y.middleRows(block.first, block.columns);
  auto change = scratch.topLeftCorner(in_fours(block.columns + block.below), y.cols());
  change.noalias() = wide(block) * own;
  own = change.topRows(block.columns);
  const int* const row = rows_.data() + block.rows;
  for (int i = 0; i < block.below; ++i) y.row(row[i]) -= change.row(block.columns + i);
}

void SparseLdlt::backward(Eigen::MatrixXd& x, std::size_t first, Eigen::MatrixXd& scratch) const {
  const Block& block = blocks_[first];
  if (block.columns <= narrow) {
    for (Eigen::Index k = 0; k < x.cols(); ++k) backward_group(x.col(k).data(), x.col(k).data(), first, whole_group);
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
  constexpr Eigen::Index at_once = 16;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(loads.rows(), loads.cols());
  for (Eigen::Index first = 0; first < loads.cols(); first += at_once) {
    const Eigen::Index count = std::min(at_once, loads.cols() - first);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(size() + 1, count), scratch(most_height_, count);
    for (Eigen::Index i = 0; i < size(); ++i) {
      x.row(position_[static_cast<std::size_t>(i)]) = loads.row(first_ + i).segment(first, count);
    }
    visit_groups([&](std::size_t group) { forward(x, group, scratch); });
    visit_groups_from_last([&](std::size_t group) { backward(x, group, scratch); });
    for (Eigen::Index i = 0; i < size(); ++i) {
      result.row(first_ + i).segment(first, count) = x.row(position_[static_cast<std::size_t>(i)]);
    }
  }
  return result;
}

}  // namespace railtab
