#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/base/dof_indices.hpp"
#include "railtab/runtime/base/rail_side.hpp"
#include "railtab/runtime/structure/deck_channels.hpp"

namespace railtab {

/// Bending and torsion of a rail as a beam; all zero: not known, as of imported rails.
struct RailStiffness {
  double EIy = 0.0;             ///< vertical bending [N m²]
  double EIz = 0.0;             ///< lateral bending [N m²]
  double GJ = 0.0;              ///< torsion [N m²]
  double warping_length = 0.0;  ///< √(E I_ω/GJ) [m]
  bool operator==(const RailStiffness&) const = default;
};

/// A rail as a line of beam nodes along x.
struct RailLine {
  std::vector<double> x;        ///< strictly increasing node positions [m]
  std::vector<DofIndices> dof;  ///< of each node
  double head_height = 0.0;     ///< of the rail-head top above the beam axis [m]
  RailStiffness stiffness{};
  /// Dof of the twist's rate d(roll)/dx at each node, with the stiffness; empty: roll is linear between nodes.
  std::vector<int> twist_rate{};
};

/// The dofs of a node that its rail head's motion depends on: the twist's rate, then y, z, roll, pitch, yaw.
[[nodiscard]] DofIndices head_dofs(const RailLine& rail, std::size_t node) noexcept;

/// The same of both nodes of the element after a node.
[[nodiscard]] std::array<int, 12> element_dofs(const RailLine& rail, std::size_t node) noexcept;
/// Whether the elements of two rails after a node are the same but for their dofs. @pre both have the next node
[[nodiscard]] bool same_element(const RailLine& a, const RailLine& b, std::size_t node) noexcept;

/// Rows that give the rail head's motion at a position from the head_dofs() of both nodes of the beam element there
/// (cubic Hermite for bending, torsion_shape() or linear for roll): value = Σ row[k]·a[dof[k]], held dofs skipped. The
/// transpose distributes a load.
struct RailInterpolation {
  std::array<int, 12> dof;
  std::array<double, 12> y, z, roll;  ///< lateral and vertical displacement of the rail head, roll
  std::array<double, 12> yaw, pitch;  ///< slopes dy/dx of row y, and -dz/dx of row z: a wheel at speed V sees V·dy/dx
  std::array<double, 12> bend;        ///< d²z/dx² of row z
};
/// The rail head stands head_height above the axis, r = (0, 0, -h), so that u_head = u + θ × r gives y_head = y +
/// h·roll; the transpose of row y therefore carries a lateral force at the head into the axis with its torsional moment
/// h·F_y. Time as interval_at(); allocation-free.
/// @pre x lies on the rail (contains(rail, x)).
[[nodiscard]] RailInterpolation rail_interpolation(const RailLine& rail, double x) noexcept;
[[nodiscard]] bool contains(const RailLine& rail, double x) noexcept;

/// Displacement (y, z, roll) of the rail head at x from unit loads (lateral and vertical force, moment about x) on the
/// rail head at `loaded` with the nodes of the element held: what rail_interpolation() has not of a load between nodes.
/// With a, b from `loaded` to the element's ends and L = a + b, at the load itself a³b³/(3 EI L³) [Przemieniecki1968]
/// and torsion_compliance(). Zero where the two are not on one element or the stiffness is not known.
/// @pre both lie on the rail
[[nodiscard]] Eigen::Matrix3d element_compliance(const RailLine& rail, double x, double loaded) noexcept;
/// Of a load at the place itself.
struct OwnCompliance {
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();  ///< element_compliance(rail, x, x)
  Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();       ///< its derivative along x
};
/// A place on a rail, and all that a load there needs of its element.
struct RailPlace {
  std::size_t element;     ///< number of its left node
  RailInterpolation rows;  ///< rail_interpolation(rail, x)
  OwnCompliance own;       ///< zero where the stiffness is not known
};
/// @pre x lies on the rail
[[nodiscard]] RailPlace rail_place(const RailLine& rail, double x) noexcept;

/// A node whose motion is asked for by name ("deck-midspan").
struct StructureNode {
  std::string name;
  double x = 0.0;  ///< position along the track [m]
  DofIndices dof;
  /// Right of the track's centre and below the rail-head tops [m]; NaN: not known.
  double y = std::numeric_limits<double>::quiet_NaN(), z = std::numeric_limits<double>::quiet_NaN();
};

/// Where the ground holds a structure. With the dofs u and the supports' translations s, y and z of each in turn,
///   M u'' + C u' + K u = F − (M_s s'' + C_s s' + K_s s),
/// so that K u + K_s s = 0 where all moves alike. Empty: supports are not known, and the ground stands still.
struct StructureSupports {
  using Columns = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  std::vector<double> x{};                 ///< of each support [m]
  Columns mass{}, damping{}, stiffness{};  ///< dofs × 2 per support
  /// Why some supports are known only for ground that moves alike under all, "a structure that …"; empty: all are
  /// known.
  std::string beyond{};
  /// Rows by the rails' dofs × 2 per support. Not empty: the dofs are relative to what the supports carry along,
  /// and the rails' motion is theirs and carried·s (relative_to_supports()).
  Columns carried{};
  /// What the translations add to the motions of the nodes of interest, 6 rows each, and to the channels of the deck;
  /// empty: nothing.
  Columns carried_nodes{}, carried_deck{};
  [[nodiscard]] int columns() const noexcept { return static_cast<int>(2 * x.size()); }
  [[nodiscard]] bool alike_only() const noexcept { return !beyond.empty(); }
};

/// The dofs of a node of a track or beam are on lines (StructureModel::dof_line) from a multiple of this number on: x,
/// y, z, roll, pitch, yaw, twist rate.
inline constexpr int lines_per_node = 7;

/// A linear structure under the train: M a'' + C a' + K a = F, symmetric, K positive definite.
struct StructureModel {
  Eigen::SparseMatrix<double> mass, damping, stiffness;
  std::array<RailLine, 2> rail;      ///< indexed by RailSide
  std::vector<StructureNode> nodes;  ///< nodes of interest
  /// Their motions that are sums of dofs and no dofs, such as rotations fitted to displacements around them, 6 rows
  /// each; empty: none.
  Eigen::SparseMatrix<double, Eigen::RowMajor> summed_nodes{};
  DeckChannels deck{};
  /// Position along the track of every dof [m], not decreasing; empty where it is not known.
  std::vector<double> dof_x;
  /// Dofs of one number are alike and follow each other along x, such as the vertical displacements of a rail's nodes;
  /// -1: alike to no other. Empty where dof_x is.
  std::vector<int> dof_line{};
  /// Node of the mesh that every dof belongs to, for an order of elimination: numbers from 0 on, below that of the
  /// dofs; empty: not known.
  std::vector<int> dof_node{};
  /// Parts that move as wholes, from and to [m]: the spans of a bridge.
  std::vector<std::array<double, 2>> spans;
  StructureSupports supports;
  std::vector<std::string> warnings{};  ///< of an imported structure that is unlike any bridge
  std::vector<std::string> left_out{};  ///< for the plan: what modes lack of the structure that they come from
  [[nodiscard]] int dofs() const noexcept { return static_cast<int>(mass.rows()); }
};

/// A motion of a node of interest under a vector of dofs: its own dof, or what is summed for it.
/// @param motion 0 to 5: x, y, z, roll, pitch, yaw
[[nodiscard]] inline double node_motion(const StructureModel& structure, std::size_t node, std::size_t motion,
                                        const Eigen::VectorXd& dofs) {
  const int dof = structure.nodes[node].dof[motion];
  if (dof != held) return dofs[dof];
  const auto& sums = structure.summed_nodes;
  return sums.size() == 0 ? 0.0 : sums.row(static_cast<Eigen::Index>(6 * node + motion)).dot(dofs);
}

/// A structure as models, their runs and kept factors have it in common; null: none.
using SharedStructure = std::shared_ptr<const StructureModel>;
[[nodiscard]] inline SharedStructure share(StructureModel structure) {
  return std::make_shared<const StructureModel>(std::move(structure));
}

}  // namespace railtab
