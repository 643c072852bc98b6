#include "railtab/runtime/profile/point_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace railtab {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Distance of knot i from the cubic through its four neighbours, normal to the outline, over the standard deviation
/// that it has where each point has one of 1.
double relative_distance(const ProfileKnots& k, std::size_t i) {
  const std::array<std::size_t, 4> near{i - 2, i - 1, i + 1, i + 2};
  double y = k.y[i], z = k.z[i], variance = 1.0;
  for (const std::size_t a : near) {
    double weight = 1.0;  // Lagrange's polynomial
    for (const std::size_t b : near) {
      if (a != b) weight *= (k.s[i] - k.s[b]) / (k.s[a] - k.s[b]);
    }
    y -= weight * k.y[a];
    z -= weight * k.z[a];
    variance += weight * weight;
  }
  const double ty = k.y[i + 1] - k.y[i - 1], tz = k.z[i + 1] - k.z[i - 1];
  return std::abs(ty * z - tz * y) / (std::hypot(ty, tz) * std::sqrt(variance));
}

}  // namespace

PointNoise point_noise(const ProfileKnots& knots) {
  constexpr std::size_t fewest = 9;
  constexpr double median_of_normal = 0.6745;  // of the amount, in standard deviations
  const std::size_t n = knots.s.size();
  if (n < fewest) return {};
  std::vector<double> distances, spacings;
  for (std::size_t i = 2; i + 2 < n; ++i) distances.push_back(relative_distance(knots, i));
  for (std::size_t i = 1; i < n; ++i) spacings.push_back(knots.s[i] - knots.s[i - 1]);
  const double deviation = median(std::move(distances)) / median_of_normal, spacing = median(std::move(spacings));
  return {deviation, std::sqrt(6.0) * deviation / (spacing * spacing)};
}

std::string noise_warning(const std::string& name, const PointNoise& noise) {
  constexpr double of_rail_head = 3.0;  // [1/m]: the crown of 60E1, beside which such bumps are contacts of their own
  if (noise.curvature <= of_rail_head) return {};
  return fmt::format(
      "the points of {} scatter by about {:.2g} um, and the curvature of the curve through them by {:.2g} 1/m, more "
      "than the {:g} 1/m of a rail head: contacts jump from bump to bump",
      name, 1e6 * noise.deviation, noise.curvature, of_rail_head);
}

}  // namespace railtab
