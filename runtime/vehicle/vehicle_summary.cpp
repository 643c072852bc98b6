#include "railtab/runtime/vehicle/vehicle_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"

namespace railtab {

VehicleSummary summarise(const VehicleModel& vehicle, int modes) {
  VehicleSummary summary;
  std::vector<bool> rests(static_cast<std::size_t>(vehicle.dofs()), false);
  for (const int w : vehicle.wheelsets) {
    const int wheelset = static_cast<int>(summary.wheel_load.size());
    summary.wheel_load.push_back(static_wheel_load(vehicle, wheelset));
    summary.mass += 2.0 * summary.wheel_load.back() / standard_gravity;
    for (const int row : vehicle.dof[static_cast<std::size_t>(w)]) {
      if (row != held) rests[static_cast<std::size_t>(row)] = true;
    }
  }
  std::vector<int> moves;
  for (int row = 0; row < vehicle.dofs(); ++row) {
    if (!rests[static_cast<std::size_t>(row)]) moves.push_back(row);
  }
  if (moves.empty() || modes == 0) return summary;
  const Eigen::MatrixXd K = vehicle.stiffness(moves, moves), M = vehicle.mass(moves, moves);
  const Eigen::VectorXd omega2 = generalised_eigenvalues(K, M);
  const Eigen::Index count = std::min<Eigen::Index>(modes, omega2.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    summary.frequencies.push_back(std::sqrt(std::max(0.0, omega2[k])) / (2.0 * std::numbers::pi));
  }
  return summary;
}

}  // namespace railtab
