#include "railtab/runtime/vsi/structure_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

void require_finite(const Sparse& matrix, std::string_view name) {
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry) {
      if (!std::isfinite(entry.value())) {
        throw input_error(
            fmt::format("{} matrix of the structure, row {}, column {}", name, entry.row() + 1, column + 1),
            fmt::format("{}", entry.value()), "a finite number");
      }
    }
  }
}

void require_finite(const StructureModel& structure) {
  require_finite(structure.mass, "mass");
  require_finite(structure.damping, "damping");
  require_finite(structure.stiffness, "stiffness");
}

std::unique_ptr<Eigen::SimplicialLDLT<Sparse>> factorise(const Sparse& effective) {
  auto factor = std::make_unique<Eigen::SimplicialLDLT<Sparse>>(effective);
  if (factor->info() != Eigen::Success || !(factor->vectorD().minCoeff() > 0.0)) {
    throw ComputationError("the structure's effective matrix is not positive definite: check supports and stiffnesses");
  }
  return factor;
}

// Six right-hand sides side by side, in the factor's order of unknowns.
using SixColumns = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

// Far from its load a compliance (1e-9 m/N under it) decays until it is a denormal number, on which a processor is a
// hundred times slower: below 1e-40 it is set to zero. Returns whether all six are.
bool flush(double* x) {
  bool zero = true;
  for (int k = 0; k < 6; ++k) {
    if (std::abs(x[k]) < 1e-40) x[k] = 0.0;
    zero = zero && x[k] == 0.0;
  }
  return zero;
}

// L D Lᵀ x = b for six right-hand sides at once: the factor is read once instead of six times, which is what a solve
// costs. Rows of b before `first` are zero.
void solve_six(const Sparse& L, const Eigen::VectorXd& D, int first, SixColumns& x) {
  const int* begin = L.outerIndexPtr();
  const int* count = L.innerNonZeroPtr();  // null where compressed
  const int* row = L.innerIndexPtr();
  const double* value = L.valuePtr();
  double* data = x.data();
  const int n = static_cast<int>(L.outerSize());
  for (int j = first; j < n; ++j) {
    const double* xj = data + 6 * j;
    if (flush(data + 6 * j)) continue;
    const int end = count ? begin[j] + count[j] : begin[j + 1];
    for (int p = begin[j]; p < end; ++p) {
      double* xi = data + 6 * row[p];
      for (int k = 0; k < 6; ++k) xi[k] -= value[p] * xj[k];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    double* xj = data + 6 * j;
    double sum[6];
    for (int k = 0; k < 6; ++k) sum[k] = xj[k] / D[j];
    const int end = count ? begin[j] + count[j] : begin[j + 1];
    for (int p = begin[j]; p < end; ++p) {
      const double* xi = data + 6 * row[p];
      for (int k = 0; k < 6; ++k) sum[k] -= value[p] * xi[k];
    }
    for (int k = 0; k < 6; ++k) xj[k] = sum[k];
    flush(xj);
  }
}

// The three rows of a contact over its element's 12 dofs.
Eigen::Matrix<double, 3, 12> rows_of(const RailContact& contact) {
  Eigen::Matrix<double, 3, 12> rows;
  for (std::size_t k = 0; k < 12; ++k)
    rows.col(static_cast<Eigen::Index>(k)) << contact.rows.y[k], contact.rows.z[k], contact.rows.roll[k];
  return rows;
}

}  // namespace

RailContact rail_contact(const StructureModel& structure, RailSide side, double x) noexcept {
  RailContact contact;
  contact.side = side;
  const RailLine& rail = structure.rail[static_cast<std::size_t>(side)];
  contact.on_rail = contains(rail, x);
  if (!contact.on_rail) return contact;
  const auto after = std::upper_bound(rail.x.begin(), rail.x.end(), x);
  const auto last = static_cast<int>(rail.x.size()) - 2;
  contact.element = std::clamp(static_cast<int>(after - rail.x.begin()) - 1, 0, last);
  contact.rows = rail_interpolation(rail, x);
  return contact;
}

Eigen::Vector3d rail_head(const RailContact& contact, const Eigen::VectorXd& dofs) noexcept {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  if (!contact.on_rail) return value;
  for (std::size_t k = 0; k < 12; ++k) {
    if (contact.rows.dof[k] == held) continue;
    value += dofs[contact.rows.dof[k]] * Eigen::Vector3d(contact.rows.y[k], contact.rows.z[k], contact.rows.roll[k]);
  }
  return value;
}

void add_rail_load(const RailContact& contact, const Eigen::Vector3d& load, Eigen::VectorXd& loads) noexcept {
  if (!contact.on_rail) return;
  for (std::size_t k = 0; k < 12; ++k) {
    if (contact.rows.dof[k] == held) continue;
    loads[contact.rows.dof[k]] +=
        contact.rows.y[k] * load[0] + contact.rows.z[k] * load[1] + contact.rows.roll[k] * load[2];
  }
}

StructureResponse::StructureResponse(const StructureModel& structure, const HhtScheme& scheme)
    : dofs_(structure.dofs()) {
  require_finite(structure);
  const Sparse effective = scheme.acceleration_rate() * structure.mass +
                           scheme.load_weight() * (scheme.velocity_rate() * structure.damping + structure.stiffness);
  factor_ = factorise(effective);
}

StructureResponse::StructureResponse(const StructureModel& structure) : dofs_(structure.dofs()) {
  require_finite(structure);
  factor_ = factorise(structure.stiffness);
}

void StructureResponse::free_increment(const StructureModel& structure, const HhtScheme& scheme,
                                       const LinearMotion& motion, const Prediction& prediction,
                                       Eigen::VectorXd& increment) const {
  Eigen::VectorXd load = -scheme.alpha * motion.contact_load;
  load.noalias() -= structure.damping.selfadjointView<Eigen::Lower>() * prediction.weighted_velocity;
  load.noalias() -= structure.stiffness.selfadjointView<Eigen::Lower>() * prediction.weighted_displacement;
  increment = factor_->solve(load);
}

void StructureResponse::tabulate_compliance(const StructureModel& structure, double window) {
  // A wheel is always coupled to both nodes of its own element, however long that is.
  for (const RailLine& rail : structure.rail) {
    for (std::size_t i = 1; i < rail.x.size(); ++i) window = std::max(window, rail.x[i] - rail.x[i - 1]);
  }
  const auto& order = factor_->permutationP().indices();
  const Sparse& L = factor_->matrixL().nestedExpression();  // below the diagonal; the diagonal is one
  const Eigen::VectorXd D = factor_->vectorD();
  SixColumns response;
  for (std::size_t side = 0; side < 2; ++side) {
    const RailLine& rail = structure.rail[side];
    column_[side].assign(rail.x.size(), {});
    for (std::size_t node = 0; node < rail.x.size(); ++node) {
      response.setZero(dofs_, 6);
      int first = static_cast<int>(dofs_);
      for (std::size_t k = 0; k < 6; ++k) {
        if (rail.dof[node][k] == held) continue;
        const int row = order[rail.dof[node][k]];
        response(row, static_cast<Eigen::Index>(k)) = 1.0;
        first = std::min(first, row);
      }
      solve_six(L, D, first, response);
      Column& column = column_[side][node];
      for (std::size_t other = 0; other < 2; ++other) {
        const RailLine& to = structure.rail[other];
        const auto begin = std::lower_bound(to.x.begin(), to.x.end(), rail.x[node] - window);
        const auto end = std::upper_bound(to.x.begin(), to.x.end(), rail.x[node] + window);
        column.first[other] = static_cast<int>(begin - to.x.begin());
        for (auto n = begin - to.x.begin(); n < end - to.x.begin(); ++n) {
          Block block = Block::Zero();
          for (std::size_t k = 0; k < 6; ++k) {
            const int dof = to.dof[static_cast<std::size_t>(n)][k];
            if (dof != held) block.row(static_cast<Eigen::Index>(k)) = response.row(order[dof]);
          }
          column.rows[other].push_back(block);
        }
      }
    }
  }
}

template <class Rows, class Columns>
auto StructureResponse::between(const RailContact& i, const Rows& row, const RailContact& j,
                                const Columns& column) const noexcept {
  Eigen::Matrix<double, Rows::RowsAtCompileTime, Columns::RowsAtCompileTime> result;
  result.setZero();
  if (!i.on_rail || !j.on_rail) return result;
  const auto row_side = static_cast<std::size_t>(i.side);
  for (int q = 0; q < 2; ++q) {
    const Column& from = column_[static_cast<std::size_t>(j.side)][static_cast<std::size_t>(j.element + q)];
    const auto count = static_cast<int>(from.rows[row_side].size());
    for (int p = 0; p < 2; ++p) {
      const int offset = i.element + p - from.first[row_side];
      if (offset < 0 || offset >= count) continue;
      const Block& block = from.rows[row_side][static_cast<std::size_t>(offset)];
      result.noalias() +=
          row.template middleCols<6>(6 * p) * (block * column.template middleCols<6>(6 * q).transpose());
    }
  }
  return result;
}

Eigen::Matrix3d StructureResponse::compliance(const RailContact& i, const RailContact& j) const noexcept {
  return between(i, rows_of(i), j, rows_of(j));
}

Eigen::Vector3d StructureResponse::vertical_compliance(const RailContact& i, const RailContact& j) const noexcept {
  using Row = Eigen::Matrix<double, 1, 12>;
  Eigen::Matrix<double, 3, 12> rows;
  rows.row(0) = Row::Map(i.rows.z.data());
  rows.row(1) = -Row::Map(i.rows.pitch.data());
  rows.row(2) = Row::Map(i.rows.bend.data());
  return between(i, rows, j, Row(Row::Map(j.rows.z.data())));
}

Eigen::MatrixXd StructureResponse::compliance_at(const std::vector<RailContact>& contacts) const {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(dofs_, 3 * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(dofs_);
      add_rail_load(contacts[static_cast<std::size_t>(j)], Eigen::Vector3d::Unit(k), column);
      loads.col(3 * j + k) = column;
    }
  }
  const Eigen::MatrixXd response = factor_->solve(loads);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < 3 * n; ++j) {
      result.block<3, 1>(3 * i, j) = rail_head(contacts[static_cast<std::size_t>(i)], response.col(j));
    }
  }
  return result;
}

}  // namespace railtab
