#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace railtab {

/// What a row of a finite-element program's matrices is: a node's displacement along (0, 1, 2) or rotation about
/// (3, 4, 5) the x, y, z of the model.
struct FeRow {
  int node = 0;
  int motion = 0;
  long line = 0;  ///< of the file it was read from
};

/// Nodes of a mesh in the model's unit of length and axes, and named sets of them (names in capitals).
struct FeMesh {
  std::map<int, Eigen::Vector3d> nodes;
  std::map<std::string, std::vector<int>> sets;
  std::optional<std::size_t> elements{};  ///< number that an input deck defines; a table has none
  std::string turned{};                   ///< "file:line" of the first *TRANSFORM, axes of nodes; empty: none
};

/// A real sparse matrix in Matrix Market's coordinate format, `general` or `symmetric`; entries of the same place add
/// up (docs/file_formats/structure.md).
/// @throws InputError with file and line: another kind of matrix, an index out of range, a value that is not a finite
///         number, more or fewer entries than the size line says or than the file can hold.
[[nodiscard]] Eigen::SparseMatrix<double> read_matrix_market(const std::filesystem::path& file);

/// CalculiX's `.sti` or `.mas` of *FREQUENCY, SOLVER=MATRIXSTORAGE: lines "row column value" of one triangle, counted
/// from 1; both triangles are returned. Its size is `rows`, the lines of the `.dof`.
/// @throws InputError with file and line
[[nodiscard]] Eigen::SparseMatrix<double> read_calculix_matrix(const std::filesystem::path& file, int rows);

/// Harwell–Boeing, assembled real matrices: RSA (one triangle is stored) and RUA [DuffGrimesLewis1992], as ANSYS's
/// HBMAT writes them. Both triangles are returned; right-hand sides are not read.
/// @throws InputError with file and line
[[nodiscard]] Eigen::SparseMatrix<double> read_harwell_boeing(const std::filesystem::path& file);

/// Rows from CalculiX's `.dof`: one "node.direction" per line, in the order of the rows. Elements that CalculiX expands
/// into solids (beams, shells) give several rows of the same node and direction. @throws InputError with file and line
[[nodiscard]] std::vector<FeRow> read_calculix_rows(const std::filesystem::path& file);

/// Rows from ANSYS's `.mapping`: lines "equation node label", label UX, UY, UZ, ROTX, ROTY or ROTZ; lines that do not
/// begin with a number are headings. Every equation 1, 2, … must be there once. @throws InputError with file and line
[[nodiscard]] std::vector<FeRow> read_ansys_rows(const std::filesystem::path& file);

/// Rows from a table "row,node,motion", motion x, y, z, rotx, roty or rotz in the model's axes; for any other program.
/// Every row 1, 2, … must be there once. @throws InputError with file and line
[[nodiscard]] std::vector<FeRow> read_row_table(const std::filesystem::path& file);

/// Nodes from an input deck of CalculiX or Abaqus (*NODE, *NSET, *INCLUDE; all else is skipped), or from a plain table
/// "node x y z" separated by blanks or commas, as ANSYS's NWRITE writes it (zeros at the end of a line may be missing).
/// @throws InputError with file and line: a node twice, coordinates in another system or moved by *INSTANCE, a rotated
///         nodal coordinate system in a table, a set of unknown nodes
[[nodiscard]] FeMesh read_fe_mesh(const std::filesystem::path& file);

}  // namespace railtab
