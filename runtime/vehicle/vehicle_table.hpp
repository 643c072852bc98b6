#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// A body of a model's table, and which rows of the matrices are its motions.
struct TableBody {
  std::string name;
  std::string place;                                   ///< "file:line" of its first line
  Eigen::Vector3d position;                            ///< in the axes and unit of the table
  DofIndices row{held, held, held, held, held, held};  ///< along and about the axes of the table; held: none
};

/// Bodies in the order of a table "row,body,motion,x,y,z", motion x, y, z, rotx, roty or rotz. Rows of the matrices
/// that it does not name belong to no body.
/// @param rows of the matrices
/// @throws InputError with file and line: a row out of range or named twice, an unknown motion or one twice, a position
///         that is not finite or differs from the body's first line
[[nodiscard]] std::vector<TableBody> read_vehicle_table(const std::filesystem::path& file, int rows);

}  // namespace railtab
