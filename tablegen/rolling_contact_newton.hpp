#pragma once

#include <vector>

#include "railtab/tablegen/rolling_contact_grid.hpp"
#include "railtab/tablegen/rolling_contact_linear.hpp"

namespace railtab {

/// Newton's method on the friction law over the elements. Slip, law and residual are in double precision, the linear
/// systems in single.
class RollingContactNewton {
 public:
  RollingContactNewton(const RollingContactGrid& grid, double nu);

  struct Outcome {
    double residual;
    int iterations, products;
    bool converged;
  };
  /// @param rigid_slip w dx of every element; @param traction start (within the bound) and result
  Outcome solve(const ElementField& rigid_slip, ElementField& traction, double tolerance, int max_iterations);

  /// Σ|p − P(p − s/b0)| dA for the tractions and their slip.
  [[nodiscard]] double residual(const ElementField& traction, const ElementField& slip) const;
  RollingContactProduct& product() { return product_; }

 private:
  void classify(const ElementField& traction, const ElementField& slip);
  void update(ElementField& traction) const;

  const RollingContactGrid& grid_;
  RollingContactProduct product_;
  RollingContactLinear linear_;
  std::vector<bool> slips_;
  ElementField slip_, step_;
};

}  // namespace railtab
