#include "railtab/runtime/profile/point_noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
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

/// Of the distances from `begin` to before `end`, the first of which is that of knot 2.
PointNoise noise_of(const ProfileKnots& knots, const std::vector<double>& distances, std::size_t begin,
                    std::size_t end) {
  constexpr double median_of_normal = 0.6745;  // of the amount, in standard deviations
  std::vector<double> spacings;
  for (std::size_t i = begin; i < end + 3; ++i) spacings.push_back(knots.s[i + 1] - knots.s[i]);
  const auto at = [&](std::size_t i) { return distances.begin() + static_cast<std::ptrdiff_t>(i); };
  const double deviation = median({at(begin), at(end)}) / median_of_normal, spacing = median(std::move(spacings));
  return {deviation, std::sqrt(6.0) * deviation / (spacing * spacing), deviation, knots.y[begin], knots.y[end + 3]};
}

}  // namespace

PointNoise point_noise(const ProfileKnots& knots) {
  constexpr std::size_t fewest = 9, stretch = 25;
  // The largest of many medians is above that of all points, and coarse points of a flange are not on a cubic.
  constexpr double largest_of_stretch = 2.0 * largest_noise_curvature;
  const std::size_t n = knots.s.size();
  if (n < fewest) return {};
  std::vector<double> distances;
  for (std::size_t i = 2; i + 2 < n; ++i) distances.push_back(relative_distance(knots, i));
  PointNoise of_all = noise_of(knots, distances, 0, distances.size());
  of_all.y_begin = of_all.y_end = 0.0;
  if (of_all.curvature > largest_noise_curvature) return of_all;
  PointNoise most;
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i + stretch <= distances.size(); ++i) {
    const PointNoise here = noise_of(knots, distances, i, i + stretch);
    if (here.curvature > most.curvature) most = here;
    squares += here.deviation * here.deviation;
    count += 1.0;
  }
  if (most.curvature <= largest_of_stretch) return of_all;
  most.smoothing = std::sqrt(squares / count);
  return most;
}

std::string noise_warning(const std::string& name, const PointNoise& noise) {
  if (noise.curvature <= largest_noise_curvature) return {};
  const std::string stretch = noise.y_begin == noise.y_end ? std::string()
                                                           : fmt::format(" from y = {:.3g} to {:.3g} mm",
                                                                         1e3 * noise.y_begin, 1e3 * noise.y_end);
  return fmt::format(
      "the points of {}{} scatter by about {:.2g} um, and the curvature of the curve through them by {:.2g} 1/m, more "
      "than the {:g} 1/m of a rail head: contacts jump from bump to bump",
      name, stretch, 1e6 * noise.deviation, noise.curvature, largest_noise_curvature);
}

}  // namespace railtab
