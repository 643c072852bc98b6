#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {

/// Entries of M, C and K of a structure under assembly; entries of the same place add up.
struct MatrixAssembly {
  std::vector<Eigen::Triplet<double>> mass, damping, stiffness;
};

/// Adds a dense element matrix, as many rows as dofs; held dofs and zero entries are left out.
template <class Element>
void add_element(std::vector<Eigen::Triplet<double>>& entries, std::span<const int> dof, const Element& element) {
  for (size_t i = 0; i < dof.size(); ++i) {
    if (dof[i] == held) continue;
    for (size_t j = 0; j < dof.size(); ++j) {
      const double value = element(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (dof[j] != held && value != 0.0) entries.emplace_back(dof[i], dof[j], value);
    }
  }
}

/// The dofs of two nodes as those of one element.
inline std::array<int, 12> joined(const DofIndices& a, const DofIndices& b) noexcept {
  return {a[0], a[1], a[2], a[3], a[4], a[5], b[0], b[1], b[2], b[3], b[4], b[5]};
}

/// Adds an element with this damping.
template <class Element>
void add_element(MatrixAssembly& assembly, std::span<const int> dof, const Element& mass, const Element& stiffness,
                 const RayleighDamping& damping) {
  add_element(assembly.mass, dof, mass);
  add_element(assembly.stiffness, dof, stiffness);
  add_element(assembly.damping, dof, Element(damping.mass_factor * mass + damping.stiffness_factor * stiffness));
}

/// Adds a line of beam elements between neighbouring nodes.
inline void add_beam(MatrixAssembly& assembly, const std::vector<double>& x, const std::vector<DofIndices>& dof,
                     const BeamSection& section, const RayleighDamping& damping) {
  for (size_t e = 0; e + 1 < x.size(); ++e) {
    const double length = x[e + 1] - x[e];
    add_element(assembly, joined(dof[e], dof[e + 1]), beam_mass(section, length), beam_stiffness(section, length),
                damping);
  }
}

/// Number that stands for a column of the supports' translations among the dofs of an assembly, and back.
[[nodiscard]] constexpr int support_dof(int column) noexcept { return -2 - column; }
[[nodiscard]] constexpr int support_column(int dof) noexcept { return -2 - dof; }

/// Splits the entries of one matrix into those between degrees of freedom and those that the supports' translations
/// have on them.
inline void split_matrix(const std::vector<Eigen::Triplet<double>>& entries, int dofs, int support_columns,
                         Eigen::SparseMatrix<double>& matrix, StructureSupports::Columns& of_supports) {
  std::vector<Eigen::Triplet<double>> inner, outer;
  inner.reserve(entries.size());
  for (const Eigen::Triplet<double>& e : entries) {
    if (e.row() < 0) continue;  // what holds the support
    if (e.col() >= 0) {
      inner.push_back(e);
    } else {
      outer.emplace_back(e.row(), support_column(e.col()), e.value());
    }
  }
  matrix.resize(dofs, dofs);
  matrix.setFromTriplets(inner.begin(), inner.end());
  of_supports.resize(dofs, support_columns);
  of_supports.setFromTriplets(outer.begin(), outer.end());
}

/// Sets the model's three matrices, dofs × dofs, and those of its supports, whose x are given.
inline void build_matrices(const MatrixAssembly& assembly, int dofs, StructureModel& model) {
  StructureSupports& s = model.supports;
  split_matrix(assembly.mass, dofs, s.columns(), model.mass, s.mass);
  split_matrix(assembly.damping, dofs, s.columns(), model.damping, s.damping);
  split_matrix(assembly.stiffness, dofs, s.columns(), model.stiffness, s.stiffness);
}

/// Sums of degrees of freedom as the rows of two matrices, of the dofs and of the supports.
class SumRows {
 public:
  void set(int row, const DofSum& sum) {
    for (const auto& [dof, value] : sum) {
      if (dof >= 0) {
        inner_.emplace_back(row, dof, value);
      } else {
        outer_.emplace_back(row, support_column(dof), value);
      }
    }
  }
  void build(Eigen::Index rows, const StructureModel& model, StructureSupports::Columns& of_dofs,
             StructureSupports::Columns& of_supports) const {
    of_dofs.resize(rows, model.dofs());
    of_dofs.setFromTriplets(inner_.begin(), inner_.end());
    if (outer_.empty()) return;
    of_supports.resize(rows, model.supports.columns());
    of_supports.setFromTriplets(outer_.begin(), outer_.end());
  }

 private:
  std::vector<Eigen::Triplet<double>> inner_, outer_;
};

/// The channels of a model whose matrices and supports are there.
inline void set_channels(const std::vector<DeckRow>& deck, StructureModel& model) {
  if (deck.empty()) return;
  SumRows rows;
  for (std::size_t c = 0; c < deck.size(); ++c) {
    rows.set(static_cast<int>(c), deck[c].sum);
    model.deck.channel.push_back(deck[c].at);
  }
  rows.build(static_cast<Eigen::Index>(deck.size()), model, model.deck.rows, model.supports.carried_deck);
}

}  // namespace railtab
