#pragma once

#include <string>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Scatter of a profile's points about a smooth outline, all of them or those of a stretch.
struct PointNoise {
  double deviation = 0.0;             ///< standard deviation normal to the outline [m]
  double curvature = 0.0;             ///< standard deviation that it adds to the curvature through the points [1/m]
  double smoothing = 0.0;             ///< deviation of all points, root mean square: for smoothing_spline() [m]
  double y_begin = 0.0, y_end = 0.0;  ///< of the stretch [m]; the same of all points
};

/// The scatter of the curvature that the contact search bears [1/m]: of the crown of 60E1, beside which such bumps are
/// contacts of their own.
inline constexpr double largest_noise_curvature = 3.0;

/// Estimated from the distance of every knot from the cubic through its four neighbours. The median of the distances is
/// taken: a curvature that changes at a few places, as between the arcs of a drawing, is no noise. The curvature is
/// that of three neighbours at the usual spacing h, √6·deviation/h². Where that of all points is not above
/// largest_noise_curvature and that of 29 points in a row is above twice that, it is that of the 29 that scatter most:
/// a scan may be good but for the running band. Zero of fewer than 9 knots.
[[nodiscard]] PointNoise point_noise(const ProfileKnots& knots);

/// What such points do to a contact search, where they bend the curve through them by more than the crown of a rail
/// head is bent; empty of others.
[[nodiscard]] std::string noise_warning(const std::string& name, const PointNoise& noise);

}  // namespace railtab
