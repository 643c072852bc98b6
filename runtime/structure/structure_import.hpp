#pragma once

#include <filesystem>

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// Files of a structure from a finite-element program.
struct StructureFiles {
  std::filesystem::path mass, damping, stiffness;  ///< Matrix Market, in SI units, of the same size
  std::filesystem::path dofs;                      ///< table of the dofs on the rails and of those to be reported
};

/// Structure from imported matrices. The table says which rows are dofs of rail nodes and of nodes of interest, and in
/// which sense of railtab's axes they count; rows that it does not name are internal. Rail nodes are at the rail-head
/// tops. Nodes that it calls supports are held by the ground. Matrices must be symmetric (1e-9 of the largest diagonal
/// entry); the mean of both halves is taken.
/// @throws InputError with file and line, or file with row and column
[[nodiscard]] StructureModel import_structure(const StructureFiles& files);

}  // namespace railtab
