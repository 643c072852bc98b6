#pragma once

#include <functional>
#include <optional>

#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {

using DeckFunction = std::function<std::optional<DeckAttachment>(double x, double y, double z)>;

/// Attachments to the nodes of a deck. Nodes that all stand on one line along x are a beam: its axis between two nodes
/// follows Hermite's cubics where both have rotations, else the straight line between them without roll. All other
/// decks are a surface: at (x, y) the three displacements are fitted by weighted least squares, linear in x and y, over
/// the nodes within a radius [LancasterSalkauskas1981], which reproduces every rigid motion; the rotations are the
/// slopes of the fit. Positions before the first node or from the last one on have no attachment.
/// @throws InputError: two nodes of a beam at one place, a node expanded and partly held; when called: no deck around a
/// position, or more than one layer of nodes
[[nodiscard]] DeckFunction deck_function(const FeStructure& structure, const std::vector<int>& nodes);

}  // namespace railtab
