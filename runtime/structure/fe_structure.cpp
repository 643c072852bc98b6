#include "railtab/runtime/structure/fe_structure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "text_lines.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double symmetry_tolerance = 1e-9;  // of the largest diagonal entry: what writing with ten digits leaves
constexpr std::array<std::string_view, 6> motion_names{"x", "y", "z", "roll", "pitch", "yaw"};

struct UnitSystem {
  std::string_view name;
  double length, force;  // in m and N; the unit of mass follows with the second
};
constexpr std::array<UnitSystem, 3> unit_systems{{{"m-N-kg", 1.0, 1.0}, {"mm-N-t", 1e-3, 1.0}, {"m-kN-t", 1.0, 1e3}}};

double length_unit(const FeFrame& frame, double& force) {
  for (const UnitSystem& system : unit_systems) {
    if (system.name != frame.units) continue;
    force = system.force;
    return system.length;
  }
  throw input_error("structure.units", frame.units, fmt::format("one of {}", fmt::join(fe_unit_systems(), ", ")));
}

/// Rows: railtab's x, y, z in the model's axes.
Eigen::Matrix3d rotation(const FeFrame& frame) {
  const auto refuse = [&](std::string_view found) {
    return input_error("structure.axes", fmt::format("\"{}\"{}", frame.axes, found),
                       "the model's directions forward, right and down, right-handed, like \"x -y -z\"");
  };
  std::array<std::string_view, 3> words;
  if (split(frame.axes, words) != 3) throw refuse("");
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    std::string_view word = words[static_cast<std::size_t>(i)];
    const double sign = word.starts_with('-') ? -1.0 : 1.0;
    if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
    if (word.size() != 1 || word[0] < 'x' || word[0] > 'z') throw refuse("");
    P(i, word[0] - 'x') = sign;
  }
  const double determinant = P.determinant();
  if (determinant == 0.0) throw refuse(", an axis twice");
  if (determinant < 0.0) throw refuse(", left-handed");
  return P;
}

Sparse read_matrix(const FeFiles& files, const std::filesystem::path& file, int rows) {
  switch (files.format) {
    case FeFormat::calculix:
      return read_calculix_matrix(file, rows);
    case FeFormat::ansys:
      return symmetric_mean(file, read_harwell_boeing(file), rows);
    case FeFormat::matrix_market:
      break;
  }
  return symmetric_mean(file, read_matrix_market(file), rows);
}

std::vector<FeRow> read_rows(const FeFiles& files) {
  switch (files.format) {
    case FeFormat::calculix:
      return read_calculix_rows(files.dofs);
    case FeFormat::ansys:
      return read_ansys_rows(files.dofs);
    case FeFormat::matrix_market:
      break;
  }
  return read_row_table(files.dofs);
}

std::string place_of_row(const std::filesystem::path& file, const FeStructure& structure, Eigen::Index row) {
  const auto r = static_cast<std::size_t>(row);
  return fmt::format("{}: row {} (node {}, railtab's {})", file.string(), row + 1, structure.node_of_row[r],
                     motion_names[static_cast<std::size_t>(structure.motion[r])]);
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

std::vector<std::string> fe_unit_systems() {
  std::vector<std::string> names;
  for (const UnitSystem& system : unit_systems) names.emplace_back(system.name);
  return names;
}

bool FeNode::expanded() const noexcept {
  return std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.size() > 1; });
}

Sparse symmetric_mean(const std::filesystem::path& file, const Sparse& matrix, Eigen::Index rows) {
  const Eigen::Index expected = rows > 0 ? rows : matrix.rows();
  if (matrix.rows() != expected || matrix.cols() != expected) {
    throw input_error(file.string(), fmt::format("{} x {}", matrix.rows(), matrix.cols()),
                      fmt::format("{0} x {0}{1}", expected, rows > 0 ? ", as the others" : ", square"));
  }
  const Sparse transposed = matrix.transpose();
  const Sparse difference = matrix - transposed;
  const double bound = symmetry_tolerance * matrix.diagonal().cwiseAbs().maxCoeff();
  for (int column = 0; column < difference.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(difference, column); entry; ++entry) {
      if (std::abs(entry.value()) <= bound) continue;
      throw input_error(fmt::format("{}: row {}, column {}", file.string(), entry.row() + 1, column + 1),
                        fmt::format("{} against {} at the mirrored place", matrix.coeff(entry.row(), column),
                                    matrix.coeff(column, entry.row())),
                        "a symmetric matrix");
    }
  }
  return 0.5 * (matrix + transposed);
}

FeStructure read_fe_structure(const FeFiles& files, const FeFrame& frame) {
  double force = 1.0;
  const double length = length_unit(frame, force);
  const Eigen::Matrix3d P = rotation(frame);
  const std::vector<FeRow> rows = read_rows(files);
  const int n = static_cast<int>(rows.size());
  FeStructure s;
  s.source = files.stiffness.string();
  s.mesh = read_fe_mesh(files.nodes);
  s.stiffness = read_matrix(files, files.stiffness, n);
  s.mass = read_matrix(files, files.mass, n);
  if (!files.damping.empty()) s.damping = read_matrix(files, files.damping, n);

  const Eigen::Vector3d origin = Eigen::Vector3d::Map(frame.origin.value().data());
  for (const auto& [node, position] : s.mesh.nodes) s.nodes[node].position = length * (P * (position - origin));
  const int last_node = s.mesh.nodes.rbegin()->first;
  // q_model per q_railtab, and half of the factor that turns the model's unit of energy into joules
  Eigen::VectorXd to_model(n);
  for (int r = 0; r < n; ++r) {
    const FeRow& row = rows[static_cast<std::size_t>(r)];
    const bool turns = row.motion >= 3;
    const auto node = s.nodes.find(row.node);
    // CalculiX numbers the inner modes of its incompatible elements (C3D8I, B31, S4) after the mesh's own nodes
    const bool inner = node == s.nodes.end() && files.format == FeFormat::calculix && row.node > last_node;
    if (node == s.nodes.end() && !inner) {
      throw input_error(files.dofs.string(), fmt::format("node {} in row {}", row.node, r + 1),
                        fmt::format("a node of {}", files.nodes.string()));
    }
    int axis = 0;
    const double sign = P.col(row.motion % 3).cwiseAbs().maxCoeff(&axis) * P.col(row.motion % 3).sum();
    to_model[r] = sign * std::sqrt(force * length) / (turns ? 1.0 : length);
    s.motion.push_back(axis + (turns ? 3 : 0));
    s.node_of_row.push_back(inner ? no_node : row.node);
    if (!inner) node->second.rows[static_cast<std::size_t>(s.motion.back())].push_back(r);
  }
  for (Sparse* matrix : {&s.mass, &s.damping, &s.stiffness}) {
    if (matrix->rows() == 0) continue;
    *matrix = to_model.asDiagonal() * *matrix * to_model.asDiagonal();
    matrix->makeCompressed();
  }
  check_diagonals(files, s);
  return s;
}

std::vector<int> selected_nodes(const FeStructure& structure, const NodeSelection& selection, const std::string& key) {
  std::set<int> nodes;
  if (!selection.set.empty()) {
    const auto found = structure.mesh.sets.find(upper_case(selection.set));
    if (found == structure.mesh.sets.end()) {
      std::vector<std::string> names;
      for (const auto& [name, members] : structure.mesh.sets) names.push_back(name);
      throw input_error(
          key + ".set", selection.set,
          names.empty() ? "no set: the file of nodes has none" : fmt::format("{}", fmt::join(names, ", ")));
    }
    nodes.insert(found->second.begin(), found->second.end());
  } else {
    if (!selection.from || !selection.to) {
      throw input_error(key, "neither a set nor two corners of a box", key + ".set, or " + key + ".from and .to");
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
  if (nodes.empty()) throw input_error(key, "no node with a free motion", "nodes that carry the track");
  return {nodes.begin(), nodes.end()};
}

}  // namespace railtab
