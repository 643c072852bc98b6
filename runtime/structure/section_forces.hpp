#pragma once

#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {

/// Bending moments, then shear forces, in sections across a structure, by its rows [N m, N]; no elements are known. A
/// section at x parts the nodes into those before it and those behind. What those behind exert on those before is, with
/// Λ = 1 for rows before the section, 0 behind it, and 1/2 in its plane (the mean of just before and just behind),
///   S = Rᵀ (K Λ − Λ K) u.
/// R is the unit motion of all rows along z (shear force), or their rotation about the lateral axis at x and
/// `axis_depth` (moment, sagging positive). Only entries of K between both sides remain, those of the elements that the
/// section cuts; of these R meets no force. So S is exact, without damping, and is not changed by supports elsewhere.
/// @param structure with the rows of its supports where the matrices have them
/// @param x positions along the track [m] @param axis_depth below the rail-head tops [m]
/// @throws InputError naming structure.sections: a position beside the structure or where nothing joins both sides;
/// elements there that lack rows (of constraints) or have a prestress; a beam or shell that the program expanded into
/// solids, whose rows' places are not known
[[nodiscard]] std::vector<DeckRow> section_forces(const FeStructure& structure, std::vector<double> x,
                                                  double axis_depth);

}  // namespace railtab
