#pragma once

#include <vector>

#include "rolling_contact_grid.hpp"

namespace railtab {

/// Newton's method on the friction law over the elements, the linear systems by preconditioned GMRES.
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
  enum class State : unsigned char { outside, adhesion, slip };

  void classify(const ElementField& traction, const ElementField& slip);
  void direction_step(const ElementField& unknown, ElementField& traction) const;
  void linear_operator(const ElementField& unknown, ElementField& result);
  void precondition(const ElementField& residual, ElementField& unknown) const;
  int solve_linear(double tolerance);
  void update(ElementField& traction);

  const RollingContactGrid& grid_;
  RollingContactProduct product_;
  std::vector<Eigen::MatrixXd> run_inverse_[2];  ///< by length−1: inverse of B on a run of elements of one row
  double diagonal_[2], ahead_[2];                ///< B of an element on itself, of the next one ahead on it
  std::vector<State> state_;
  Eigen::VectorXd tangent_x_, tangent_y_,
      stiffness_;  ///< of slip elements: direction of p turned by 90°, −p·s/(μ p_n)²
  ElementField right_side_, solution_, expanded_, scratch_;
  std::vector<ElementField> basis_;
};

}  // namespace railtab
