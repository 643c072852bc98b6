#include "railtab/runtime/algebra/elimination_order.hpp"

#include <metis.h>

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <csignal>
#include <mutex>
#include <new>
#include <numeric>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
static_assert(sizeof(idx_t) == sizeof(int));

std::vector<int> by_minimum_degree(const Sparse& matrix, const DofRange& range) {
  Sparse part = matrix.block(range.begin, range.begin, range.count, range.count);
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(part, order);
  return {order.indices().data(), order.indices().data() + order.indices().size()};
}

/// The graph of nodes: those that share an entry of the matrix are neighbours.
struct NodeGraph {
  std::vector<std::vector<int>> unknowns;        // of every node, counted from the range's first
  std::vector<idx_t> begin{0}, neighbour, size;  // METIS's compressed form; unknowns per node

  NodeGraph(const Sparse& matrix, const DofRange& range, std::span<const int> node) {
    const auto first = static_cast<int>(range.begin), count = static_cast<int>(range.count);
    std::vector<int> vertex(index(count));
    if (node.empty()) {
      for (int i = 0; i < count; ++i) vertex[index(i)] = i;
    } else {
      std::vector<int> of_node(index(1 + *std::max_element(node.begin(), node.end())), -1);
      int vertices = 0;
      for (int i = 0; i < count; ++i) {
        int& known = of_node[index(node[index(first + i)])];
        if (known < 0) known = vertices++;
        vertex[index(i)] = known;
      }
    }
    unknowns.resize(index(count == 0 ? 0 : 1 + *std::max_element(vertex.begin(), vertex.end())));
    for (int i = 0; i < count; ++i) unknowns[index(vertex[index(i)])].push_back(i);
    std::vector<int> seen(unknowns.size(), -1);
    for (int v = 0; v < static_cast<int>(unknowns.size()); ++v) {
      seen[index(v)] = v;
      for (const int j : unknowns[index(v)]) {
        for (Sparse::InnerIterator entry(matrix, first + j); entry; ++entry) {
          const auto i = static_cast<int>(entry.row()) - first;
          if (i < 0 || i >= count) continue;
          const int w = vertex[index(i)];
          if (seen[index(w)] == v) continue;
          seen[index(w)] = v;
          neighbour.push_back(w);
        }
      }
      begin.push_back(static_cast<idx_t>(neighbour.size()));
      size.push_back(static_cast<idx_t>(unknowns[index(v)].size()));
    }
  }
};

/// A SIGTERM to this thread waits. METIS would leave by longjmp from wherever it comes, in the midst of an allocation
/// too, and the heap would be damaged.
class TerminationBlocked {
 public:
  TerminationBlocked() noexcept {
    sigset_t terminate;
    sigemptyset(&terminate);
    sigaddset(&terminate, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &terminate, &before_);
  }
  TerminationBlocked(const TerminationBlocked&) = delete;
  TerminationBlocked& operator=(const TerminationBlocked&) = delete;
  ~TerminationBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

std::vector<int> by_nested_dissection(const Sparse& matrix, const DofRange& range, std::span<const int> node) {
  NodeGraph graph(matrix, range, node);
  auto vertices = static_cast<idx_t>(graph.unknowns.size());
  std::vector<idx_t> order(graph.unknowns.size()), position(graph.unknowns.size());
  std::iota(order.begin(), order.end(), 0);
  if (!graph.neighbour.empty()) {  // METIS wants edges
    std::array<idx_t, METIS_NOPTIONS> options{};
    METIS_SetDefaultOptions(options.data());
    // A node with this many times the neighbours of the mean comes last: that of a long beam element, which all
    // sleepers on the element hang on. Through it everything is near everything, and nothing would cut.
    constexpr idx_t many = 20;
    options[METIS_OPTION_PFACTOR] = 10 * many;
    // METIS has one sequence of random numbers for all threads.
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    const TerminationBlocked until_it_is_done;
    const int status = METIS_NodeND(&vertices, graph.begin.data(), graph.neighbour.data(), graph.size.data(),
                                    options.data(), order.data(), position.data());
    if (status != METIS_OK) throw std::bad_alloc();  // the input is a symmetric graph: memory is all that can lack
  }
  std::vector<int> unknown;
  unknown.reserve(static_cast<std::size_t>(range.count));
  for (const idx_t v : order) {
    unknown.insert(unknown.end(), graph.unknowns[index(v)].begin(), graph.unknowns[index(v)].end());
  }
  return unknown;
}

}  // namespace

std::vector<int> elimination_order(const Sparse& matrix, const DofRange& range, EliminationOrder order,
                                   std::span<const int> node) {
  return order == EliminationOrder::minimum_degree ? by_minimum_degree(matrix, range)
                                                   : by_nested_dissection(matrix, range, node);
}

}  // namespace railtab
