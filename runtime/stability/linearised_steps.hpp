#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/vsi/hht.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Derivatives of a vehicle's motion on straight rigid rails by the state x = [u, u̇] that it began with: its HHT steps
/// linearised about that motion,
///     M δü₁ + (1+α)(C* δu̇ + K* δu)₁ − α (C* δu̇ + K* δu)₀ = 0,     C* = C − ∂f/∂u̇,  K* = K − ∂f/∂u,
/// with the contact forces and force elements f of the motion at both ends of each step.
class LinearisedSteps {
 public:
  /// @param model outlives this  @param displacements rows of u in x; all rows have a u̇
  /// @param start the motion at the beginning
  LinearisedSteps(const VsiModel& model, const HhtScheme& hht, const std::vector<int>& displacements,
                  const LinearMotion& start);

  /// @param end the motion at the end of the next step
  void advance(const LinearMotion& end);
  /// ∂x/∂x(0) after the steps so far.
  [[nodiscard]] Eigen::MatrixXd by_start(const std::vector<int>& displacements) const;

 private:
  void take_slopes(const LinearMotion& at);

  const VsiModel& model_;
  TrainContact contact_;
  HhtScheme hht_;
  Eigen::MatrixXd linear_damping_;
  Eigen::MatrixXd stiffness_, damping_;                     // K*, C* of the last motion
  Eigen::MatrixXd displacement_, velocity_, acceleration_;  // δu, δu̇, δü by x(0)
};

}  // namespace railtab
