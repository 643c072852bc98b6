#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {

/// A rigid motion of a structure, or of a part that nothing joins to the rest, which strains nothing.
struct FreeMotion {
  std::string text;     ///< "moves along x", "turns about x (roll) through y = 0 m, z = 1.9 m", perhaps of a part
  std::string held_by;  ///< what would hold it: "x of a support"
};

/// All that are left. Where nodes are expanded, whose rows stand around them, it is not known where, rotations have no
/// name: the node that moves most.
[[nodiscard]] std::vector<FreeMotion> free_motions(const FeStructure& structure);

/// The motion that strains least [largest 1], where that is none but for rounding. Rigid or not, known positions or
/// not, at the cost of a factorisation.
[[nodiscard]] std::optional<Eigen::VectorXd> motion_without_stiffness(const Eigen::SparseMatrix<double>& stiffness);

/// @throws InputError naming the motions that nothing holds and what would hold them
void require_held(const FeStructure& structure);

}  // namespace railtab
