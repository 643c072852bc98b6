#pragma once

#include <vector>

#include "railtab/tablegen/influence_numbers.hpp"
#include "railtab/tablegen/rolling_contact_newton.hpp"

namespace railtab {

/// The safe method: roll from any tractions, element by element, until nothing changes any more. Each step is a
/// friction problem with a symmetric positive definite matrix, for which Gauss-Seidel over the elements converges
/// [Kalker1990, Ch. 4]; some hundred times slower than Newton's method on the steady problem.
class RollingContactTransient {
 public:
  RollingContactTransient(const RollingContactGrid& grid, double nu);

  /// Rolls until the residual of steady rolling, as `newton` defines it, is below the tolerance or 40 contact lengths
  /// are done. @param rigid_slip w dx of every element; @param traction start (within the bound) and result
  RollingContactNewton::Outcome solve(const ElementField& rigid_slip, ElementField& traction, double tolerance,
                                      RollingContactNewton& newton);

 private:
  void add(int element, double px, double py, int ahead, ElementField& field) const;
  double sweep(ElementField& traction, ElementField& slip) const;

  const RollingContactGrid& grid_;
  InfluenceNumber self_;
  std::vector<double> xx_, xy_, yy_;  ///< A at the offsets −nx..nx along, −ny..ny across
};

}  // namespace railtab
