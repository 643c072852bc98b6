#include "railtab/runtime/vehicle/series_damper.hpp"

#include <array>

#include "railtab/runtime/base/spring_damper.hpp"

namespace railtab {

namespace {

// Whether the damper along an axis is a force element that is not linear.
bool is_replaced(const Suspension& unit, int axis, ForceElementChoice choice) {
  return choice == ForceElementChoice::nonlinear && unit.nonlinear[static_cast<std::size_t>(axis)].replaces_damper();
}

}  // namespace

bool is_in_series(const Suspension& unit, int axis) noexcept {
  return unit.series_stiffness[axis] > 0.0 && unit.damping[axis] > 0.0;
}

int count_series_dampers(const std::vector<Suspension>& suspension) {
  int count = 0;
  for (const Suspension& unit : suspension) {
    for (int axis = 0; axis < 3; ++axis) count += is_in_series(unit, axis) ? 1 : 0;
  }
  return count;
}

Eigen::Vector3d parallel_damping(const Suspension& unit, ForceElementChoice choice) {
  Eigen::Vector3d damping = unit.damping;
  for (int axis = 0; axis < 3; ++axis) {
    if (is_in_series(unit, axis) || is_replaced(unit, axis, choice)) damping[axis] = 0.0;
  }
  return damping;
}

void add_series_dampers(VehicleModel& vehicle, const std::vector<Suspension>& suspension, int first_row,
                        ForceElementChoice choice) {
  int row = first_row;
  for (const Suspension& unit : suspension) {
    const SpringKinematics kinematics =
        spring_kinematics(unit.point - vehicle.bodies[static_cast<std::size_t>(unit.body_a)].position,
                          unit.point - vehicle.bodies[static_cast<std::size_t>(unit.body_b)].position);
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_in_series(unit, axis)) continue;
      const double c = unit.damping[axis];
      std::array<int, 13> rows{};
      Eigen::Vector<double, 13> rate;  // ė − ṡ per velocity
      rate << kinematics.row(axis).transpose(), -1.0;
      for (std::size_t i = 0; i < 6; ++i) {
        rows[i] = vehicle.dof[static_cast<std::size_t>(unit.body_a)][i];
        rows[i + 6] = vehicle.dof[static_cast<std::size_t>(unit.body_b)][i];
      }
      rows[12] = row++;
      vehicle.stiffness(rows[12], rows[12]) += unit.series_stiffness[axis];
      if (is_replaced(unit, axis, choice)) continue;
      for (std::size_t i = 0; i < 13; ++i) {
        for (std::size_t j = 0; j < 13; ++j) {
          if (rows[i] == held || rows[j] == held) continue;
          vehicle.damping(rows[i], rows[j]) += c * rate[static_cast<int>(i)] * rate[static_cast<int>(j)];
        }
      }
    }
  }
}

}  // namespace railtab
