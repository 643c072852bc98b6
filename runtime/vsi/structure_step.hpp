#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {

/// A load on a rail head: y, z [N] and moment about x [N m], as add_rail_load() takes it.
struct RailLoad {
  RailContact place;
  Eigen::Vector3d load = Eigen::Vector3d::Zero();
};

/// Buffers of advance_structure(), reused; the next step needs nothing that is in them.
struct StructureStepWorkspace {
  StructureSolution solution;
  std::vector<int> rail_dofs, past_rail_dofs;
  Eigen::VectorXd load, response;
};

/// Static equilibrium of a structure under loads on its rails: displacement K⁻¹f, no rates.
/// @throws as StructureResponse(structure)
[[nodiscard]] StructureMotion rest_under(const StructureModel& structure, std::span<const RailLoad> loads);

/// One HHT step (Eqs. 12, 13) of track and bridges alone, whose rails bear given loads at the end of the step: the
/// structure's part of advance() under ContactForceRule::endpoint, without a train and ground motion. Loads beyond the
/// modelled track have no effect.
/// @param response of the structure, all degrees of freedom active; its scheme is the step's
/// @param motion at the beginning of the step with the loads there (`contact_load`); is replaced by that at its end
void advance_structure(const StructureResponse& response, std::span<const RailLoad> loads, StructureMotion& motion,
                       StructureStepWorkspace& workspace);

}  // namespace railtab
