#pragma once

#include <string>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Scatter of a profile's points about a smooth outline.
struct PointNoise {
  double deviation = 0.0;  ///< standard deviation normal to the outline [m]
  double curvature = 0.0;  ///< standard deviation that it adds to the curvature through the points [1/m]
};

/// Estimated from the distance of every knot from the cubic through its four neighbours. The median of the distances is
/// taken: a curvature that changes at a few places, as between the arcs of a drawing, is no noise. The curvature is
/// that of three neighbours at the usual spacing h, √6·deviation/h². Zero of fewer than 9 knots.
[[nodiscard]] PointNoise point_noise(const ProfileKnots& knots);

/// What such points do to a contact search, where they bend the curve through them by more than the crown of a rail
/// head is bent; empty of others.
[[nodiscard]] std::string noise_warning(const std::string& name, const PointNoise& noise);

}  // namespace railtab
