#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// Entries of M, C and K of a structure under assembly; entries of the same place add up.
struct MatrixAssembly {
  std::vector<Eigen::Triplet<double>> mass, damping, stiffness;
};

/// Adds a dense element matrix; held dofs and zero entries are left out.
template <size_t N>
void add_element(std::vector<Eigen::Triplet<double>>& entries, const std::array<int, N>& dof,
                 const Eigen::Matrix<double, static_cast<int>(N), static_cast<int>(N)>& element) {
  for (size_t i = 0; i < N; ++i) {
    if (dof[i] == held) continue;
    for (size_t j = 0; j < N; ++j) {
      const double value = element(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (dof[j] != held && value != 0.0) entries.emplace_back(dof[i], dof[j], value);
    }
  }
}

/// The dofs of two nodes as those of one element.
inline std::array<int, 12> joined(const DofIndices& a, const DofIndices& b) noexcept {
  return {a[0], a[1], a[2], a[3], a[4], a[5], b[0], b[1], b[2], b[3], b[4], b[5]};
}

/// Sets the model's three matrices, dofs × dofs.
inline void build_matrices(const MatrixAssembly& assembly, int dofs, StructureModel& model) {
  model.mass.resize(dofs, dofs);
  model.damping.resize(dofs, dofs);
  model.stiffness.resize(dofs, dofs);
  model.mass.setFromTriplets(assembly.mass.begin(), assembly.mass.end());
  model.damping.setFromTriplets(assembly.damping.begin(), assembly.damping.end());
  model.stiffness.setFromTriplets(assembly.stiffness.begin(), assembly.stiffness.end());
}

}  // namespace railtab
