#pragma once

#include "railtab/runtime/vehicle/vehicle_import.hpp"
#include "railtab/runtime/vehicle/vehicle_table.hpp"

namespace railtab {

/// All rows of an imported vehicle in railtab's axes and SI units, nothing held.
struct FreeVehicle {
  explicit FreeVehicle(const VehicleImport& files) : import(files) {}
  const VehicleImport& import;  ///< for messages
  Eigen::MatrixXd mass, damping, stiffness;
  std::vector<TableBody> bodies;
  std::vector<int> wheelsets;  ///< indices of bodies, front first
  int car_body = 0;
  Eigen::MatrixXd rigid;  ///< rows × 6: what x, y, z, roll, pitch, yaw about the car body move the rows by

  [[nodiscard]] const TableBody& wheelset(std::size_t w) const {
    return bodies[static_cast<std::size_t>(wheelsets[w])];
  }
};

/// The wheelsets have all six motions, the car body its x; wheelsets stand behind each other, in the track's centre,
/// their axles at one height. @throws InputError
void check_wheelsets(const FreeVehicle& vehicle);

/// The matrices' scales fit a vehicle and each other: vehicle_scales. @throws InputError naming file, row and value
void check_numbers(const FreeVehicle& vehicle);

/// The mass is positive definite. @throws InputError naming file and row
void check_mass(const FreeVehicle& vehicle);

/// Columns of FreeVehicle::rigid: inner degrees of freedom follow the bodies without strain, K_ii r_i = −K_ib r_b.
/// @throws InputError where an inner degree of freedom is not held by springs
[[nodiscard]] Eigen::MatrixXd rigid_motions(const FreeVehicle& vehicle);

/// Rows that no body has.
[[nodiscard]] std::vector<int> inner_rows(const FreeVehicle& vehicle);

/// What a free vehicle is: rigid motions and rotations of wheelsets without resistance, all other motions with; mass
/// the same in all directions. A stiffness that holds that of gravity may resist roll and pitch.
/// @throws InputError naming file and row
void check_free_motions(const FreeVehicle& vehicle, GeometricStiffness geometric);

}  // namespace railtab
