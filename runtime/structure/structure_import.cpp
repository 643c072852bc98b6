#include "railtab/runtime/structure/structure_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_matrix.hpp"
#include "railtab/runtime/fe/matrix_scales.hpp"
#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/structure/fe_structure.hpp"
#include "railtab/runtime/structure/fe_supports.hpp"
#include "railtab/runtime/structure/free_motion.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr std::string_view header = "row,node,x[m],motion,rail";

struct Node {
  double x = 0.0;
  std::string place;  // of its first line
  bool left = false, right = false, support = false;
  DofIndices dof{held, held, held, held, held, held};
};

struct DofTable {
  std::vector<std::pair<std::string, Node>> nodes;       // in the order of the file
  std::unordered_map<std::string, std::size_t> index{};  // by name
  std::vector<double> sign;                              // per row of the matrices
};

void set_rails(Node& node, const std::string& place, std::string_view rail) {
  if (rail != "left" && rail != "right" && rail != "both" && rail != "support" && !rail.empty()) {
    throw input_error(place, fmt::format("rail '{}'", rail), "left, right, both, support, or nothing");
  }
  node.support = rail == "support";
  node.left = rail == "left" || rail == "both";
  node.right = rail == "right" || rail == "both";
}

void add_row(DofTable& table, std::vector<bool>& taken, const ColumnRows& line) {
  const std::string place = line.reader().place();
  const std::string_view row_cell = line.cells()[0], name = line.cells()[1], x_cell = line.cells()[2];
  const std::string_view motion_cell = line.cells()[3], rail = line.cells()[4];
  const int rows = static_cast<int>(table.sign.size());
  int row = 0;
  if (!parse(row_cell, row) || row < 1 || row > rows) {
    throw input_error(place, fmt::format("row '{}'", row_cell), fmt::format("1 to {}, the matrices' rows", rows));
  }
  if (taken[static_cast<std::size_t>(row - 1)]) throw input_error(place, fmt::format("row {} again", row), "each once");
  taken[static_cast<std::size_t>(row - 1)] = true;
  double x = 0.0;
  if (!parse(x_cell, x) || !std::isfinite(x)) throw input_error(place, fmt::format("x '{}'", x_cell), "a number in m");
  const bool turned = motion_cell.starts_with('-');
  const std::string_view motion = motion_cell.substr(turned ? 1 : 0);
  const auto* const known = std::find(motion_names.begin(), motion_names.end(), motion);
  if (known == motion_names.end()) {
    throw input_error(place, fmt::format("motion '{}'", motion_cell),
                      "x, y, z, roll, pitch or yaw, with a minus where the model counts the other way");
  }
  if (name.empty()) throw input_error(place, "no node name", "a name");
  table.sign[static_cast<std::size_t>(row - 1)] = turned ? -1.0 : 1.0;
  const auto [at, is_new] = table.index.try_emplace(std::string(name), table.nodes.size());
  if (is_new) {
    table.nodes.emplace_back(name, Node{x, place});
    set_rails(table.nodes.back().second, place, rail);
  }
  Node& node = table.nodes[at->second].second;
  Node other;
  set_rails(other, place, rail);
  if (node.x != x || node.left != other.left || node.right != other.right || node.support != other.support) {
    throw input_error(place, fmt::format("node {} at another place or on another rail or support", name),
                      fmt::format("as in {}", node.place));
  }
  int& dof = node.dof[static_cast<std::size_t>(known - motion_names.begin())];
  if (dof != held) throw input_error(place, fmt::format("motion {} of node {} again", motion, name), "each once");
  dof = row - 1;
}

DofTable read_dofs(const std::filesystem::path& file, int rows) {
  ColumnRows lines(file, "a table of dofs", header);
  DofTable table;
  table.sign.assign(static_cast<std::size_t>(rows), 1.0);
  std::vector<bool> taken(static_cast<std::size_t>(rows), false);
  while (lines.next()) add_row(table, taken, lines);
  return table;
}

RailLine rail_line(const DofTable& table, bool Node::*on_rail, const std::filesystem::path& file,
                   std::string_view name) {
  std::vector<Node> nodes;
  for (const auto& [label, node] : table.nodes) {
    if (node.*on_rail) nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.x < b.x; });
  if (nodes.size() < 2) {
    throw input_error(file.string(), fmt::format("{} nodes of the {} rail", nodes.size(), name), "at least 2");
  }
  RailLine line;
  for (const Node& node : nodes) {
    if (!line.x.empty() && node.x == line.x.back()) {
      throw input_error(node.place, fmt::format("a second node of the {} rail at x = {} m", name, node.x), "one");
    }
    if (node.dof[2] == held) throw input_error(node.place, "a rail node without the motion z", "z of every rail node");
    line.x.push_back(node.x);
    line.dof.push_back(node.dof);
  }
  return line;
}

Sparse read_symmetric(const std::filesystem::path& file, Eigen::Index rows) {
  return symmetric_mean(file, read_matrix_market(file), rows);
}

// The role of each row: degree of freedom, moved by the ground (y and z of a support), or held.
std::vector<int> columns_of_rows(const DofTable& table, std::vector<double>& support_x) {
  std::vector<int> column_of_row(table.sign.size(), RowSplit::dof);
  for (const auto& [name, node] : table.nodes) {
    if (!node.support) continue;
    const int first = static_cast<int>(2 * support_x.size());
    support_x.push_back(node.x);
    for (std::size_t k = 0; k < node.dof.size(); ++k) {
      if (node.dof[k] == held) continue;
      const bool moves = k == y_dof || k == z_dof;
      column_of_row[static_cast<std::size_t>(node.dof[k])] =
          moves ? first + static_cast<int>(k - y_dof) : RowSplit::resting;
    }
  }
  return column_of_row;
}

// Where the nodes stand is not known but along the track: the node that moves most is what can be said.
void require_held(const StructureFiles& files, const DofTable& table, const Sparse& stiffness) {
  const std::optional<Eigen::VectorXd> v = motion_without_stiffness(stiffness);
  if (!v) return;
  std::string most = "rows that the table of dofs does not name";
  double largest = 1e-6;
  for (const auto& [name, node] : table.nodes) {
    for (std::size_t k = 0; k < node.dof.size(); ++k) {
      if (node.dof[k] == held || std::abs((*v)[node.dof[k]]) <= largest) continue;
      largest = std::abs((*v)[node.dof[k]]);
      most = fmt::format("node {} along {}", name, motion_names[k]);
    }
  }
  throw input_error(files.stiffness.string(), fmt::format("a motion that nothing holds, the most of it at {}", most),
                    "a stiffness whose supports hold every motion");
}

// What the table does not name may be anything: how a translation moves it is what the supports carry it by.
void settle_named_supports(const std::filesystem::path& file, StructureModel& model) {
  StructureSupports& s = model.supports;
  const Sparse carried = carried_by_supports(model.stiffness, s.stiffness);
  Eigen::MatrixXd translation = Eigen::MatrixXd::Zero(model.dofs(), 2);
  for (Eigen::Index j = 0; j < carried.cols(); ++j) translation.col(j % 2) += carried.col(j);
  for (const RailLine& rail : model.rail) {
    for (std::size_t n = 0; n < rail.x.size(); ++n) {
      constexpr double tolerance = 1e-6;
      const double z = translation(rail.dof[n][2], 1);
      if (std::abs(z - 1.0) <= tolerance) continue;
      throw input_error(
          file.string(),
          fmt::format("supports that carry the rail at x = {} m by {:.6g} of their own motion along z", rail.x[n], z),
          "all supports, whose translation strains nothing");
    }
  }
  const auto name = [](Eigen::Index row) {
    return fmt::format("degree of freedom {} beside the supports' rows", row + 1);
  };
  settle_supports({model.mass, model.damping, model.stiffness}, translation, name, s);
}

void check_numbers(const StructureFiles& files, const DofTable& table, const StructureModel& model) {
  const auto row_text = [&](Eigen::Index row) {
    for (const auto& [name, node] : table.nodes) {
      for (std::size_t k = 0; k < node.dof.size(); ++k) {
        if (node.dof[k] == row) return fmt::format("row {} (node {}, {})", row + 1, name, motion_names[k]);
      }
    }
    return fmt::format("row {}", row + 1);
  };
  const FileMatrix mass{model.mass, files.mass}, stiffness{model.stiffness, files.stiffness};
  check_scales(mass, {model.damping, files.damping}, stiffness, structure_scales, row_text);
  check_off_diagonals(mass, "mass", row_text);
  check_off_diagonals(stiffness, "stiffness", row_text);
}

}  // namespace

StructureModel import_structure(const StructureFiles& files) {
  StructureModel model;
  model.stiffness = read_symmetric(files.stiffness, 0);
  model.mass = read_symmetric(files.mass, model.stiffness.rows());
  model.damping = read_symmetric(files.damping, model.stiffness.rows());
  DofTable table = read_dofs(files.dofs, static_cast<int>(model.stiffness.rows()));
  const Eigen::VectorXd sign = Eigen::VectorXd::Map(table.sign.data(), static_cast<Eigen::Index>(table.sign.size()));
  for (Sparse* matrix : {&model.mass, &model.damping, &model.stiffness}) {
    *matrix = sign.asDiagonal() * *matrix * sign.asDiagonal();
    matrix->makeCompressed();
  }
  check_numbers(files, table, model);
  const RowSplit rows(columns_of_rows(table, model.supports.x));
  if (model.supports.columns() > 0) {
    StructureSupports& s = model.supports;
    s.stiffness = rows.split(model.stiffness, s.columns());
    s.mass = rows.split(model.mass, s.columns());
    s.damping = rows.split(model.damping, s.columns());
    for (auto& [name, node] : table.nodes) {
      for (int& dof : node.dof) dof = dof == held ? held : rows[dof];
    }
  }
  model.rail[0] = rail_line(table, &Node::left, files.dofs, "left");
  model.rail[1] = rail_line(table, &Node::right, files.dofs, "right");
  for (const auto& [name, node] : table.nodes) {
    if (!node.left && !node.right && !node.support) model.nodes.push_back({name, node.x, node.dof});
  }
  require_held(files, table, model.stiffness);
  if (model.supports.columns() > 0) settle_named_supports(files.dofs, model);
  return model;
}

}  // namespace railtab
