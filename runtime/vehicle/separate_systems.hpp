#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// A part of a train that nothing joins to the rest: a coach, or coaches with their joints. Indices in ascending order.
struct SeparateSystem {
  std::vector<int> dofs;
  std::vector<int> wheelsets;    ///< numbers in VehicleModel::wheelsets
  std::vector<int> elongations;  ///< rows of ForceElements::rows
  std::vector<int> elements;     ///< of ForceElements::element
};

/// The separate systems of a train that is described as one vehicle; a single coach is always one. Coaches belong
/// together where the mass, damping or stiffness matrix, the gyroscopic one or a force element couples them.
[[nodiscard]] std::vector<SeparateSystem> separate_systems(const VehicleModel& vehicle);

/// A square matrix of a train that is zero but within its separate systems, and its product with vectors.
class SeparateMatrix {
 public:
  SeparateMatrix() = default;
  SeparateMatrix(const std::vector<SeparateSystem>& systems, const Eigen::MatrixXd& whole);

  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
  /// y += factor A x; allocates nothing.
  void add_product(double factor, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

 private:
  std::vector<std::vector<int>> dofs_;   // of each system
  std::vector<Eigen::MatrixXd> matrix_;  // of a single one: the whole matrix
};

/// Force elements of one system alone, whose rows count its dofs.
[[nodiscard]] ForceElements elements_of(const SeparateSystem& system, const ForceElements& elements);

}  // namespace railtab
