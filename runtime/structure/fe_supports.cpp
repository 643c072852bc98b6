#include "fe_supports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/vehicle/motion_names.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Columns = StructureSupports::Columns;

constexpr std::size_t lateral = 1, vertical = 2;  // what the ground moves; else it holds at rest

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

/// Says of every row that a support holds what becomes of it; returns the support's place along the track [m].
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
      const bool moves = k == lateral || k == vertical;
      const int to = moves ? static_cast<int>(2 * number + k - lateral) : RowSplit::resting;
      if (moves) node.support[k - lateral] = to;
      for (int row : node.rows[k]) {
        int& column = column_of_row[static_cast<std::size_t>(row)];
        if (column != RowSplit::unknown) {
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

/// A r + ΣA_s, what a translation of everything meets; zero where it is rounding of what it is made of.
Eigen::MatrixXd resistance(const Sparse& matrix, const Columns& of_supports, const Eigen::MatrixXd& translation) {
  constexpr double rounding = 1e-8;  // of matrices written with ten digits
  Eigen::MatrixXd sum = matrix * translation + of_all(of_supports, matrix.rows());
  const Eigen::MatrixXd parts = matrix.cwiseAbs() * translation.cwiseAbs();
  for (Eigen::Index j = 0; j < 2; ++j) {
    for (Eigen::Index i = 0; i < sum.rows(); ++i) {
      if (std::abs(sum(i, j)) <= rounding * parts(i, j)) sum(i, j) = 0.0;
    }
  }
  return sum;
}

/// a of what C r has of a·m + b·k, m and k what the translation meets of mass and stiffness.
double mass_share(const Eigen::MatrixXd& damping, const Eigen::MatrixXd& mass, const Eigen::MatrixXd& stiffness) {
  const double mm = mass.squaredNorm(), kk = stiffness.squaredNorm(), mk = mass.cwiseProduct(stiffness).sum();
  const double cm = damping.cwiseProduct(mass).sum(), ck = damping.cwiseProduct(stiffness).sum();
  if (mm == 0.0) return 0.0;
  if (kk == 0.0) return cm / mm;
  return (cm * kk - ck * mk) / (mm * kk - mk * mk);
}

void append_support(const Eigen::MatrixXd& columns, Columns& matrix) {
  Columns wider(columns.rows(), matrix.cols() + 2);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    wider.startVec(i);
    if (matrix.cols() > 0) {
      for (Columns::InnerIterator entry(matrix, i); entry; ++entry) wider.insertBack(i, entry.col()) = entry.value();
    }
    for (Eigen::Index number = 0; number < 2; ++number) {
      if (columns(i, number) != 0.0) wider.insertBack(i, matrix.cols() + number) = columns(i, number);
    }
  }
  wider.finalize();
  matrix = std::move(wider);
}

}  // namespace

RowSplit::RowSplit(std::vector<int> column_of_row) : column_(std::move(column_of_row)) {
  for (int column : column_) number_.push_back(column == unknown ? unknowns_++ : held);
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
      if (column == unknown) {
        inner.emplace_back(row, number_[static_cast<std::size_t>(j)], entry.value());
      } else {
        outer.emplace_back(row, column, entry.value());
      }
    }
  }
  matrix.resize(unknowns_, unknowns_);
  matrix.setFromTriplets(inner.begin(), inner.end());
  Columns of_supports(unknowns_, columns);
  of_supports.setFromTriplets(outer.begin(), outer.end());
  return of_supports;
}

FeStructure on_supports(FeStructure s, const std::vector<FeSupport>& supports) {
  if (supports.empty()) return s;
  std::vector<int> column_of_row(static_cast<std::size_t>(s.dofs()), RowSplit::unknown);
  for (std::size_t i = 0; i < supports.size(); ++i) {
    s.supports.x.push_back(hold(s, supports[i], i, place_of(i, supports.size()), column_of_row));
  }
  const RowSplit rows(column_of_row);
  s.supports.stiffness = rows.split(s.stiffness, s.supports.columns());
  s.supports.mass = rows.split(s.mass, s.supports.columns());
  if (s.damping.rows() > 0) s.supports.damping = rows.split(s.damping, s.supports.columns());
  std::vector<int> motion, node_of_row;
  for (std::size_t r = 0; r < column_of_row.size(); ++r) {
    if (column_of_row[r] != RowSplit::unknown) continue;
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
  return s;
}

Eigen::MatrixXd translations(const FeStructure& structure) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(structure.dofs(), 2);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (structure.node_of_row[row] == no_node) continue;  // an inner mode rests in rigid motions
    const auto motion = static_cast<std::size_t>(structure.motion[row]);
    if (motion == lateral || motion == vertical) r(i, static_cast<Eigen::Index>(motion - lateral)) = 1.0;
  }
  return r;
}

void stand_on_ground(const std::vector<int>& nodes, FeStructure& structure, StructureSupports& supports) {
  const bool any = std::any_of(nodes.begin(), nodes.end(), [&](int name) {
    const FeNode& node = structure.nodes.at(name);
    return (node.rows[lateral].empty() && node.support[0] == held) ||
           (node.rows[vertical].empty() && node.support[1] == held);
  });
  if (any && !supports.alike_only) {
    supports.alike_only = true;
    for (Columns* matrix : {&supports.stiffness, &supports.damping, &supports.mass})
      append_support(Eigen::MatrixXd::Zero(structure.dofs(), 2), *matrix);
    supports.x.push_back(supports.x.empty() ? 0.0 : supports.x.front());
  }
  if (!supports.alike_only) return;
  const int missing = supports.columns() - 2;
  for (int name : nodes) {
    std::array<int, 2>& support = structure.nodes.at(name).support;
    for (int component = 0; component < 2; ++component) {
      int& column = support[static_cast<std::size_t>(component)];
      if (column == held) column = missing + component;
    }
  }
}

void settle_supports(const Sparse& mass, const Sparse& damping, const Sparse& stiffness,
                     const Eigen::MatrixXd& translation, StructureSupports& s) {
  const Eigen::MatrixXd missing = resistance(stiffness, s.stiffness, translation);
  if (s.columns() > 0) {
    const Eigen::MatrixXd inertia = mass * translation + of_all(s.mass, mass.rows());
    const double a = mass_share(resistance(damping, s.damping, translation), inertia, missing);
    const Eigen::MatrixXd parts = damping.cwiseAbs() * translation;
    constexpr double rounding = 1e-9;
    if (a * inertia.norm() > rounding * parts.norm()) {
      const Sparse carried = carried_by_supports(stiffness, s.stiffness);
      Sparse of_mass = mass * carried;
      of_mass += Sparse(s.mass);
      s.damping = Sparse(s.damping) - a * of_mass;
    }
  }
  const Eigen::MatrixXd braking = resistance(damping, s.damping, translation);
  if (missing.isZero(0.0) && braking.isZero(0.0)) return;
  s.alike_only = true;
  append_support(-missing, s.stiffness);
  append_support(-braking, s.damping);
  append_support(Eigen::MatrixXd::Zero(mass.rows(), 2), s.mass);
  s.x.push_back(s.x.empty() ? 0.0 : s.x.front());
}

}  // namespace railtab
