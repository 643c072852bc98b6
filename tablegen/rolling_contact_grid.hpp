#pragma once

#include <vector>

#include "railtab/tablegen/rolling_contact.hpp"
#include "railtab/tablegen/rolling_contact_product.hpp"

namespace railtab {

/// The elements of one ellipse: a square of n×n, of which those with their centre inside the ellipse carry traction.
struct RollingContactGrid {
  /// Normalised: a = √ratio, b = 1/a, ∫ μ p_n = 1.
  RollingContactGrid(double ratio, int elements, RollingContactOptions::ElementSize size);

  int n;
  double dx, dy, area;  ///< of one element
  /// Centres along each axis.
  std::vector<double> x, y;
  /// Bound μ p_n of each element, row by row; 0 outside. Scaled so that its sum over the elements is exactly 1.
  Eigen::VectorXd bound;
  std::vector<int> inside;  ///< the elements that carry traction
};

}  // namespace railtab
