#pragma once

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/fe/fe_files.hpp"
#include "railtab/runtime/fe/fe_frame.hpp"
#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// Which program's files these are.
enum class FeFormat { matrix_market, calculix, ansys, abaqus, modes };

/// Files of a finite-element model. `dofs` says what the rows are (not needed where FeFormat::abaqus names nodes in
/// each line), `nodes` where the nodes stand. With FeFormat::modes natural modes take the place of matrices and rows.
struct FeFiles {
  FeFormat format = FeFormat::matrix_market;
  std::filesystem::path mass, stiffness;
  std::filesystem::path damping;  ///< empty: none
  std::filesystem::path dofs, nodes;
  std::filesystem::path modes{}, shapes{};  ///< table of the modes, and their shapes at nodes
  std::filesystem::path flexibility{};      ///< of the whole structure at nodes; empty: not known
  [[nodiscard]] bool given() const noexcept { return !stiffness.empty() || by_modes(); }
  [[nodiscard]] bool by_modes() const noexcept { return format == FeFormat::modes; }
  bool operator==(const FeFiles&) const = default;
};

/// Some of a mesh's nodes: a named set, or those in a box.
struct NodeSelection {
  std::string set;                                ///< empty: the box
  std::optional<std::array<double, 3>> from, to;  ///< corners of the box in the model's own axes and unit of length
  double tolerance = 1e-3;                        ///< by which the box is widened on all sides [model's length]
  [[nodiscard]] bool given() const noexcept { return !set.empty() || from || to; }
  bool operator==(const NodeSelection&) const = default;
};

/// Nodes that stand on the ground and move with it alike, and whose rows the matrices have.
struct FeSupport {
  NodeSelection nodes;
  std::vector<std::string> holds{"x", "y", "z"};  ///< motions in railtab's axes; the ground moves y and z
  std::optional<double> x;  ///< place along the track whose ground it stands on [m]; empty: the mean of its nodes
  bool operator==(const FeSupport&) const = default;
};

/// A node in railtab's axes [m], and its rows: none for a motion that is held (or that the model does not have), one,
/// or several where the program has expanded a beam or shell into solids that share the number of the node
/// (node_motion()).
struct FeNode {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::array<std::vector<int>, 6> rows;
  /// Columns of supports that move y and z where there is no row; held: at rest.
  std::array<int, 2> support{held, held};
  [[nodiscard]] bool expanded() const noexcept;
};

inline constexpr int no_node = 0;

/// A finite-element model in SI units and railtab's axes: every row is a motion x, y, z, roll, pitch or yaw, in
/// railtab's sense. Symmetric.
struct FeStructure {
  Eigen::SparseMatrix<double> mass, stiffness;
  Eigen::SparseMatrix<double> damping;  ///< 0 × 0: none
  StructureSupports supports;           ///< as the matrices know them; without damping matrix without C_s
  std::vector<int> motion;              ///< of each row: 0..5 for x, y, z, roll, pitch, yaw
  std::vector<int> node_of_row;         ///< no_node for an inner mode of an element, which rests in rigid motions
  std::map<int, FeNode> nodes;          ///< all nodes of the mesh that have a row or a position
  std::vector<DeckRow> sections{};      ///< forces in sections, by its rows and the supports' translations
  FeMesh mesh;                          ///< as it was read, for selections
  std::string source;                   ///< name of the stiffness file, for messages
  [[nodiscard]] int dofs() const noexcept { return static_cast<int>(stiffness.rows()); }
};

/// Reads a model, checks that its matrices are symmetric (1e-9 of the largest diagonal entry; the mean of both halves
/// is taken), that no diagonal entry of K is zero or negative and none of M negative, and turns it into railtab's axes
/// and units: with q_railtab = S·q_model, S = ±(unit of length) for a translation and ±1 for a rotation, K becomes F·L
/// · S⁻ᵀ K S⁻¹, and likewise M and C with the second. @throws InputError with file and line, row, or key
[[nodiscard]] FeStructure read_fe_structure(const FeFiles& files, const FeFrame& frame);

/// Around all nodes, railtab's axes [m].
[[nodiscard]] Eigen::AlignedBox3d box_around(const FeStructure& structure);

/// Of every row along the track [m]; an element's inner mode stands where the last of its nodes does.
[[nodiscard]] std::vector<double> row_positions(const FeStructure& structure);

/// Numbers of the selected nodes, ascending. @throws InputError naming `key` where there is no such set or no node
[[nodiscard]] std::vector<int> selected_nodes(const FeStructure& structure, const NodeSelection& selection,
                                              const std::string& key);

}  // namespace railtab
