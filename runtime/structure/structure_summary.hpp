#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/structure/modal_bridge.hpp"

namespace railtab {

/// What to compare with the program that a structure comes from, or with a drawing.
struct StructureSummary {
  long dofs = 0, nodes = 0;
  Eigen::Vector3d low, high;        ///< corners around all nodes, railtab's axes [m]
  Eigen::Vector3d mass;             ///< that moves with x, y, z alike: without what is held [kg]
  std::vector<std::string> free;    ///< rigid motions that nothing resists: "moves along x", "turns about x (roll) …"
  std::vector<double> frequencies;  ///< lowest natural frequencies [Hz]; none where a rigid motion is free
  std::vector<double> damping_ratios;  ///< at each of them, φᵀCφ/(2ω); of equal ones rising
};

/// An imported structure without railtab's track. Where a node is expanded, whose rows stand around it, it is not known
/// where, a free rotation has no name but the node that moves most. @pre modes >= 0
[[nodiscard]] StructureSummary summarise(const FeStructure& structure, const FeDamping& damping, int modes);

/// A structure by modes: its moving mass is not known (NaN), and `modes` of its frequencies, lowest first, are given.
[[nodiscard]] StructureSummary summarise(const ModalStructure& structure, int modes);

/// Built-in spans without their track; the mass is that of their whole length. @pre modes >= 0
[[nodiscard]] StructureSummary summarise(const std::vector<BridgeParameters>& spans, int modes);

}  // namespace railtab
