#include "railtab/runtime/structure/carried_motion.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Columns = StructureSupports::Columns;

constexpr double relative_rounding = 1e-12;

/// A ι + A_s, without what is zero but for rounding.
Columns relative(const Sparse& matrix, const Sparse& carried, const Columns& of_supports) {
  Sparse sum = matrix * carried;
  sum += Sparse(of_supports);
  sum.prune(matrix.diagonal().cwiseAbs().maxCoeff(), relative_rounding);
  return sum;
}

/// Rows of the nodes of interest, 6 each, besides those that are fitted.
Columns node_rows(const std::vector<StructureNode>& nodes, const Columns& carried) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (nodes[n].dof[k] == held) continue;
      for (Columns::InnerIterator entry(carried, nodes[n].dof[k]); entry; ++entry) {
        entries.emplace_back(static_cast<int>(6 * n + k), static_cast<int>(entry.col()), entry.value());
      }
    }
  }
  Columns rows(static_cast<Eigen::Index>(6 * nodes.size()), carried.cols());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

}  // namespace

// Some columns at a time. A support under one sleeper carries a few metres of track: what is zero but for rounding is
// not kept.
Sparse carried_by_supports(const SparseLdlt& factor, const Columns& of_supports) {
  constexpr Eigen::Index at_a_time = 16;
  const Sparse columns = of_supports;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index first = 0; first < columns.cols(); first += at_a_time) {
    const Eigen::Index count = std::min(at_a_time, columns.cols() - first);
    const Eigen::MatrixXd answer = factor.solve_columns(columns.middleCols(first, count));
    for (Eigen::Index j = 0; j < count; ++j) {
      const double least = relative_rounding * answer.col(j).cwiseAbs().maxCoeff();
      for (Eigen::Index i = 0; i < answer.rows(); ++i) {
        if (std::abs(answer(i, j)) <= least) continue;
        entries.emplace_back(static_cast<int>(i), static_cast<int>(first + j), -answer(i, j));
      }
    }
  }
  Sparse result(columns.rows(), columns.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Sparse carried_by_supports(const Sparse& stiffness, const Columns& of_supports) {
  return carried_by_supports(stiffness_factor(stiffness), of_supports);
}

StructureModel relative_to_supports(StructureModel structure) {
  StructureSupports& s = structure.supports;
  assert(s.columns() > 0 && s.carried.size() == 0);
  const Sparse carried = carried_by_supports(structure.stiffness, s.stiffness);
  s.mass = relative(structure.mass, carried, s.mass);
  s.damping = relative(structure.damping, carried, s.damping);
  s.stiffness = Columns(structure.dofs(), s.columns());
  s.carried = carried;
  const auto add = [](const Columns& more, Columns& rows) { rows = rows.size() > 0 ? Columns(rows + more) : more; };
  add(node_rows(structure.nodes, s.carried), s.carried_nodes);
  if (structure.summed_nodes.size() > 0) add(structure.summed_nodes * s.carried, s.carried_nodes);
  if (structure.deck.rows.size() > 0) add(structure.deck.rows * s.carried, s.carried_deck);
  return structure;
}

StructureSupports gathered(const StructureSupports& supports, const Sparse& shares, std::vector<double> x) {
  StructureSupports result;
  result.x = std::move(x);
  result.beyond = supports.beyond;
  result.mass = supports.mass * shares;
  result.damping = supports.damping * shares;
  result.stiffness = supports.stiffness * shares;
  if (supports.carried_nodes.size() > 0) result.carried_nodes = supports.carried_nodes * shares;
  if (supports.carried_deck.size() > 0) result.carried_deck = supports.carried_deck * shares;
  return result;
}

}  // namespace railtab
