#include "railtab/runtime/vehicle/vehicle_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab {

VehicleSummary summarise(const VehicleModel& vehicle, int modes) {
  constexpr std::size_t vertical = 2;
  VehicleSummary summary;
  std::vector<bool> rests(static_cast<std::size_t>(vehicle.dofs()), false);
  for (const int w : vehicle.wheelsets) {
    const DofIndices& dof = vehicle.dof[static_cast<std::size_t>(w)];
    const double load = dof[vertical] == held ? 0.0 : vehicle.static_load[dof[vertical]];
    summary.wheel_load.push_back(0.5 * load);
    summary.mass += load / vehicle.gravity;
    for (const int row : dof) {
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
