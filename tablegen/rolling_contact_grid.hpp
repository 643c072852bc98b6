#pragma once

#include <Eigen/Core>
#include <vector>

namespace railtab {

/// Tractions or slips on a rectangle of elements: x components, then y components; each ny rows across (y, rightward)
/// of nx elements along the rolling direction (x, forward).
using ElementField = Eigen::VectorXd;

/// A rectangle of equal elements, nx along the rolling direction (x, forward), ny across (y, rightward), of which any
/// set carries traction: those inside an ellipse, or those of a contact area with any outline and several bands.
struct RollingContactGrid {
  int nx = 0, ny = 0;
  double dx = 0.0, dy = 0.0;  ///< of one element
  std::vector<double> x, y;   ///< centres along each axis
  Eigen::VectorXd bound;      ///< μ p_n of each element, ny rows of nx; 0 where it carries no traction
  std::vector<int> inside;    ///< the elements that carry traction: their bound is above 0

  [[nodiscard]] int count() const noexcept { return nx * ny; }
  [[nodiscard]] double area() const noexcept { return dx * dy; }
};

/// Elements of an ellipse's rectangle (2a/n, 2b/n), as CONTACT; or scaled so that those with their centre inside the
/// ellipse have its area together, so that the error is smooth in 1/n.
enum class ElementSize { rectangle, equal_area };

/// n×n elements of an ellipse under Hertz's pressure: those with their centre inside it carry traction. Normalised:
/// a = √ratio, b = 1/a, ∫ μ p_n = 1, the sum over the elements exactly.
[[nodiscard]] RollingContactGrid ellipse_grid(double ratio, int elements, ElementSize size);

}  // namespace railtab
