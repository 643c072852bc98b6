#include "railtab/runtime/algebra/substitution_factor.hpp"

namespace railtab {

SubstitutionFactor::Vector SubstitutionFactor::solve(const Vector& load) const {
  Path nothing;
  find_path({}, nothing);
  Vector y, x = Vector::Zero(room()), natural = Vector::Zero(load.size());
  into(load, y);
  forward(y);
  backward(y, x, nothing);
  backward_off(nothing, y, x);
  out_of(x, natural);
  return natural;
}

Eigen::MatrixXd SubstitutionFactor::solve_columns(const Eigen::MatrixXd& loads) const {
  Eigen::MatrixXd result(loads.rows(), loads.cols());
  for (Eigen::Index k = 0; k < loads.cols(); ++k) result.col(k) = solve(loads.col(k));
  return result;
}

}  // namespace railtab
