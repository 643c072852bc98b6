#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "railtab/runtime/structure/modal_bridge.hpp"

namespace railtab {

/// The lowest modes of an imported structure at its deck's nodes, with its static flexibility at softest_node().
/// Only motions that the structure has get shapes: solids have no rotations. The modes end before the first whose
/// damping ratio is above most_damping_ratio, since files of modes hold no such mode.
/// @throws InputError where there is no deck, the structure is not held or its first mode is damped more than that;
/// ComputationError as lowest_modes()
[[nodiscard]] ModalStructure modes_at_deck(const ImportParameters& parameters, int modes);

/// The same of built-in spans at the nodes of their axes. Where two spans meet, the node that ends the first stands a
/// millimetre before that which begins the second, since a deck has one node at one place.
[[nodiscard]] ModalStructure modes_at_deck(const std::vector<BridgeParameters>& spans, int modes);

/// The files that structure.format = "modes" reads, in m, N, kg and railtab's axes: PREFIX.modes.csv, .shapes.csv,
/// .nodes.csv and .flexibility.csv, each whole or not at all. @return the section of a scene that names them
/// @throws InputError where one of them is another's file
std::string write_modes(const ModalStructure& structure, const std::filesystem::path& prefix);

}  // namespace railtab
