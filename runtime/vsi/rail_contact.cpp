#include "railtab/runtime/vsi/rail_contact.hpp"

namespace railtab {

RailContact rail_contact(const StructureModel& structure, RailSide side, double x) noexcept {
  RailContact contact;
  contact.side = side;
  const RailLine& rail = structure.rail[static_cast<std::size_t>(side)];
  contact.on_rail = contains(rail, x);
  if (!contact.on_rail) return contact;
  const RailPlace place = rail_place(rail, x);
  contact.element = static_cast<int>(place.element);
  contact.x = x;
  contact.rows = place.rows;
  contact.rail = &rail;
  contact.own = place.own;
  return contact;
}

RailHeads rail_heads(std::span<const RailContact> contacts, int wheelset) noexcept {
  return RailHeads(contacts.subspan(2 * static_cast<std::size_t>(wheelset), 2));
}

void append_rail_heads(const StructureModel& structure, double x, std::vector<RailContact>& contacts) {
  const RailContact& left = contacts.emplace_back(rail_contact(structure, RailSide::left, x));
  const RailLine& rail = structure.rail[static_cast<std::size_t>(RailSide::right)];
  const auto node = static_cast<std::size_t>(left.element);
  if (!left.on_rail || node + 1 >= rail.x.size() || !same_element(*left.rail, rail, node)) {
    contacts.push_back(rail_contact(structure, RailSide::right, x));
    return;
  }
  RailContact& right = contacts.emplace_back(left);
  right.side = RailSide::right;
  right.rail = &rail;
  right.rows.dof = element_dofs(rail, node);
}

Eigen::Matrix3d element_compliance(const RailContact& i, const RailContact& j) noexcept {
  if (!i.on_rail || !j.on_rail || i.side != j.side || i.element != j.element) return Eigen::Matrix3d::Zero();
  return i.x == j.x ? j.own.compliance : element_compliance(*j.rail, i.x, j.x);
}

void add_element_compliance(RailHeads i, RailHeads j, double weight, RailHeadsCompliance& compliance) noexcept {
  for (std::size_t side = 0; side < 2; ++side) {
    const auto first = static_cast<Eigen::Index>(3 * side);
    compliance.block<3, 3>(first, first) += weight * element_compliance(i[side], j[side]);
  }
}

void append_free(std::span<const int> from, std::vector<int>& dofs) {
  for (int dof : from) {
    if (dof != held) dofs.push_back(dof);
  }
}

void append_dofs(const RailContact& contact, std::vector<int>& dofs) {
  if (contact.on_rail) append_free(contact.rows.dof, dofs);
}

void append_dofs_ahead(const RailContact& contact, std::vector<int>& dofs) {
  if (!contact.on_rail) return;
  const auto node = static_cast<std::size_t>(contact.element + 2);
  if (node < contact.rail->x.size()) append_free(head_dofs(*contact.rail, node), dofs);
}

Eigen::Vector3d rail_head(const RailContact& contact, const Eigen::VectorXd& dofs) noexcept {
  using enum HeadDof::Place;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  if (!contact.on_rail) return value;
  const RailInterpolation& rows = contact.rows;
  for (std::size_t p = 0; p < rows.dof.size(); p += of_node) {
    const auto at = [&](HeadDof::Place k) { return rows.dof[p + k] == held ? 0.0 : dofs[rows.dof[p + k]]; };
    value[0] += rows.y[p + y] * at(y) + rows.y[p + yaw] * at(yaw);
    value[1] += rows.z[p + z] * at(z) + rows.z[p + pitch] * at(pitch);
    value[2] += rows.roll[p + roll] * at(roll) + rows.roll[p + twist] * at(twist);
  }
  value[0] += contact.rail->head_height * value[2];
  return value;
}

Eigen::Vector2d rail_slopes(const RailContact& contact, const Eigen::VectorXd& dofs) noexcept {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  if (!contact.on_rail) return value;
  for (std::size_t k = 0; k < 12; ++k) {
    if (contact.rows.dof[k] == held) continue;
    value += dofs[contact.rows.dof[k]] * Eigen::Vector2d(contact.rows.yaw[k], contact.rows.pitch[k]);
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

}  // namespace railtab
