#pragma once

namespace railtab {

/// What the shape of a Hertzian ellipse makes of contact modulus E* and curvature sum A + B:
/// K_h = stiffness·E*/√(A+B), semi-axes at unit load = {major, minor}/(E*(A+B))^{1/3}.
struct HertzEllipse {
  double stiffness;
  double major, minor;
  double ratio;  ///< minor/major
};

/// Exact, from the curvature ratio min(A,B)/max(A,B) in (0, 1].
///
/// Ratio equation (E/g² - K)/(K - E) = max/min with g = minor/major, m = 1 - g². Written with the complete integrals
/// D = (K - E)/m and B = K - D it is B/(g² D) = max/min: no difference of nearly equal numbers for the circle (m -> 0),
/// and Carlson's forms take g² itself, so none for the line either (m -> 1).
[[nodiscard]] HertzEllipse hertz_ellipse(double curvature_ratio);

}  // namespace railtab
