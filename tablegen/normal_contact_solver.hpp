#pragma once

#include <Eigen/Core>

#include "railtab/tablegen/normal_influence.hpp"

namespace railtab {

/// When the pressure is found.
struct NormalContactTolerance {
  double residual = 1e-7;    ///< 1e-12..1e-2; the force is then off by some 1e-7 of itself
  int max_iterations = 300;  ///< of conjugate gradients, 1..10000

  /// @throws InputError
  void validate() const;
};

/// Pressure of elements and what proves it.
struct NormalPressure {
  Eigen::VectorXd pressure;  ///< of all elements [Pa], not negative
  /// Σ|p − max(0, p − g/A_0)| over its value at p = 0: g = A p − h the gap, A_0 an element's own influence.
  double residual = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Non-negative pressure p with gap g = A p − h ≥ 0 and p g = 0, for the undeformed overlap h [m] of the elements: by
/// conjugate gradients on the elements in contact [PolonskyKeer1999], preconditioned with the inverse of the influence
/// on the periodic grid. What becomes negative leaves the contact, what overlaps outside enters it, and the directions
/// start anew.
/// @param start pressures to begin with, not negative
[[nodiscard]] NormalPressure normal_pressure(NormalInfluence& influence, const Eigen::VectorXd& overlap,
                                             Eigen::VectorXd start, const NormalContactTolerance& tolerance);

}  // namespace railtab
