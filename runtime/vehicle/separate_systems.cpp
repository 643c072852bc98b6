#include "railtab/runtime/vehicle/separate_systems.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/joined_groups.hpp"

namespace railtab {

namespace {

void join_coaches(const VehicleModel& vehicle, JoinedGroups& groups) {
  std::map<int, int> first;  // dof of each coach
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    for (const int dof : vehicle.dof[b]) {
      if (dof != held) groups.join(first.emplace(vehicle.bodies[b].coach, dof).first->second, dof);
    }
  }
}

void join_coupled(const VehicleModel& vehicle, JoinedGroups& groups) {
  for (const Eigen::MatrixXd* matrix : {&vehicle.mass, &vehicle.damping, &vehicle.stiffness, &vehicle.gyroscopic}) {
    for (int j = 0; j < static_cast<int>(matrix->cols()); ++j) {
      for (int i = 0; i < static_cast<int>(matrix->rows()); ++i) {
        if ((*matrix)(i, j) != 0.0) groups.join(i, j);
      }
    }
  }
}

int first_dof(const Eigen::MatrixXd& rows, int row) {
  for (int j = 0; j < static_cast<int>(rows.cols()); ++j) {
    if (rows(row, j) != 0.0) return j;
  }
  return held;
}

void join_by_elements(const ForceElements& elements, JoinedGroups& groups) {
  for (int row = 0; row < elements.elongations(); ++row) {
    const int first = first_dof(elements.rows, row);
    for (int j = first; first != held && j < static_cast<int>(elements.rows.cols()); ++j) {
      if (elements.rows(row, j) != 0.0) groups.join(first, j);
    }
  }
  for (const ForceElement& e : elements.element) {
    if (e.load_row >= 0) groups.join(first_dof(elements.rows, e.row), first_dof(elements.rows, e.load_row));
  }
}

bool is_whole(const std::vector<std::vector<int>>& dofs) { return dofs.size() == 1; }

}  // namespace

std::vector<SeparateSystem> separate_systems(const VehicleModel& vehicle) {
  JoinedGroups groups(index(vehicle.dofs()));
  join_coaches(vehicle, groups);
  join_coupled(vehicle, groups);
  join_by_elements(vehicle.elements, groups);

  std::vector<SeparateSystem> systems;
  std::map<int, std::size_t> number;  // of the system of each group, by its first dof
  const auto system_of = [&](int dof) -> SeparateSystem& {
    const auto [known, is_new] = number.emplace(groups.first(dof), systems.size());
    if (is_new) systems.emplace_back();
    return systems[known->second];
  };
  for (int dof = 0; dof < vehicle.dofs(); ++dof) system_of(dof).dofs.push_back(dof);
  if (systems.empty()) systems.emplace_back();
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const DofIndices& dof = vehicle.dof[index(vehicle.wheelsets[w])];
    const auto free = std::find_if(dof.begin(), dof.end(), [](int d) { return d != held; });
    (free == dof.end() ? systems.front() : system_of(*free)).wheelsets.push_back(static_cast<int>(w));
  }
  const ForceElements& elements = vehicle.elements;
  for (int row = 0; row < elements.elongations(); ++row) {
    system_of(first_dof(elements.rows, row)).elongations.push_back(row);
  }
  for (std::size_t e = 0; e < elements.element.size(); ++e) {
    system_of(first_dof(elements.rows, elements.element[e].row)).elements.push_back(static_cast<int>(e));
  }
  return systems;
}

SeparateMatrix::SeparateMatrix(const std::vector<SeparateSystem>& systems, const Eigen::MatrixXd& whole) {
  for (const SeparateSystem& system : systems) {
    dofs_.push_back(system.dofs);
    matrix_.push_back(systems.size() == 1 ? whole : Eigen::MatrixXd(whole(system.dofs, system.dofs)));
  }
}

Eigen::VectorXd SeparateMatrix::operator*(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  add_product(1.0, x, product);
  return product;
}

void SeparateMatrix::add_product(double factor, const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  if (is_whole(dofs_)) {
    y.noalias() += factor * matrix_.front() * x;
    return;
  }
  for (std::size_t s = 0; s < dofs_.size(); ++s) {
    const std::vector<int>& dofs = dofs_[s];
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const auto column = matrix_[s].col(static_cast<Eigen::Index>(j));
      const double of_column = factor * x[dofs[j]];
      for (std::size_t i = 0; i < dofs.size(); ++i) y[dofs[i]] += of_column * column[static_cast<Eigen::Index>(i)];
    }
  }
}

ForceElements elements_of(const SeparateSystem& system, const ForceElements& elements) {
  ForceElements own;
  own.rows = elements.rows(system.elongations, system.dofs);
  const auto number = [&](int row) {
    const auto found = std::lower_bound(system.elongations.begin(), system.elongations.end(), row);
    return static_cast<int>(found - system.elongations.begin());
  };
  for (const int e : system.elements) {
    own.element.push_back(elements.element[index(e)]);
    ForceElement& element = own.element.back();
    element.row = number(element.row);
    if (element.load_row >= 0) element.load_row = number(element.load_row);
  }
  return own;
}

}  // namespace railtab
