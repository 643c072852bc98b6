#include "railtab/runtime/vehicle/force_element.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/vehicle/series_damper.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

namespace {

constexpr int z_axis = 2, yaw_axis = 5;
constexpr std::array<std::string_view, 6> directions{"along x", "along y", "along z", "about x", "about y", "about z"};

// Collects elements and the rows that they share.
class ElementBuilder {
 public:
  ElementBuilder(VehicleModel& vehicle, const Eigen::VectorXd& rest) : vehicle_(vehicle), rest_(rest) {}

  void add(const Suspension& unit, int axis, const NonlinearUnit& parts, int series_row) {
    const Eigen::VectorXd elongation = row_of(unit, axis);
    if (elongation.isZero(0.0)) return;  // held
    const auto element = [&](ForceElementKind kind, const Eigen::VectorXd& row) -> ForceElement& {
      vehicle_.elements.element.push_back({name_of(unit, axis), kind, number_of(row), {}, {}, 0.0});
      vehicle_.elements.element.back().coach = vehicle_.bodies[static_cast<std::size_t>(unit.body_a)].coach;
      return vehicle_.elements.element.back();
    };
    if (!parts.stop.empty()) element(ForceElementKind::stop, elongation).curve = parts.stop;
    if (!parts.damper.empty()) {
      Eigen::VectorXd of_damper = elongation;
      if (series_row >= 0) of_damper[series_row] = -1.0;  // e − s
      element(ForceElementKind::damper, of_damper).curve = parts.damper;
    }
    if (!parts.friction.acts()) return;
    ForceElement& friction = element(ForceElementKind::friction, elongation);
    friction.friction = parts.friction;
    if (parts.friction.ratio > 0.0) add_load(unit, friction);
    friction.stiffness = (parts.friction.force + parts.friction.ratio * friction.load) / parts.friction.travel;
  }

  void finish() {
    vehicle_.elements.rows.resize(static_cast<Eigen::Index>(rows_.size()), vehicle_.dofs());
    for (std::size_t i = 0; i < rows_.size(); ++i) vehicle_.elements.rows.row(static_cast<Eigen::Index>(i)) = rows_[i];
  }

 private:
  [[nodiscard]] Eigen::VectorXd row_of(const Suspension& unit, int axis) const {
    const auto a = static_cast<std::size_t>(unit.body_a), b = static_cast<std::size_t>(unit.body_b);
    const SpringKinematics kinematics =
        spring_kinematics(unit.point - vehicle_.bodies[a].position, unit.point - vehicle_.bodies[b].position);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(vehicle_.dofs());
    for (std::size_t k = 0; k < 12; ++k) {
      const int dof = k < 6 ? vehicle_.dof[a][k] : vehicle_.dof[b][k - 6];
      if (dof != held) row[dof] += kinematics(axis, static_cast<Eigen::Index>(k));
    }
    return row;
  }

  int number_of(const Eigen::VectorXd& row) {
    const auto number = std::find(rows_.begin(), rows_.end(), row) - rows_.begin();
    if (number == static_cast<std::ptrdiff_t>(rows_.size())) rows_.push_back(row);
    return static_cast<int>(number);
  }

  // The load that the unit's spring along z carries at rest is a compression: it has its sign.
  void add_load(const Suspension& unit, ForceElement& friction) {
    const Eigen::VectorXd vertical = row_of(unit, z_axis);
    const double at_rest = unit.stiffness[z_axis] * vertical.dot(rest_);
    constexpr double least = 1.0;  // N: less is rounding
    if (vehicle_.gravity > 0.0 && std::abs(at_rest) < least && friction.friction.force == 0.0) {
      throw input_error(fmt::format("{}: {}", vehicle_.name, friction.name),
                        "a friction ratio on a spring that carries no load at rest", "a spring that carries weight");
    }
    friction.load_row = number_of(vertical);
    friction.load = std::abs(at_rest);
    friction.load_stiffness = at_rest < 0.0 ? -unit.stiffness[z_axis] : unit.stiffness[z_axis];
  }

  [[nodiscard]] std::string name_of(const Suspension& unit, int axis) const {
    const auto body = [&](int b) { return vehicle_.bodies[static_cast<std::size_t>(b)].name; };
    const std::string_view side = unit.point.y() < 0.0 ? ", left" : unit.point.y() > 0.0 ? ", right" : "";
    return fmt::format("{} {}, {} to {}{}", unit.name.empty() ? "suspension" : unit.name,
                       directions[static_cast<std::size_t>(axis)], body(unit.body_a), body(unit.body_b), side);
  }

  VehicleModel& vehicle_;
  const Eigen::VectorXd& rest_;
  std::vector<Eigen::VectorXd> rows_;
};

}  // namespace

ForceElement::Limit ForceElement::limit(const Eigen::VectorXd& x) const noexcept {
  if (load_row < 0) return {friction.force, 0.0};
  const double carried = load + load_stiffness * x[load_row];
  if (carried <= 0.0) return {friction.force, 0.0};
  return {friction.force + friction.ratio * carried, friction.ratio * load_stiffness};
}

Eigen::VectorXd ForceElements::force(const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                                     const Eigen::VectorXd& friction) const {
  Eigen::VectorXd total = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t i = 0; i < element.size(); ++i) {
    const ForceElement& e = element[i];
    switch (e.kind) {
      case ForceElementKind::stop:
        total[e.row] += e.curve.at(x[e.row]).force;
        break;
      case ForceElementKind::damper:
        total[e.row] += e.curve.at(v[e.row]).force;
        break;
      case ForceElementKind::friction:
        total[e.row] += friction[static_cast<Eigen::Index>(i)];
        break;
    }
  }
  return total;
}

void add_force_elements(VehicleModel& vehicle, const std::vector<Suspension>& suspension, const Eigen::VectorXd& rest,
                        int first_series_row) {
  ElementBuilder builder(vehicle, rest);
  int series_row = first_series_row;
  for (const Suspension& unit : suspension) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool in_series = is_in_series(unit, axis);
      builder.add(unit, axis, unit.nonlinear[static_cast<std::size_t>(axis)], in_series ? series_row : -1);
      series_row += in_series ? 1 : 0;
    }
    builder.add(unit, yaw_axis, {{}, {}, unit.yaw_friction}, -1);
  }
  builder.finish();
}

}  // namespace railtab
