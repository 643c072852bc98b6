#include "railtab/runtime/structure/fe_structure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/abaqus_files.hpp"
#include "railtab/runtime/fe/fe_frame.hpp"
#include "railtab/runtime/fe/fe_matrix.hpp"
#include "railtab/runtime/fe/matrix_scales.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// What the rows are, and how a matrix over them is read.
struct Reading {
  std::vector<FeRow> rows;
  std::function<Sparse(const std::filesystem::path&)> matrix;
};

Reading reading_of(const FeFiles& files) {
  switch (files.format) {
    case FeFormat::calculix: {
      std::vector<FeRow> rows = read_calculix_rows(files.dofs);
      const int n = static_cast<int>(rows.size());
      return {std::move(rows), [n](const auto& file) { return read_calculix_matrix(file, n); }};
    }
    case FeFormat::abaqus: {
      AbaqusRows rows = read_abaqus_rows(files.stiffness, files.dofs);
      std::vector<FeRow> free = rows.rows;
      return {std::move(free), [rows = std::move(rows)](const auto& file) { return read_abaqus_matrix(file, rows); }};
    }
    case FeFormat::ansys: {
      std::vector<FeRow> rows = read_ansys_rows(files.dofs);
      const auto n = static_cast<Eigen::Index>(rows.size());
      return {std::move(rows), [n](const auto& file) { return symmetric_mean(file, read_harwell_boeing(file), n); }};
    }
    case FeFormat::matrix_market:
    case FeFormat::modes:  // has no matrices
      break;
  }
  std::vector<FeRow> rows = read_row_table(files.dofs);
  const auto n = static_cast<Eigen::Index>(rows.size());
  return {std::move(rows), [n](const auto& file) { return symmetric_mean(file, read_matrix_market(file), n); }};
}

/// Whether a row is an inner mode of an element, of a node that only the program knows: CalculiX numbers those of
/// incompatible elements (C3D8I, B31, S4) after the mesh's own nodes, Abaqus gives them negative numbers.
bool is_inner(const FeRow& row, FeFormat format, int last_node) {
  return (format == FeFormat::calculix && row.node > last_node) || (format == FeFormat::abaqus && row.node < 0);
}

/// A deck that is cut off within its nodes would make inner modes of those that it lacks.
void check_inner_nodes(const FeFiles& files, const FeMesh& mesh, const std::vector<FeRow>& rows, int last_node) {
  constexpr std::size_t of_element = 3;
  if (!mesh.elements) return;  // a table of nodes
  std::set<int> inner;
  for (const FeRow& row : rows) {
    if (is_inner(row, FeFormat::calculix, last_node)) inner.insert(row.node);
  }
  if (inner.size() <= of_element * *mesh.elements) return;
  throw input_error(files.nodes.string(),
                    fmt::format("nodes up to {} and {} elements, while {} has rows of {} further nodes", last_node,
                                *mesh.elements, files.dofs.string(), inner.size()),
                    "the whole input deck: CalculiX adds three nodes at most to an element, for its inner modes");
}

std::string row_text(const FeStructure& structure, Eigen::Index row) {
  const auto r = static_cast<std::size_t>(row);
  return fmt::format("row {} (node {}, railtab's {})", row + 1, structure.node_of_row[r],
                     motion_names[static_cast<std::size_t>(structure.motion[r])]);
}

std::string place_of_row(const std::filesystem::path& file, const FeStructure& structure, Eigen::Index row) {
  return fmt::format("{}: {}", file.string(), row_text(structure, row));
}

void check_numbers(const FeFiles& files, const FeStructure& structure) {
  const auto row = [&](Eigen::Index r) { return row_text(structure, r); };
  const FileMatrix mass{structure.mass, files.mass}, stiffness{structure.stiffness, files.stiffness};
  check_scales(mass, {structure.damping, files.damping}, stiffness, structure_scales, row);
  check_off_diagonals(mass, "mass", row);
  check_off_diagonals(stiffness, "stiffness", row);
}

void check_diagonals(const FeFiles& files, const FeStructure& structure) {
  const Eigen::VectorXd k = structure.stiffness.diagonal(), m = structure.mass.diagonal();
  for (Eigen::Index i = 0; i < k.size(); ++i) {
    if (!(k[i] > 0.0)) {
      throw input_error(place_of_row(files.stiffness, structure, i), fmt::format("stiffness {}", k[i]),
                        "> 0 on the diagonal: nothing holds this motion");
    }
    if (!(m[i] >= 0.0)) {
      throw input_error(place_of_row(files.mass, structure, i), fmt::format("mass {}", m[i]), ">= 0 on the diagonal");
    }
  }
}

}  // namespace

bool FeNode::expanded() const noexcept {
  return std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.size() > 1; });
}

FeStructure read_fe_structure(const FeFiles& files, const FeFrame& frame) {
  const FrameConversion conversion(frame, "structure");
  const Reading reading = reading_of(files);
  const int n = static_cast<int>(reading.rows.size());
  FeStructure s;
  s.source = files.stiffness.string();
  s.mesh = read_fe_mesh(files.nodes);
  if (files.format == FeFormat::abaqus && !s.mesh.turned.empty()) {
    throw input_error(s.mesh.turned, "*TRANSFORM", "nodes whose motions are along the model's axes");
  }
  s.stiffness = reading.matrix(files.stiffness);
  s.mass = reading.matrix(files.mass);
  if (!files.damping.empty()) s.damping = reading.matrix(files.damping);

  for (const auto& [node, position] : s.mesh.nodes) s.nodes[node].position = conversion.position(position);
  const int last_node = s.mesh.nodes.rbegin()->first;
  if (files.format == FeFormat::calculix) check_inner_nodes(files, s.mesh, reading.rows, last_node);
  Eigen::VectorXd to_model(n);
  for (int r = 0; r < n; ++r) {
    const FeRow& row = reading.rows[static_cast<std::size_t>(r)];
    const auto node = s.nodes.find(row.node);
    const bool inner = node == s.nodes.end() && is_inner(row, files.format, last_node);
    if (node == s.nodes.end() && !inner) {
      const std::string named = (files.dofs.empty() ? files.stiffness : files.dofs).string();
      throw input_error(row.line > 0 ? fmt::format("{}:{}", named, row.line) : named,
                        fmt::format("node {} in row {}", row.node, r + 1),
                        fmt::format("a node of {}", files.nodes.string()));
    }
    const FrameConversion::Row converted = conversion.row(row.motion);
    to_model[r] = converted.to_model;
    s.motion.push_back(converted.motion);
    s.node_of_row.push_back(inner ? no_node : row.node);
    if (!inner) node->second.rows[static_cast<std::size_t>(s.motion.back())].push_back(r);
  }
  for (Sparse* matrix : {&s.mass, &s.damping, &s.stiffness}) {
    if (matrix->rows() == 0) continue;
    *matrix = to_model.asDiagonal() * *matrix * to_model.asDiagonal();
    matrix->makeCompressed();
  }
  check_diagonals(files, s);
  check_numbers(files, s);
  require_other_numbers("structure.mass", files.mass, s.mass, files.stiffness, s.stiffness);
  if (s.damping.rows() > 0) {
    require_other_numbers("structure.damping", files.damping, s.damping, files.stiffness, s.stiffness);
  }
  return s;
}

Eigen::AlignedBox3d box_around(const FeStructure& structure) {
  Eigen::AlignedBox3d box;
  for (const auto& [number, node] : structure.nodes) box.extend(node.position);
  return box;
}

std::vector<double> row_positions(const FeStructure& structure) {
  std::vector<double> x;
  for (int node : structure.node_of_row)
    x.push_back(node == no_node ? -INFINITY : structure.nodes.at(node).position[0]);
  for (int r = 0; r < structure.dofs(); ++r) {
    if (structure.node_of_row[static_cast<std::size_t>(r)] != no_node) continue;
    double& own = x[static_cast<std::size_t>(r)];
    for (Sparse::InnerIterator entry(structure.stiffness, r); entry; ++entry) {
      const auto other = static_cast<std::size_t>(entry.row());
      if (structure.node_of_row[other] != no_node) own = std::max(own, x[other]);
    }
  }
  return x;
}

std::vector<int> selected_nodes(const FeStructure& structure, const NodeSelection& selection, const std::string& key) {
  std::set<int> nodes;
  if (!selection.set.empty()) {
    const auto found = structure.mesh.sets.find(upper_case(selection.set));
    if (found == structure.mesh.sets.end()) {
      std::vector<std::string> names;
      for (const auto& [name, members] : structure.mesh.sets) names.push_back(name);
      throw input_error(key, fmt::format("no set \"{}\" of nodes", selection.set),
                        names.empty() ? "a box, from and to: the file of nodes has no sets"
                                      : fmt::format("one of {}", fmt::join(names, ", ")));
    }
    nodes.insert(found->second.begin(), found->second.end());
  } else {
    if (!selection.from || !selection.to) {
      throw input_error(key, "neither a set nor two corners of a box", "set, or from and to");
    }
    for (const auto& [number, position] : structure.mesh.nodes) {
      bool inside = true;
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] =
            std::minmax((*selection.from)[static_cast<std::size_t>(k)], (*selection.to)[static_cast<std::size_t>(k)]);
        inside = inside && position[k] >= low - selection.tolerance && position[k] <= high + selection.tolerance;
      }
      if (inside) nodes.insert(number);
    }
  }
  // A box may meet nodes that belong to no element; a set says what it means, held nodes too.
  if (selection.set.empty()) {
    std::erase_if(nodes, [&](int number) {
      const auto& rows = structure.nodes.at(number).rows;
      return std::all_of(rows.begin(), rows.end(), [](const auto& r) { return r.empty(); });
    });
  }
  if (nodes.empty()) {
    throw input_error(key,
                      selection.set.empty()
                          ? fmt::format("no node with a row of the matrices between {} and {}",
                                        fmt::join(*selection.from, ", "), fmt::join(*selection.to, ", "))
                          : fmt::format("no node in the set \"{}\"", selection.set),
                      "at least one node (a box is in the model's axes and unit, see its tolerance)");
  }
  return {nodes.begin(), nodes.end()};
}

}  // namespace railtab
