#include "railtab/runtime/vsi/step_matrices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

namespace {

using Sparse = StepMatrices::Sparse;

void require_finite(const Sparse& matrix, std::string_view name) {
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry) {
      if (!std::isfinite(entry.value())) {
        throw input_error(
            fmt::format("{} matrix of the structure, row {}, column {}", name, entry.row() + 1, column + 1),
            fmt::format("{}", entry.value()), "a finite number");
      }
    }
  }
}

Sparse effective(const HhtScheme& scheme, const Sparse& M, const Sparse& C, const Sparse& K, const DofRange& range) {
  if (range.count == K.cols()) return effective_matrix(scheme, M, C, K);
  const auto columns = [&](const Sparse& matrix) { return matrix.middleCols(range.begin, range.count); };
  const Sparse sum = scheme.acceleration_rate() * columns(M) +
                     scheme.load_weight() * (scheme.velocity_rate() * columns(C) + columns(K));
  // Of its rows those in the range, in a matrix of the whole's size.
  Sparse result(K.rows(), K.cols());
  result.reserve(sum.nonZeros());
  for (Eigen::Index j = 0; j < K.cols(); ++j) {
    result.startVec(j);
    if (j < range.begin || j >= range.end()) continue;
    for (Sparse::InnerIterator entry(sum, j - range.begin); entry; ++entry) {
      if (entry.row() >= range.begin && entry.row() < range.end()) result.insertBack(entry.row(), j) = entry.value();
    }
  }
  result.finalize();
  return result;
}

// The unknowns of both rails at one node.
MirrorPairs rail_pairs(const StructureModel& structure) {
  MirrorPairs pairs;
  const auto& [left, right] = structure.rail;
  const auto join = [&](int l, int r) {
    if (l != held && r != held) pairs.push_back({std::min(l, r), std::max(l, r)});
  };
  for (std::size_t i = 0; i < std::min(left.dof.size(), right.dof.size()); ++i) {
    for (std::size_t k = 0; k < 6; ++k) join(left.dof[i][k], right.dof[i][k]);
    if (!left.twist_rate.empty() && !right.twist_rate.empty()) join(left.twist_rate[i], right.twist_rate[i]);
  }
  return pairs;
}

// Whether a symmetric structure carries both rails: its effective matrix then does not couple the symmetric
// combinations of the rails (sums of z and pitch, differences of y, roll, yaw and the twist's rate) with the others.
bool rails_mirror_each_other(const StructureModel& structure, const MirrorPairs& pairs, const Sparse& effective) {
  const auto& [left, right] = structure.rail;
  if (pairs.empty() || left.x.size() != right.x.size()) return false;
  for (std::size_t node = 0; node + 1 < left.x.size(); ++node) {
    if (!same_element(left, right, node)) return false;
  }
  enum : char { unknown, symmetric, antisymmetric };
  std::vector<char> kind(static_cast<std::size_t>(effective.rows()), unknown);
  std::vector<int> reached;
  for (std::size_t node = 0; node < left.x.size(); ++node) {
    const DofIndices l = head_dofs(left, node), r = head_dofs(right, node);
    for (std::size_t k = 0; k < l.size(); ++k) {
      if ((l[k] == held) != (r[k] == held)) return false;
      if (l[k] == held) continue;
      const bool even = k == 2 || k == 4;  // z, pitch
      const auto [sum, difference] = std::minmax(l[k], r[k]);
      reached.push_back(even ? sum : difference);
      kind[static_cast<std::size_t>(reached.back())] = symmetric;
      kind[static_cast<std::size_t>(even ? difference : sum)] = antisymmetric;
    }
  }
  while (!reached.empty()) {
    const int column = reached.back();
    reached.pop_back();
    for (Sparse::InnerIterator entry(effective, column); entry; ++entry) {
      char& other = kind[static_cast<std::size_t>(entry.row())];
      if (other == antisymmetric) return false;
      if (other == unknown) reached.push_back(static_cast<int>(entry.row()));
      other = symmetric;
    }
  }
  return true;
}

}  // namespace

void require_finite(const StructureModel& structure) {
  require_finite(structure.mass, "mass");
  require_finite(structure.damping, "damping");
  require_finite(structure.stiffness, "stiffness");
}

Sparse effective_matrix(const StructureModel& structure, const HhtScheme& scheme, const DofRange& range) {
  return effective(scheme, structure.mass, structure.damping, structure.stiffness, range);
}

StepMatrices::StepMatrices(SharedStructure shared, bool all_active)
    : structure_(std::move(shared)), all_active_(all_active) {
  const StructureModel& structure = *structure_;
  require_finite(structure);
  const auto& line = structure.dof_line;
  if (line.empty() || (all_active && std::find(line.begin(), line.end(), -1) != line.end())) {
    product_ = PairedProduct(structure.stiffness, structure.damping);
    return;
  }
  places_ = {structure.dof_x, line};
  pairs_ = rail_pairs(structure);
  const auto divide = [&] {
    mass_ = by_sums_and_differences(structure.mass, pairs_);
    damping_ = by_sums_and_differences(structure.damping, pairs_);
    stiffness_ = by_sums_and_differences(structure.stiffness, pairs_);
  };
  divide();
  const auto entries = [](const auto&... matrix) { return (matrix.nonZeros() + ...); };
  if (entries(mass_, damping_, stiffness_) >= entries(structure.mass, structure.damping, structure.stiffness)) {
    pairs_.clear();
    divide();
  }
  rails_mirror_ = rails_mirror_each_other(structure, pairs_, mass_ + damping_ + stiffness_);
}

Sparse StepMatrices::divided(const HhtScheme& scheme, const DofRange& range) const {
  return effective(scheme, mass_, damping_, stiffness_, range);
}

std::size_t StepMatrices::bytes() const noexcept {
  std::size_t sum = product_.bytes() + pairs_.size() * sizeof(pairs_[0]) + places_.x.size() * sizeof(double) +
                    places_.line.size() * sizeof(int);
  for (const Sparse* matrix : {&mass_, &damping_, &stiffness_}) {
    sum += static_cast<std::size_t>(matrix->nonZeros()) * (sizeof(double) + sizeof(int)) +
           static_cast<std::size_t>(matrix->cols()) * sizeof(int);
  }
  return sum;
}

}  // namespace railtab
