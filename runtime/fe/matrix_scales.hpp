#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace railtab {

/// What the numbers of imported matrices may be, in SI units: kg and kg m², N/m and N m/rad, N s/m and N m s/rad. Wide
/// of everything that is built, and narrow enough that no sum or product of theirs loses all its digits.
struct MatrixScales {
  double largest_mass, largest_damping, largest_stiffness;  ///< amounts of entries
  double largest_ratio = 1e20;                              ///< of a stiffness on the diagonal to the least one there
  /// sqrt(k/m)/(2π) of single rows [Hz]: the lowest natural frequency is below all of them, the highest above.
  double lowest_frequency, highest_frequency;
  double massless = 0.0;  ///< share of the largest mass that is rounding of none
};
/// The heaviest bridges have 1e9 kg, penalty stiffnesses reach 1e20 N/m, the longest suspension bridges swing at 0.04
/// Hz. Light rotations on penalties are the fastest rows.
inline constexpr MatrixScales structure_scales{.largest_mass = 1e15,
                                               .largest_damping = 1e25,
                                               .largest_stiffness = 1e25,
                                               .lowest_frequency = 1e-3,
                                               .highest_frequency = 1e12,
                                               .massless = 1e-20};
/// A row of a free vehicle may have no spring at all, the rotation of a wheelset.
inline constexpr MatrixScales vehicle_scales{.largest_mass = 1e9,
                                             .largest_damping = 1e15,
                                             .largest_stiffness = 1e18,
                                             .largest_ratio = std::numeric_limits<double>::infinity(),
                                             .lowest_frequency = 0.0,
                                             .highest_frequency = 1e9};

/// A matrix and the file that it comes from.
struct FileMatrix {
  const Eigen::SparseMatrix<double>& matrix;
  const std::filesystem::path& file;
};

/// Holds the scales of mass, damping (may be 0 × 0) and stiffness against each other and against `scales`, before any
/// algorithm meets them.
/// @param row_text  a row for messages, from 0: "row 3 (node 7, railtab's z)"
/// @throws InputError naming file, row, value and the permitted range
void check_scales(const FileMatrix& mass, const FileMatrix& damping, const FileMatrix& stiffness,
                  const MatrixScales& scales, const std::function<std::string(Eigen::Index row)>& row_text);

/// |a_ij| <= sqrt(a_ii a_jj), as in any positive semidefinite matrix, but for what writing with few digits leaves.
/// @throws InputError naming file, row, column and values
void check_off_diagonals(const FileMatrix& matrix, std::string_view name,
                         const std::function<std::string(Eigen::Index row)>& row_text);

}  // namespace railtab
