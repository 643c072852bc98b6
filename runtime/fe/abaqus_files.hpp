#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <unordered_map>
#include <vector>

#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

/// What the rows of Abaqus's matrices are. Abaqus writes degrees of freedom that a boundary condition holds as well,
/// with 1e36 on the diagonal of the stiffness; they are left out here.
struct AbaqusRows {
  /// Free ones: of the mesh's nodes, ascending by node and motion, then of Abaqus's own nodes, whose numbers are
  /// negative; with a table of rows in its order.
  std::vector<FeRow> rows;
  /// Place in `rows` by the name that the files use (1000·node + degree of freedom, or the row's number), -1: held.
  std::unordered_map<long, int> place;
  bool numbered = false;  ///< the files name rows by their number: FORMAT=COORDINATE
};

/// @param stiffness file of *MATRIX OUTPUT, STIFFNESS
/// @param dofs table "row,node,motion" for FORMAT=COORDINATE; empty for FORMAT=MATRIX INPUT, whose lines name node and
///             degree of freedom themselves
/// @throws InputError with file and line: another format, a degree of freedom other than 1 to 6, a row that the table
///         does not name
[[nodiscard]] AbaqusRows read_abaqus_rows(const std::filesystem::path& stiffness, const std::filesystem::path& dofs);

/// A matrix of *MATRIX OUTPUT over the free rows. Lines are "node, dof, node, dof, value" (MATRIX INPUT) or "row column
/// value" (COORDINATE); `**` begins a comment. One triangle, which is mirrored, or both, whose mean is taken; entries
/// of one place add up.
/// @throws InputError with file and line: another format, a row that the stiffness does not have, a value that is not a
///         finite number; both triangles that differ by more than 1e-9 of the largest diagonal entry
[[nodiscard]] Eigen::SparseMatrix<double> read_abaqus_matrix(const std::filesystem::path& file, const AbaqusRows& rows);

}  // namespace railtab
