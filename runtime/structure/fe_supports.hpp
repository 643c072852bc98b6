#pragma once

#include <functional>
#include <string>
#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"
#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// The role of the rows of M, C and K: degrees of freedom, motions at rest, or columns of supports (numbers from 0).
class RowSplit {
 public:
  static constexpr int dof = -1, resting = -2;
  explicit RowSplit(std::vector<int> column_of_row);

  /// Removes the rows and columns of what is no degree of freedom from a symmetric matrix; returns what the supports'
  /// translations have on the degrees of freedom, `columns` wide.
  StructureSupports::Columns split(Eigen::SparseMatrix<double>& matrix, int columns) const;
  /// New number of a row; held where it is no degree of freedom.
  [[nodiscard]] int operator[](int row) const { return number_[static_cast<std::size_t>(row)]; }
  [[nodiscard]] int dofs() const noexcept { return dofs_; }

 private:
  std::vector<int> column_, number_;
  int dofs_ = 0;
};

/// Takes the motions out of a structure that supports hold; FeStructure::supports has what they do to the rest.
/// @throws InputError naming the [[support]]: no such node, nothing to hold, a node in two of them
[[nodiscard]] FeStructure on_supports(FeStructure structure, const std::vector<FeSupport>& supports);

/// Unit translation of all degrees of freedom along y (first column) and z.
[[nodiscard]] Eigen::MatrixXd translations(const FeStructure& structure);

/// M, C and K of the degrees of freedom.
struct FeMatrices {
  const Eigen::SparseMatrix<double>&mass, &damping, &stiffness;
};
/// What a message calls a row.
using RowName = std::function<std::string(Eigen::Index)>;

/// Completes supports that have K_s, M_s and C_s as the matrices know them:
/// - damping in proportion to the mass, which would brake a structure that moves with its ground, acts on the motion
///   relative to what the supports carry along: C_s −= a (M_s + M ι), a fitted to what of C resists a translation;
/// - what resists a translation of structure and supports stands on supports whose rows are missing. They become one
///   more, K_s = −(K r + K_s 1) and C_s likewise, known only for ground that moves alike. Their M_s is left out.
///
/// Where supports are declared, a resistance is what holds a y or z of the structure back by more than 1e-4 of a
/// translation of all supports at rest, |K⁻¹ (K r + K_s 1)| = |r − ι 1|, or by more than 1e-6 m while they move at
/// 1 m/s, |K⁻¹ (C r + C_s 1)|. Less is taken for the rounding with which the matrices were written: single rows cannot
/// tell, for an entry that is zero but for rounding adds up with others like it to nothing but rounding.
/// @param translation r, dofs × 2 @throws ComputationError where K is not positive definite
void settle_supports(const FeMatrices& matrices, const Eigen::MatrixXd& translation, const RowName& name,
                     StructureSupports& supports);

/// Lets nodes that carry the track move with the ground where they have no row of y or z: with the [[support]] that
/// holds them, else with the missing supports.
void stand_on_ground(const std::vector<int>& nodes, FeStructure& structure, StructureSupports& supports);

}  // namespace railtab
