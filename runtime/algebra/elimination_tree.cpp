#include "railtab/runtime/algebra/elimination_tree.hpp"

#include <algorithm>
#include <utility>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// First row below the diagonal of every column of L, -1 where there is none [Davis2006, Sect. 4.1].
std::vector<int> column_parents(const EliminationTree& tree, const Sparse& matrix) {
  std::vector<int> parent(tree.unknown.size(), -1), ancestor(parent);
  for (int k = 0; k < tree.size(); ++k) {
    tree.visit_column(matrix, k, [&](int i, double) {
      while (i != -1 && i < k) {
        const int next = std::exchange(ancestor[index(i)], k);
        if (next == -1) parent[index(i)] = k;
        i = next;
      }
    });
  }
  return parent;
}

/// Columns in an order in which all that hang on a column come right before it.
std::vector<int> postorder(const std::vector<int>& parent) {
  const auto n = static_cast<int>(parent.size());
  std::vector<int> child(parent.size(), -1), sibling(child), order, open;
  order.reserve(parent.size());
  for (int k = n - 1; k >= 0; --k) {
    if (parent[index(k)] < 0) continue;
    sibling[index(k)] = std::exchange(child[index(parent[index(k)])], k);
  }
  for (int root = 0; root < n; ++root) {
    if (parent[index(root)] >= 0) continue;
    open.push_back(root);
    while (!open.empty()) {
      const int k = open.back();
      if (const int next = child[index(k)]; next >= 0) {
        child[index(k)] = sibling[index(next)];
        open.push_back(next);
      } else {
        order.push_back(k);
        open.pop_back();
      }
    }
  }
  return order;
}

void number(EliminationTree& tree) {
  tree.position.resize(tree.unknown.size());
  for (int k = 0; k < tree.size(); ++k) tree.position[index(tree.unknown[index(k)])] = k;
}

/// Puts the unknowns in postorder. @return the parents of the columns in that order
std::vector<int> put_in_postorder(const Sparse& matrix, EliminationTree& tree) {
  const std::vector<int> parent = column_parents(tree, matrix), order = postorder(parent), before = tree.unknown;
  std::vector<int> place(order.size()), reordered(order.size(), -1);
  for (int k = 0; k < tree.size(); ++k) {
    place[index(order[index(k)])] = k;
    tree.unknown[index(k)] = before[index(order[index(k)])];
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (parent[k] >= 0) reordered[index(place[k])] = place[index(parent[k])];
  }
  number(tree);
  return reordered;
}

/// Entries below the diagonal of every column of L: every row's are the columns below it in the tree.
std::vector<int> column_counts(const EliminationTree& tree, const Sparse& matrix, const std::vector<int>& parent) {
  std::vector<int> count(parent.size(), 0), mark(parent.size(), -1);
  for (int k = 0; k < tree.size(); ++k) {
    mark[index(k)] = k;
    tree.visit_column(matrix, k, [&](int i, double) {
      for (; i < k && mark[index(i)] != k; i = parent[index(i)]) {
        mark[index(i)] = k;
        ++count[index(i)];
      }
    });
  }
  return count;
}

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
std::vector<Columns> together(const std::vector<int>& parent, const std::vector<int>& count) {
  std::vector<Columns> blocks;
  for (int j = 0; j < static_cast<int>(parent.size()); ++j) {
    Columns block{j, j + 1, count[index(j)], count[index(j)]};
    while (!blocks.empty()) {
      const Columns& before = blocks.back();
      const int next = parent[index(before.end - 1)];
      const Columns merged{before.begin, block.end, block.below, before.stored + block.stored};
      if (next < 0 || next >= block.end || !worth_merging(merged)) break;
      block = merged;
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

EliminationTree::EliminationTree(const Sparse& matrix, const DofRange& range, std::vector<int> order)
    : range_begin(static_cast<int>(range.begin)), unknown(std::move(order)) {
  number(*this);
  const std::vector<int> column_parent = put_in_postorder(matrix, *this);
  const std::vector<int> count = column_counts(*this, matrix, column_parent);
  for (const int c : count) entries += index(c);
  const std::vector<Columns> found = together(column_parent, count);
  const auto blocks = static_cast<int>(found.size());
  std::vector<int> block_of(unknown.size());
  for (int b = 0; b < blocks; ++b) {
    first.push_back(found[index(b)].begin);
    for (int j = found[index(b)].begin; j < found[index(b)].end; ++j) block_of[index(j)] = b;
  }
  first.push_back(size());

  // A block's rows are those of its columns in the matrix and those of the blocks that hang on it.
  parent.assign(found.size(), -1);
  last_child = sibling = parent;
  std::vector<int> mark(unknown.size(), -1);
  std::size_t stack = 0;
  for (int b = 0; b < blocks; ++b) {
    const std::size_t begin = row.size();
    const auto add = [&](int i) {
      if (i < first[index(b) + 1] || mark[index(i)] == b) return;
      mark[index(i)] = b;
      row.push_back(i);
    };
    for (int j = first[index(b)]; j < first[index(b) + 1]; ++j) {
      visit_column(matrix, j, [&](int i, double) { add(i); });
    }
    for (int c = last_child[index(b)]; c >= 0; c = sibling[index(c)]) {
      for (std::size_t p = row_end[index(c)] - rows(c).size(); p < row_end[index(c)]; ++p) add(row[p]);
      stack -= rows(c).size() * rows(c).size();
    }
    std::sort(row.begin() + static_cast<std::ptrdiff_t>(begin), row.end());
    row_end.push_back(row.size());
    const std::size_t below = row.size() - begin;
    stack += below * below;
    waiting = std::max(waiting, stack);
    largest_front = std::max(largest_front, columns(b) + static_cast<int>(below));
    if (below == 0) continue;
    parent[index(b)] = block_of[index(row[begin])];
    sibling[index(b)] = std::exchange(last_child[index(parent[index(b)])], b);
  }
}

}  // namespace railtab
