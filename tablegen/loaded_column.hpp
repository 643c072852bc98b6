#pragma once

#include <vector>

#include "railtab/tablegen/loaded_contact.hpp"
#include "railtab/tables/loaded_table.hpp"

namespace railtab {

/// The loaded contact at one level of elastic energy, as a table stores it (LoadedTableData).
struct LoadedNode {
  double z = 0.0;                ///< height of the wheelset centre [m]
  double z_w = 0.0;              ///< ∂z/∂w at constant pose otherwise, 5 w⁴/F_z
  double z_y = 0.0;              ///< ∂z/∂y at constant w and reduced roll, −(F_y − climb·M_roll)/F_z
  double force = 0.0;            ///< F_z on the rail [N]
  std::vector<LoadedPart> part;  ///< reduced as in LoadedTableData
};

/// The loaded contact over the levels w_k = k·largest_level/(levels − 1), at one y, roll and yaw. The energy w⁵ is the
/// work of the force F_z from first touch on: that of the discrete solutions, ½ ∫ p h dA, differs from it by up to 0.2
/// % where the normals of wheel and rail differ within the contact, and force and stiffness would not agree.
struct LoadedColumn {
  std::vector<LoadedNode> level;
  long solutions = 0;  ///< of the half-space problem
};

/// Where and how finely a column is solved.
struct LoadedColumnOptions {
  LoadedContactOptions contact;
  int levels = 33;
  double largest_level = 1.8;  ///< [J^(1/5)]
  double climb = 0.0;          ///< as of LoadedTableData
  std::vector<double> cut;     ///< arc lengths on the rail between the parts, increasing [m]
};

/// @param pose its z is not used
/// @throws ComputationError where wheel and rail never meet, or a level is not reached
[[nodiscard]] LoadedColumn loaded_column(const ContactSearch& search, const WheelsetPose& pose,
                                         const LoadedColumnOptions& options);

/// The parts of a solution whose energy is w⁵ [J], reduced as in LoadedTableData; zeros where one does not press.
/// @param cut as of LoadedColumnOptions
[[nodiscard]] std::vector<LoadedPart> loaded_parts(const ContactSearch& search, const LoadedContact& contact,
                                                   const std::vector<double>& cut, double w);

}  // namespace railtab
