#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// Where one wheel stands on the structure's rail; `on_rail` is false beyond the modelled track, where rails are rigid.
struct RailContact {
  RailSide side = RailSide::left;
  bool on_rail = false;
  int element = 0;  ///< left node of the beam element
  double x = 0.0;   ///< along the track [m]
  RailInterpolation rows{};
  const RailLine* rail = nullptr;  ///< of the structure; set where on_rail is
  OwnCompliance own{};             ///< of the element there
};
[[nodiscard]] RailContact rail_contact(const StructureModel& structure, RailSide side, double x) noexcept;

/// Where both wheels of a wheelset stand, at one x: left, then right.
using RailHeads = std::span<const RailContact, 2>;
/// Those of one wheelset. @param contacts left, right of each wheelset in turn
[[nodiscard]] RailHeads rail_heads(std::span<const RailContact> contacts, int wheelset) noexcept;
/// Appends rail_contact() of both rails at x [m]. What two rails with the same element there have in common is found
/// once.
void append_rail_heads(const StructureModel& structure, double x, std::vector<RailContact>& contacts);

/// Displacement (y, z, roll) of the left, then of the right rail head under one wheelset from unit forces along y and z
/// and unit moments about x on those under another [m/N, rad/N, m/(N m), rad/(N m)].
using RailHeadsCompliance = Eigen::Matrix<double, 6, 6>;

/// element_compliance() of rail head i from loads on rail head j; zero unless both stand on one element.
[[nodiscard]] Eigen::Matrix3d element_compliance(const RailContact& i, const RailContact& j) noexcept;
/// Adds `weight` times that of the rail heads under wheelsets i and j to the blocks of either rail with itself.
void add_element_compliance(RailHeads i, RailHeads j, double weight, RailHeadsCompliance& compliance) noexcept;

/// Append the unknowns that are not held.
void append_free(std::span<const int> from, std::vector<int>& dofs);
/// Append the structure's unknowns that a wheel loads.
void append_dofs(const RailContact& contact, std::vector<int>& dofs);
/// Append the unknowns of the node ahead of a wheel, on which it will soon stand.
void append_dofs_ahead(const RailContact& contact, std::vector<int>& dofs);

/// Places of a node's unknowns in head_dofs(). Of a RailInterpolation's rows y, z and roll only these entries are not
/// zero: y has the node's y and yaw and, times the head's height, what roll has; z its z and pitch; roll its roll and
/// twist rate.
struct HeadDof {
  enum Place : std::size_t { twist, y, z, roll, pitch, yaw, of_node };
};

/// Displacement (y, z, roll) of a rail head from a vector of structure dofs.
[[nodiscard]] Eigen::Vector3d rail_head(const RailContact& contact, const Eigen::VectorXd& dofs) noexcept;
/// Slopes yaw = dy/dx and pitch = -dz/dx of a rail head.
[[nodiscard]] Eigen::Vector2d rail_slopes(const RailContact& contact, const Eigen::VectorXd& dofs) noexcept;
/// Add a rail-head load (y, z, moment about x) to a vector of structure loads: the transpose of rail_head.
void add_rail_load(const RailContact& contact, const Eigen::Vector3d& load, Eigen::VectorXd& loads) noexcept;

}  // namespace railtab
