#include "railtab/runtime/structure/fe_supports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/structure/matrix_assembly.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Columns = StructureSupports::Columns;

std::string place_of(std::size_t support, std::size_t count) {
  return fmt::format("scene: [[support]] {} of {}", support + 1, count);
}

std::array<bool, 6> held_motions(const FeSupport& support, const std::string& place) {
  std::array<bool, 6> holds{};
  if (support.holds.empty()) {
    throw input_error(place, "support.holds without a motion",
                      fmt::format("some of {}", fmt::join(motion_names, ", ")));
  }
  for (const std::string& name : support.holds) {
    const auto* const known = std::find(motion_names.begin(), motion_names.end(), name);
    if (known == motion_names.end()) {
      throw input_error(place, fmt::format("support.holds with \"{}\"", name),
                        fmt::format("some of {}", fmt::join(motion_names, ", ")));
    }
    bool& taken = holds[static_cast<std::size_t>(known - motion_names.begin())];
    if (taken) throw input_error(place, fmt::format("support.holds with \"{}\" twice", name), "each motion once");
    taken = true;
  }
  return holds;
}

/// Sets the role of every row that a support holds; returns the support's place along the track [m].
double hold(FeStructure& structure, const FeSupport& support, std::size_t number, const std::string& place,
            std::vector<int>& column_of_row) {
  const std::array<bool, 6> holds = held_motions(support, place);
  const std::vector<int> nodes = selected_nodes(structure, support.nodes, place);
  double x = 0.0;
  bool any = false;
  for (int name : nodes) {
    FeNode& node = structure.nodes.at(name);
    x += node.position[0] / static_cast<double>(nodes.size());
    for (std::size_t k = 0; k < 6; ++k) {
      if (!holds[k]) continue;
      const bool moves = k == y_dof || k == z_dof;
      const int to = moves ? static_cast<int>(2 * number + k - y_dof) : RowSplit::resting;
      if (moves) node.support[k - y_dof] = to;
      for (int row : node.rows[k]) {
        int& column = column_of_row[static_cast<std::size_t>(row)];
        if (column != RowSplit::dof) {
          throw input_error(place, fmt::format("{} of node {} again", motion_names[k], name),
                            "each in one [[support]]");
        }
        column = to;
        any = true;
      }
    }
  }
  if (!any) {
    throw input_error(place, fmt::format("nodes none of which has a row of {}", fmt::join(support.holds, ", ")),
                      "matrices that were written without these constraints, or no [[support]] for them");
  }
  return support.x.value_or(x);
}

/// Sum of the columns along y and along z.
Eigen::MatrixXd of_all(const Columns& matrix, Eigen::Index rows) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows, 2);
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) sum.col(j % 2) += matrix.col(j);
  return sum;
}

/// A r + A_s 1, what a translation of structure and supports meets.
Eigen::MatrixXd resistance(const Sparse& matrix, const Columns& of_supports, const Eigen::MatrixXd& translation) {
  return matrix * translation + of_all(of_supports, matrix.rows());
}

/// Where K⁻¹ times a resistance holds the structure back most, among all that a translation moves.
struct LeftBehind {
  double size = 0.0;
  Eigen::Index row = 0;
};

LeftBehind left_behind(const SparseLdlt& factor, const Eigen::MatrixXd& resistance,
                       const Eigen::MatrixXd& translation) {
  const Eigen::MatrixXd answer = factor.solve_columns(resistance);
  LeftBehind most;
  for (Eigen::Index i = 0; i < answer.rows(); ++i) {
    if (translation.row(i).isZero(0.0)) continue;
    const double size = answer.row(i).cwiseAbs().maxCoeff();
    if (size > most.size) most = {size, i};
  }
  return most;
}

/// a of what C r has of a·m + b·k, m and k what the translation meets of mass and stiffness.
double mass_share(const Eigen::MatrixXd& damping, const Eigen::MatrixXd& mass, const Eigen::MatrixXd& stiffness) {
  const double mm = mass.squaredNorm(), kk = stiffness.squaredNorm(), mk = mass.cwiseProduct(stiffness).sum();
  const double cm = damping.cwiseProduct(mass).sum(), ck = damping.cwiseProduct(stiffness).sum();
  if (mm == 0.0) return 0.0;
  if (kk == 0.0) return cm / mm;
  return (cm * kk - ck * mk) / (mm * kk - mk * mk);
}

/// Entries that are rounding of the largest are left out.
void append_support(const Eigen::MatrixXd& columns, Columns& matrix) {
  constexpr double rounding = 1e-12;
  const double least = rounding * (columns.size() > 0 ? columns.cwiseAbs().maxCoeff() : 0.0);
  Columns wider(columns.rows(), matrix.cols() + 2);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    wider.startVec(i);
    if (matrix.cols() > 0) {
      for (Columns::InnerIterator entry(matrix, i); entry; ++entry) wider.insertBack(i, entry.col()) = entry.value();
    }
    for (Eigen::Index number = 0; number < 2; ++number) {
      if (std::abs(columns(i, number)) > least) wider.insertBack(i, matrix.cols() + number) = columns(i, number);
    }
  }
  wider.finalize();
  matrix.swap(wider);
}

/// What a translation meets of what stands on other ground than the declared supports.
struct Resistances {
  Eigen::MatrixXd strained, braked;
};

/// Of y and z, the motions that neither a row nor a support gives to a node.
std::vector<std::string_view> loose_motions(const FeNode& node) {
  std::vector<std::string_view> loose;
  for (const int motion : {y_dof, z_dof}) {
    const auto k = static_cast<std::size_t>(motion - y_dof);
    if (node.rows[static_cast<std::size_t>(motion)].empty() && node.support[k] == held) {
      loose.push_back(motion_names[static_cast<std::size_t>(motion)]);
    }
  }
  return loose;
}

/// Takes rounding, and damping in proportion to the mass, out of what resists a translation; returns the remainder.
std::string settle_declared_supports(const FeMatrices& m, const Eigen::MatrixXd& translation, const RowName& name,
                                     StructureSupports& s, Resistances& resistances) {
  constexpr double rigid = 1e-4;     // of the supports' translation
  constexpr double undamped = 1e-6;  // [m per m/s]: 1e-4 of the translation at 100 rad/s
  constexpr double rounding = 1e-9;  // of what the damping's entries add up to
  std::string beyond;
  const SparseLdlt factor = stiffness_factor(m.stiffness);
  auto& [missing, braking] = resistances;
  const LeftBehind strained = left_behind(factor, missing, translation);
  if (strained.size <= rigid) {
    missing.setZero();
  } else {
    beyond = fmt::format(
        "that stands on more than its [[support]]s, or whose matrices were written with few digits: where all supports "
        "move alike, {} stays behind by {:.2g} of it",
        name(strained.row), strained.size);
  }
  const Eigen::MatrixXd inertia = resistance(m.mass, s.mass, translation);
  const double a = mass_share(braking, inertia, missing);
  if (a * inertia.norm() > rounding * (m.damping.cwiseAbs() * translation.cwiseAbs()).norm()) {
    Sparse of_mass = m.mass * carried_by_supports(factor, s.stiffness);
    of_mass += Sparse(s.mass);
    s.damping = Sparse(s.damping) - a * of_mass;
    braking = resistance(m.damping, s.damping, translation);
  }
  const LeftBehind braked = left_behind(factor, braking, translation);
  if (braked.size <= undamped) {
    braking.setZero();
  } else if (beyond.empty()) {
    beyond = fmt::format(
        "with dampers to more than its [[support]]s: where they all move at 1 m/s, {} stays behind by {:.2g} m",
        name(braked.row), braked.size);
  }
  return beyond;
}

}  // namespace

RowSplit::RowSplit(std::vector<int> column_of_row) : column_(std::move(column_of_row)) {
  for (int column : column_) number_.push_back(column == dof ? dofs_++ : held);
}

Columns RowSplit::split(Sparse& matrix, int columns) const {
  std::vector<Eigen::Triplet<double>> inner, outer;
  inner.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  for (int j = 0; j < matrix.outerSize(); ++j) {
    const int column = column_[static_cast<std::size_t>(j)];
    if (column == resting) continue;
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry) {
      const int row = number_[static_cast<std::size_t>(entry.row())];
      if (row == held) continue;
      if (column == dof) {
        inner.emplace_back(row, number_[static_cast<std::size_t>(j)], entry.value());
      } else {
        outer.emplace_back(row, column, entry.value());
      }
    }
  }
  matrix.resize(dofs_, dofs_);
  matrix.setFromTriplets(inner.begin(), inner.end());
  Columns of_supports(dofs_, columns);
  of_supports.setFromTriplets(outer.begin(), outer.end());
  return of_supports;
}

FeStructure on_supports(FeStructure s, const std::vector<FeSupport>& supports) {
  if (supports.empty()) return s;
  std::vector<int> column_of_row(static_cast<std::size_t>(s.dofs()), RowSplit::dof);
  for (std::size_t i = 0; i < supports.size(); ++i) {
    s.supports.x.push_back(hold(s, supports[i], i, place_of(i, supports.size()), column_of_row));
  }
  const RowSplit rows(column_of_row);
  s.supports.stiffness = rows.split(s.stiffness, s.supports.columns());
  s.supports.mass = rows.split(s.mass, s.supports.columns());
  if (s.damping.rows() > 0) s.supports.damping = rows.split(s.damping, s.supports.columns());
  std::vector<int> motion, node_of_row;
  for (std::size_t r = 0; r < column_of_row.size(); ++r) {
    if (column_of_row[r] != RowSplit::dof) continue;
    motion.push_back(s.motion[r]);
    node_of_row.push_back(s.node_of_row[r]);
  }
  s.motion = std::move(motion);
  s.node_of_row = std::move(node_of_row);
  for (auto& [name, node] : s.nodes) {
    for (std::vector<int>& of_motion : node.rows) {
      std::erase_if(of_motion, [&](int row) { return rows[row] == held; });
      for (int& row : of_motion) row = rows[row];
    }
  }
  for (DeckRow& section : s.sections) {
    DofSum moving;
    for (const auto& [row, value] : section.sum) {
      const auto column = column_of_row[static_cast<std::size_t>(row)];
      if (column != RowSplit::resting)
        moving.emplace_back(column == RowSplit::dof ? rows[row] : support_dof(column), value);
    }
    section.sum = std::move(moving);
  }
  return s;
}

Eigen::MatrixXd translations(const FeStructure& structure) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(structure.dofs(), 2);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (structure.node_of_row[row] == no_node) continue;  // an inner mode rests in rigid motions
    const auto motion = static_cast<std::size_t>(structure.motion[row]);
    if (motion == y_dof || motion == z_dof) r(i, static_cast<Eigen::Index>(motion - y_dof)) = 1.0;
  }
  return r;
}

void stand_on_ground(const std::vector<int>& nodes, FeStructure& structure, StructureSupports& supports) {
  const auto loose = std::find_if(nodes.begin(), nodes.end(),
                                  [&](int name) { return !loose_motions(structure.nodes.at(name)).empty(); });
  if (loose != nodes.end() && !supports.alike_only()) {
    const std::string motions =
        fmt::format("{}", fmt::join(loose_motions(structure.nodes.at(*loose)), " and none of "));
    supports.beyond =
        fmt::format("whose deck node {} has no row of {}, and no [[support]] that holds it there", *loose, motions);
    for (Columns* matrix : {&supports.stiffness, &supports.damping, &supports.mass})
      append_support(Eigen::MatrixXd::Zero(structure.dofs(), 2), *matrix);
    supports.x.push_back(supports.x.empty() ? 0.0 : supports.x.front());
  }
  if (!supports.alike_only()) return;
  const int missing = supports.columns() - 2;
  for (int name : nodes) {
    std::array<int, 2>& support = structure.nodes.at(name).support;
    for (int component = 0; component < 2; ++component) {
      int& column = support[static_cast<std::size_t>(component)];
      if (column == held) column = missing + component;
    }
  }
}

void settle_supports(const FeMatrices& m, const Eigen::MatrixXd& translation, const RowName& name,
                     StructureSupports& s) {
  Resistances resistances{resistance(m.stiffness, s.stiffness, translation),
                          resistance(m.damping, s.damping, translation)};
  s.beyond = s.columns() == 0 ? "without [[support]], whose matrices do not have the supports' own rows"
                              : settle_declared_supports(m, translation, name, s, resistances);
  if (!s.alike_only()) return;
  append_support(-resistances.strained, s.stiffness);
  append_support(-resistances.braked, s.damping);
  append_support(Eigen::MatrixXd::Zero(m.mass.rows(), 2), s.mass);
  s.x.push_back(s.x.empty() ? 0.0 : s.x.front());
}

}  // namespace railtab
