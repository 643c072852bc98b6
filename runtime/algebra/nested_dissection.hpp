#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

namespace railtab {

/// Elimination order of a symmetric sparse pattern by nested dissection [George1973]: the middle level of a
/// breadth-first search from one end cuts the graph in two; each half is cut again, and a cut is eliminated after its
/// halves. Long and narrow structures, such as a track, get an elimination tree of logarithmic height. Unknowns with
/// many times the neighbours of the others come last.
/// @param begin, row compressed columns of the full pattern, n + 1 and begin[n] numbers
/// @return the unknown that is eliminated k-th, for each k
[[nodiscard]] std::vector<int> nested_dissection(std::span<const int> begin, std::span<const int> row);

/// The same as an ordering method of Eigen's simplicial factorisations.
struct NestedDissection {
  using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  template <class Matrix>
  void operator()(const Matrix& full, PermutationType& order) const {
    const auto n = static_cast<std::size_t>(full.outerSize());
    const std::vector<int> k = nested_dissection({full.outerIndexPtr(), n + 1},
                                                 {full.innerIndexPtr(), static_cast<std::size_t>(full.nonZeros())});
    order.resize(full.outerSize());
    for (std::size_t i = 0; i < n; ++i) order.indices()[static_cast<Eigen::Index>(i)] = k[i];
  }
};

}  // namespace railtab
