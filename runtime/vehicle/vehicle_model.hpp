#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "railtab/runtime/base/dof_indices.hpp"
#include "railtab/runtime/vehicle/force_element.hpp"

namespace railtab {

/// A rigid body; position of its centre of gravity in the vehicle frame: x forward from the vehicle centre, y right,
/// z down from the rail-head tops [m].
struct RigidBody {
  std::string name;
  double mass;               ///< [kg]
  Eigen::Vector3d inertia;   ///< about x, y, z through the centre of gravity [kg m²]
  Eigen::Vector3d position;  ///< [m]
  int coach = 0;             ///< of a train that is described as one vehicle, front first
};

/// What the weight of a vehicle that leans adds to its stiffness: the couples of preloaded springs whose ends have
/// moved apart and the loads' own heights (preload_matrix). Omitted for comparison with models that have none; matrices
/// of an imported vehicle may hold it.
enum class GeometricStiffness { included, omitted, in_matrices };

inline constexpr double standard_gravity = 9.81;  ///< [m/s²]

/// How the weight acts on a vehicle.
struct VehicleWeight {
  double gravity = standard_gravity;  ///< normal to the track [m/s²]
  GeometricStiffness geometric_stiffness = GeometricStiffness::included;
};

/// Spring-damper between two bodies at one point of the nominal position.
struct Suspension {
  int body_a, body_b;                                              ///< indices
  Eigen::Vector3d point;                                           ///< vehicle frame [m]
  Eigen::Vector3d stiffness;                                       ///< along x, y, z [N/m]
  Eigen::Vector3d damping;                                         ///< [N s/m]
  Eigen::Vector3d rotational_stiffness = Eigen::Vector3d::Zero();  ///< about x, y, z [N m/rad]
  /// Part of body b, 0..1, in the couple that the unit's preload exerts where its ends have moved apart: half for a
  /// coil spring that shears. About the axle of a wheelset the other body takes the whole couple.
  double couple_share = 0.5;
  /// In series with the damper along x, y, z [N/m]; 0: the damper alone.
  Eigen::Vector3d series_stiffness = Eigen::Vector3d::Zero();
  std::string name{};                        ///< of its force elements in messages
  std::array<NonlinearUnit, 3> nonlinear{};  ///< along x, y, z
  Friction yaw_friction{};                   ///< about z [N m]
};

/// A body of a vehicle as results and loads know it; position of the point whose motion its dofs are, vehicle frame.
struct VehicleBody {
  std::string name;
  Eigen::Vector3d position;  ///< [m]
  int coach = 0;             ///< 0 … VehicleModel::coaches − 1
};

/// A vehicle, or a train that is one system, at constant speed (the car body's x is held). Small displacements from its
/// own static equilibrium: gravity acts as the static axle loads and as geometric stiffness. The matrices have all that
/// is linear. Rows that no body has are inner degrees of freedom (flexible bodies, springs in series with dampers).
struct VehicleModel {
  std::string name;
  std::vector<VehicleBody> bodies;
  std::vector<DofIndices> dof;               ///< per body
  std::vector<int> wheelsets;                ///< bodies that are wheelsets, front first
  std::vector<double> wheel_radius;          ///< nominal radius R0 of each wheelset's wheels [m]
  double length = 26.4;                      ///< over couplers: distance to the next vehicle of the same kind [m]
  Eigen::MatrixXd mass, damping, stiffness;  ///< dofs × dofs
  /// Velocity matrix of wheelsets that roll forward, ω_y = -V/R0 (z being down), per running speed V [kg m];
  /// antisymmetric. Damping of the running vehicle: damping + V·gyroscopic.
  Eigen::MatrixXd gyroscopic;
  double gravity = standard_gravity;  ///< under which it stands, normal to the track [m/s²]
  Eigen::VectorXd static_load;  ///< load that balances the contact forces at rest: static axle loads on wheelset z [N]
  /// Load per acceleration of the train, of masses that are described in its frame, −m [kg], and of wheelsets whose
  /// nominal rotation changes with the speed, J_y/R0 [kg m].
  Eigen::VectorXd acceleration_load;
  Eigen::VectorXd lateral_load;         ///< per lateral acceleration of the track to the left, +m to the right [kg]
  Eigen::VectorXd lateral_shift;        ///< what the dofs are when the whole vehicle has gone 1 m to the right
  double top_speed = 0.0;               ///< that its data state [m/s]; 0: none
  int coaches = 1;                      ///< of a train that is one system: with joints, or of unlike vehicles
  ForceElements elements{};             ///< that are not linear, besides the matrices
  std::vector<std::string> nonlinear;   ///< those elements, a sentence for each kind of unit
  std::vector<std::string> linearised;  ///< force elements that run by a linear stand-in, a sentence for each
  std::vector<std::string> left_out;    ///< force elements of its data that the model has not

  [[nodiscard]] int dofs() const noexcept { return static_cast<int>(mass.rows()); }
};

/// A vehicle by its parts.
struct VehicleDescription {
  std::string name;
  std::vector<RigidBody> bodies;
  std::vector<Suspension> suspension;
  std::vector<int> wheelsets;  ///< bodies that are wheelsets, front first
  /// Per body; an entry `held` holds that dof, any other value frees it; empty: all are free.
  std::vector<DofIndices> held_dofs;
  double nominal_radius = 0.46;  ///< R0 of the wheels [m]
  double length = 26.4;          ///< over couplers [m]
  int coaches = 1;               ///< whose bodies these are (RigidBody::coach)
  VehicleWeight weight{};
  ForceElementChoice force_elements = ForceElementChoice::nonlinear;
  std::vector<double> wheel_radius{};  ///< R0 of each wheelset's wheels, where they differ; else empty [m]
};

/// Assemble matrices from bodies and suspension (B^T k B with B the kinematics of the attachment points, and the
/// geometric stiffness of what the units carry under gravity).
/// Dofs are numbered body by body. Static load: the reactions of the wheelsets' z and roll under gravity, so that zero
/// displacement is the equilibrium on a rigid level track; z parts [N] add up to the weight, roll parts [N m] vanish on
/// a vehicle that is loaded symmetrically.
/// @throws InputError where a mass or inertia is not positive, an index is out of range, the suspension does not carry
/// a body's weight, or a wheel would have to be pulled down
[[nodiscard]] VehicleModel assemble_vehicle(const VehicleDescription& parts);

}  // namespace railtab
