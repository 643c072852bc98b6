#pragma once

#include <functional>
#include <string>

#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// What a wheelset of rotational inertia Jy [kg m²] about its axle adds by rolling: gyroscopic moments at a rotation of
/// 1 rad/s, and the load of a rotation that changes with the train's speed.
/// @param wheelset index of its body; matrices and acceleration_load have their sizes
void add_rolling(VehicleModel& vehicle, std::size_t wheelset, double Jy);

/// Adds what joins bodies a and b to a matrix of the vehicle's dofs; held ones are left out.
void add_pair_matrix(Eigen::MatrixXd& matrix, const DofIndices& a, const DofIndices& b, const PairMatrix& pair);

/// Whether a body is one of the vehicle's wheelsets.
[[nodiscard]] bool is_wheelset(const VehicleModel& vehicle, int body) noexcept;

/// Name of a body for messages, with the number of its vehicle where the model is a train: "car-body of vehicle 2".
[[nodiscard]] std::string body_text(const VehicleModel& vehicle, int body);

/// body_text() of the body that a row moves, for messages; "an inner degree of freedom" where it is of none.
[[nodiscard]] std::string body_of(const VehicleModel& vehicle, int row);

/// Of a unit between two bodies that have moved [m]. @param displacement all dofs
[[nodiscard]] Eigen::Vector3d elongation(const VehicleModel& vehicle, const Suspension& unit,
                                         const Eigen::VectorXd& displacement);

/// A vehicle at rest under its weight, its wheelsets held in z and roll; all dofs × cases of weight.
struct StandingVehicle {
  Eigen::MatrixXd reaction;      ///< of the wheelsets' z [N] and roll [N m], zero elsewhere
  Eigen::MatrixXd displacement;  ///< [m], [rad]
};

/// @param weight all dofs × cases [N]; the stiffness is decomposed once for all of them
/// @throws InputError where a weight is not carried by the wheelsets through springs
[[nodiscard]] StandingVehicle standing(const VehicleModel& vehicle, const Eigen::MatrixXd& weight);

/// Every wheelset of a vehicle with weight must carry some of it, and no rail can pull down a wheel: the contacts count
/// as standard gauge has them. @param place of a wheelset, for messages
/// @throws InputError
void check_wheel_loads(const VehicleModel& vehicle, const std::function<std::string(std::size_t wheelset)>& place);

}  // namespace railtab
