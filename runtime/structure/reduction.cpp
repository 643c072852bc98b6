#include "railtab/runtime/structure/reduction.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"

namespace railtab {

namespace {

using Matrix = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

/// Which part of the structure an unknown belongs to.
struct Parts {
  static constexpr int kept = -1;
  std::vector<int> of;                    // per unknown: its part, or kept
  std::vector<std::vector<int>> members;  // of the parts
};

// What hangs together once the rails are taken away.
Parts find_parts(const StructureModel& structure, const Sparse& pattern, std::size_t smallest) {
  constexpr int unseen = -2;
  Parts parts;
  parts.of.assign(index(structure.dofs()), unseen);
  for (const RailLine& rail : structure.rail) {
    for (const DofIndices& node : rail.dof) {
      for (int dof : node) {
        if (dof != held) parts.of[index(dof)] = Parts::kept;
      }
    }
  }
  for (int start = 0; start < structure.dofs(); ++start) {
    if (parts.of[index(start)] != unseen) continue;
    std::vector<int> reached{start};
    const int part = static_cast<int>(parts.members.size());
    parts.of[index(start)] = part;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (Sparse::InnerIterator entry(pattern, reached[i]); entry; ++entry) {
        int& other = parts.of[static_cast<std::size_t>(entry.row())];
        if (other != unseen) continue;
        other = part;
        reached.push_back(static_cast<int>(entry.row()));
      }
    }
    if (reached.size() < smallest) {
      for (int dof : reached) parts.of[index(dof)] = Parts::kept;
    } else {
      std::sort(reached.begin(), reached.end());
      parts.members.push_back(std::move(reached));
    }
  }
  return parts;
}

Sparse block(const Sparse& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), held);
  for (std::size_t i = 0; i < rows.size(); ++i) place[index(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (Sparse::InnerIterator entry(matrix, columns[j]); entry; ++entry) {
      const int i = place[static_cast<std::size_t>(entry.row())];
      if (i != held) entries.emplace_back(i, static_cast<int>(j), entry.value());
    }
  }
  Sparse result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Unknowns outside a part that it is tied to.
std::vector<int> neighbours(const Sparse& pattern, const std::vector<int>& members, const std::vector<int>& of) {
  std::vector<int> found;
  for (int dof : members) {
    for (Sparse::InnerIterator entry(pattern, dof); entry; ++entry) {
      if (of[static_cast<std::size_t>(entry.row())] == Parts::kept) found.push_back(static_cast<int>(entry.row()));
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Columns of u = T p for one part: its answers [Ψ Φ] to the neighbours and its own modes.
Matrix answers(const StructureModel& structure, const std::vector<int>& members, const std::vector<int>& boundary,
               int modes) {
  const Sparse stiffness = block(structure.stiffness, members, members);
  const ModalBasis fixed = lowest_modes(stiffness, block(structure.mass, members, members), modes);
  const Eigen::SimplicialLDLT<Sparse> factor(stiffness);
  Matrix result(members.size(), boundary.size() + static_cast<std::size_t>(fixed.shape.cols()));
  result.leftCols(static_cast<Eigen::Index>(boundary.size())) =
      -factor.solve(Matrix(block(structure.stiffness, members, boundary)));
  result.rightCols(fixed.shape.cols()) = fixed.shape;
  return result;
}

// Loads of the supports' motion by the columns of u = T p, for unknowns that are relative to it.
template <class Transformation>
StructureSupports project_supports(const StructureSupports& supports, const Transformation& transposed) {
  StructureSupports projected;
  if (supports.carried.size() == 0) return projected;
  const auto columns = [&](const StructureSupports::Columns& matrix) -> StructureSupports::Columns {
    const Matrix product = transposed * Sparse(matrix);
    return product.sparseView();
  };
  projected.x = supports.x;
  projected.beyond = supports.beyond;
  projected.mass = columns(supports.mass);
  projected.damping = columns(supports.damping);
  projected.stiffness.resize(transposed.rows(), supports.columns());
  projected.carried = supports.carried;
  projected.carried_nodes = supports.carried_nodes;
  return projected;
}

// Nodes of interest by the rows of u = T p.
void take_nodes(const StructureModel& structure, const Eigen::SparseMatrix<double, Eigen::RowMajor>& T,
                StructureModel& reduced) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < structure.nodes.size(); ++n) {
    for (std::size_t k = 0; k < 6; ++k) {
      const int dof = structure.nodes[n].dof[k];
      if (dof == held) continue;
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(T, dof); entry; ++entry)
        entries.emplace_back(static_cast<int>(6 * n + k), static_cast<int>(entry.col()), entry.value());
    }
  }
  reduced.nodes = structure.nodes;
  reduced.node_rows.resize(static_cast<Eigen::Index>(6 * structure.nodes.size()), T.cols());
  reduced.node_rows.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace

std::string_view reduction_name(Reduction reduction) noexcept {
  switch (reduction) {
    case Reduction::modal:
      return "modal";
    case Reduction::craig_bampton:
      return "craig-bampton";
    case Reduction::window:
      return "window";
    case Reduction::none:
      break;
  }
  return "none";
}

void ReductionParameters::validate() const {
  require_between("structure.modes", modes, 1, 2000, "-");
  require_between("structure.window_ahead", ahead, 5.0, 1e5, "m");
  require_between("structure.window_behind", behind, 5.0, 1e5, "m");
}

StructureModel reduce_to_modes(const StructureModel& structure, int modes) {
  const ModalBasis modal = lowest_modes(structure.stiffness, structure.mass, modes);
  const Eigen::Index n = modal.omega2.size();
  const Matrix damping = modal.shape.transpose() * (structure.damping * modal.shape);
  StructureModel reduced;
  reduced.mass = Matrix::Identity(n, n).sparseView();
  reduced.stiffness = Matrix(modal.omega2.asDiagonal()).sparseView();
  reduced.damping = Matrix(0.5 * (damping + damping.transpose())).sparseView();
  reduced.rail = structure.rail;
  reduced.basis = modal.shape;
  reduced.supports = project_supports(structure.supports, Matrix(modal.shape.transpose()));
  take_nodes(structure, modal.shape.sparseView(), reduced);
  return reduced;
}

StructureModel reduce_parts(const StructureModel& structure, int modes) {
  const Sparse pattern = structure.stiffness + structure.mass + structure.damping;
  const Parts parts = find_parts(structure, pattern, index(std::max(60, modes)));
  // Unknowns p: those that are kept in their order, then the modes of each part.
  std::vector<int> place(index(structure.dofs()), held);
  int unknowns = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (parts.of[i] == Parts::kept) place[i] = unknowns++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] != held) entries.emplace_back(static_cast<int>(i), place[i], 1.0);
  }
  for (const std::vector<int>& members : parts.members) {
    const std::vector<int> boundary = neighbours(pattern, members, parts.of);
    const Matrix columns = answers(structure, members, boundary, modes);
    for (Eigen::Index j = 0; j < columns.cols(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      const int column = k < boundary.size() ? place[index(boundary[k])] : unknowns++;
      for (Eigen::Index i = 0; i < columns.rows(); ++i) {
        if (columns(i, j) != 0.0) entries.emplace_back(members[static_cast<std::size_t>(i)], column, columns(i, j));
      }
    }
  }
  Sparse T(structure.dofs(), unknowns);
  T.setFromTriplets(entries.begin(), entries.end());
  StructureModel reduced;
  const Sparse transposed = T.transpose();
  const auto project = [&](const Sparse& matrix) {
    const Sparse projected = transposed * (matrix * T);
    return Sparse(0.5 * (projected + Sparse(projected.transpose())));
  };
  reduced.mass = project(structure.mass);
  reduced.damping = project(structure.damping);
  reduced.stiffness = project(structure.stiffness);
  reduced.rail = structure.rail;
  for (RailLine& rail : reduced.rail) {
    for (DofIndices& node : rail.dof) {
      for (int& dof : node) dof = dof == held ? held : place[index(dof)];
    }
  }
  take_nodes(structure, T, reduced);
  reduced.supports = project_supports(structure.supports, transposed);
  if (reduced.supports.columns() == 0) return reduced;
  // rails have other numbers now
  std::vector<Eigen::Triplet<double>> carried;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == held) continue;
    const auto row = static_cast<Eigen::Index>(i);
    for (StructureSupports::Columns::InnerIterator entry(structure.supports.carried, row); entry; ++entry)
      carried.emplace_back(place[i], static_cast<int>(entry.col()), entry.value());
  }
  reduced.supports.carried.resize(unknowns, structure.supports.columns());
  reduced.supports.carried.setFromTriplets(carried.begin(), carried.end());
  return reduced;
}

}  // namespace railtab
