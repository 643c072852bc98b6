#include "railtab/runtime/structure/section_forces.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"

namespace railtab {
namespace {

using RigidMotions = Eigen::Matrix<double, 6, 1>;
using Entry = Eigen::SparseMatrix<double>::InnerIterator;

constexpr double in_plane = 1e-6;    // [m] from a section, a node belongs to its plane
constexpr double negligible = 1e-6;  // of what the entries of K could add up to

std::string place_of(double x) { return fmt::format("structure.sections: x = {:.6g} m", x); }

/// What a row does in unit motions of the whole along x, y, z and about them, through the axis of a section.
RigidMotions rigid_motions(const FeStructure& structure, Eigen::Index row_of_matrix, const Eigen::Vector3d& axis) {
  const auto row = static_cast<std::size_t>(row_of_matrix);
  RigidMotions R = RigidMotions::Zero();
  const int number = structure.node_of_row[row];
  if (number == no_node) return R;  // an inner mode rests
  const int motion = structure.motion[row];
  R[motion] = 1.0;
  if (motion > 2) return R;
  const FeNode& node = structure.nodes.at(number);
  if (node.expanded()) {
    throw input_error(place_of(axis[0]), fmt::format("node {}, expanded into solids by the program", number),
                      "solids, or a program whose shells and beams have rotations: where the rows of an expanded node "
                      "stand is not known");
  }
  R.tail<3>() = (node.position - axis).cross(Eigen::Vector3d::Unit(motion));  // (e_m × r)·e_k = e_m·(r × e_k)
  return R;
}

/// Forces across one section.
class Section {
 public:
  /// @param row_x of all rows [m]
  Section(const FeStructure& structure, const std::vector<double>& row_x, double x, double axis_depth)
      : structure_(structure), axis_(x, 0.0, axis_depth) {
    Eigen::VectorXd before(structure.dofs());
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      const double beyond = row_x[static_cast<std::size_t>(i)] - x;
      before[i] = std::abs(beyond) <= in_plane ? 0.5 : beyond < 0.0 ? 1.0 : 0.0;
    }
    for (int j = 0; j < structure.dofs(); ++j) {
      RigidMotions force = RigidMotions::Zero();
      for (Entry k(structure.stiffness, j); k; ++k) {
        const double share = before[j] - before[k.row()];
        if (share == 0.0) continue;
        const RigidMotions R = rigid_motions(structure, k.row(), axis_);
        force += share * k.value() * R;
        energy_ += std::abs(share * k.value()) * R.cwiseAbs2();
        nodes_.insert(structure.node_of_row[static_cast<std::size_t>(j)]);
      }
      if (force.isZero(0.0)) continue;
      shear.emplace_back(j, force[z_dof]);
      moment.emplace_back(j, force[pitch_dof]);
      in_rigid_motions_ += force * rigid_motions(structure, j, axis_).transpose();
    }
    nodes_.erase(no_node);
  }
  [[nodiscard]] bool empty() const { return energy_[z_dof] == 0.0; }
  /// Whether the elements that are cut have all their rows: rigid motions then give no shear force and no moment. A row
  /// that alone on its side balances the others, as that along a beam, can be lacking all the same; its node then has
  /// fewer motions than others, and they meet resistance.
  [[nodiscard]] bool exact() const {
    const RigidMotions scale = energy_.cwiseSqrt();
    for (const Eigen::Index force : {z_dof, pitch_dof}) {
      for (Eigen::Index motion = 0; motion < 6; ++motion) {
        if (std::abs(in_rigid_motions_(force, motion)) > negligible * scale[force] * scale[motion]) return false;
      }
    }
    return std::ranges::all_of(nodes_, [&](int node) { return has_motions_of(node, *nodes_.begin()); }) ||
           std::ranges::none_of(nodes_, [&](int node) { return resists(node); });
  }

  DofSum shear, moment;

 private:
  [[nodiscard]] bool has_motions_of(int node, int other) const {
    return std::ranges::equal(structure_.nodes.at(node).rows, structure_.nodes.at(other).rows,
                              [](const auto& a, const auto& b) { return a.empty() == b.empty(); });
  }
  /// Whether a motion of all along z or about the axis meets a force at a node.
  [[nodiscard]] bool resists(int node) const {
    return std::ranges::any_of(structure_.nodes.at(node).rows, [&](const std::vector<int>& rows) {
      if (rows.empty()) return false;
      RigidMotions force = RigidMotions::Zero();
      double most = 0.0;
      for (Entry k(structure_.stiffness, rows.front()); k; ++k) {
        const RigidMotions R = rigid_motions(structure_, k.row(), axis_);
        force += k.value() * R;
        most += std::abs(k.value()) * R.norm();
      }
      return std::max(std::abs(force[z_dof]), std::abs(force[pitch_dof])) > negligible * most;
    });
  }

  const FeStructure& structure_;
  Eigen::Vector3d axis_;
  std::set<int> nodes_;                                                                 // of the elements that are cut
  Eigen::Matrix<double, 6, 6> in_rigid_motions_ = Eigen::Matrix<double, 6, 6>::Zero();  // forces × motions
  RigidMotions energy_ = RigidMotions::Zero();
};

}  // namespace

std::vector<DeckRow> section_forces(const FeStructure& structure, std::vector<double> x, double axis_depth) {
  const std::vector<double> row_x = row_positions(structure);
  const auto [low, high] = std::minmax_element(row_x.begin(), row_x.end());
  std::sort(x.begin(), x.end());
  std::vector<DeckRow> rows, shears;
  for (const double at : x) {
    if (!(at > *low + in_plane && at < *high - in_plane)) {
      throw input_error("structure.sections", fmt::format("{:.6g} m", at),
                        fmt::format("between {:.6g} and {:.6g} m, nodes with rows of the matrices", *low, *high));
    }
    Section section(structure, row_x, at, axis_depth);
    if (section.empty()) {
      throw input_error(place_of(at), "no stiffness between nodes before and behind it", "a section across the deck");
    }
    if (!section.exact()) {
      throw input_error(place_of(at), "elements with constrained nodes or prestress",
                        "a section beside them; at a support, matrices written without its constraint and a "
                        "[[support]] in its place");
    }
    rows.push_back({{DeckQuantity::bending_moment, at, 0.0}, std::move(section.moment)});
    shears.push_back({{DeckQuantity::shear_force, at, 0.0}, std::move(section.shear)});
  }
  rows.insert(rows.end(), std::make_move_iterator(shears.begin()), std::make_move_iterator(shears.end()));
  return rows;
}

}  // namespace railtab
