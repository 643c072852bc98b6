#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/tablegen/rolling_contact_grid.hpp"
#include "railtab/tablegen/rolling_contact_single.hpp"

namespace railtab {

/// One step of Newton's method: B Δp = −s in adhesion, t·B Δp + k τ = −t·s in slip, where Δp = τ t. By preconditioned
/// GMRES in single precision; each equation is divided by its diagonal, so that no size of creepage leaves its range.
class RollingContactLinear {
 public:
  RollingContactLinear(const RollingContactGrid& grid, const RollingContactProduct& product);

  void adhere(int element) { state_[element] = State::adhesion; }
  /// @param tx, ty unit tangent t of the friction circle; @param stiffness k = −p·s/|p|²
  void slip(int element, double tx, double ty, double stiffness);
  /// @param slip of all elements; @param step Δp; @param tolerance relative, on the residual of the scaled equations
  /// @returns products with B
  int solve(const ElementField& slip, double tolerance, ElementField& step);

 private:
  enum class State : unsigned char { outside, adhesion, slip };

  double set_right_side(const ElementField& slip);
  int iterate(float tolerance);
  void multiply(const ElementFieldSingle& unknown, ElementFieldSingle& result);
  void precondition(const ElementFieldSingle& residual, ElementFieldSingle& unknown) const;
  float orthogonalise(int k);

  const RollingContactGrid& grid_;
  RollingContactSingle product_;
  std::vector<Eigen::MatrixXf> run_inverse_[2];  ///< by length−1: inverse of the scaled B on a run of one row
  double diagonal_[2];                           ///< B of an element on itself
  float ahead_[2];                               ///< of the next one ahead on it
  std::vector<State> state_;
  /// Of slipping elements: t, 1/d and k/d, d the diagonal of the equation.
  Eigen::VectorXf tangent_x_, tangent_y_, scale_, stiffness_;
  ElementFieldSingle unknown_, traction_, slip_;
  std::vector<ElementFieldSingle> basis_;
  Eigen::MatrixXf hessenberg_;
  Eigen::VectorXf rotated_, cosine_, sine_;
};

}  // namespace railtab
