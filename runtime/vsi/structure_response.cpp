#include "railtab/runtime/vsi/structure_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "railtab/tables/input_error.hpp"
#include "selected_solve.hpp"

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

template <class Factor>
std::unique_ptr<Factor> factorise(const Sparse& effective) {
  auto factor = std::make_unique<Factor>(effective);
  if (factor->info() != Eigen::Success || !(factor->vectorD().minCoeff() > 0.0)) {
    throw ComputationError("the structure's effective matrix is not positive definite: check supports and stiffnesses");
  }
  return factor;
}

// The unknowns of nodes in the factor's order, held ones left out.
void append_rows(const DofIndices& dof, const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order,
                 std::vector<int>& rows) {
  for (int d : dof) {
    if (d != held) rows.push_back(order.indices()[d]);
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
  effective_ = scheme.acceleration_rate() * structure.mass +
               scheme.load_weight() * (scheme.velocity_rate() * structure.damping + structure.stiffness);
  factor_ = factorise<SmallFactor>(effective_);
}

StructureResponse::StructureResponse(const StructureModel& structure) : dofs_(structure.dofs()) {
  require_finite(structure);
  effective_ = structure.stiffness;
  factor_ = factorise<SmallFactor>(effective_);
  low_factor_ = low_factor();
}

std::shared_ptr<const StructureResponse::LowFactor> StructureResponse::low_factor() const {
  return low_factor_ ? low_factor_ : std::shared_ptr<const LowFactor>(factorise<LowFactor>(effective_));
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
  const std::shared_ptr<const LowFactor> factor = low_factor();
  const auto& order = factor->permutationP();
  const Sparse& L = factor->matrixL().nestedExpression();  // below the diagonal; the diagonal is one
  SelectedSolve solve(L, factor->vectorD());
  SelectedSolve::Columns loads;
  std::vector<int> loaded, wanted;
  for (std::size_t side = 0; side < 2; ++side) {
    const RailLine& rail = structure.rail[side];
    column_[side].assign(rail.x.size(), {});
    for (std::size_t node = 0; node < rail.x.size(); ++node) {
      Column& column = column_[side][node];
      std::array<std::size_t, 2> last{};  // of the window on each rail
      wanted.clear();
      for (std::size_t other = 0; other < 2; ++other) {
        const RailLine& to = structure.rail[other];
        const auto begin = std::lower_bound(to.x.begin(), to.x.end(), rail.x[node] - window) - to.x.begin();
        const auto end = std::upper_bound(to.x.begin(), to.x.end(), rail.x[node] + window) - to.x.begin();
        column.first[other] = static_cast<int>(begin);
        last[other] = static_cast<std::size_t>(end);
        for (auto n = begin; n < end; ++n) append_rows(to.dof[static_cast<std::size_t>(n)], order, wanted);
      }
      loaded.clear();
      append_rows(rail.dof[node], order, loaded);
      loads.setZero(static_cast<Eigen::Index>(loaded.size()), 6);
      for (int k = 0, i = 0; k < 6; ++k) {
        if (rail.dof[node][static_cast<std::size_t>(k)] != held) loads(i++, k) = 1.0;
      }
      solve.want(wanted);
      solve.solve(loaded, loads);
      for (std::size_t other = 0; other < 2; ++other) {
        for (auto n = static_cast<std::size_t>(column.first[other]); n < last[other]; ++n) {
          Block block = Block::Zero();
          for (std::size_t k = 0; k < 6; ++k) {
            const int dof = structure.rail[other].dof[n][k];
            if (dof != held) block.row(static_cast<Eigen::Index>(k)) = solve.x(order.indices()[dof]);
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
  const std::shared_ptr<const LowFactor> factor = low_factor();
  const auto& order = factor->permutationP().indices();
  const Sparse& L = factor->matrixL().nestedExpression();
  SelectedSolve solve(L, factor->vectorD());
  std::vector<int> rows;
  const auto append = [&](const RailContact& contact) {
    if (!contact.on_rail) return;
    for (int dof : contact.rows.dof) {
      if (dof != held) rows.push_back(order[dof]);
    }
  };
  for (const RailContact& contact : contacts) append(contact);
  solve.want(rows);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  SelectedSolve::Columns loads;
  for (Eigen::Index j = 0; j < n; ++j) {
    const RailContact& from = contacts[static_cast<std::size_t>(j)];
    rows.clear();
    append(from);
    loads.setZero(static_cast<Eigen::Index>(rows.size()), 6);
    for (std::size_t k = 0, i = 0; k < 12 && from.on_rail; ++k) {
      if (from.rows.dof[k] == held) continue;
      loads.row(static_cast<Eigen::Index>(i++)).head<3>() << from.rows.y[k], from.rows.z[k], from.rows.roll[k];
    }
    solve.solve(rows, loads);
    for (Eigen::Index i = 0; i < n; ++i) {
      const RailContact& to = contacts[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < 12 && to.on_rail; ++k) {
        if (to.rows.dof[k] == held) continue;
        result.block<3, 3>(3 * i, 3 * j) +=
            Eigen::Vector3d(to.rows.y[k], to.rows.z[k], to.rows.roll[k]) * solve.x(order[to.rows.dof[k]]).head<3>();
      }
    }
  }
  return result;
}

}  // namespace railtab
