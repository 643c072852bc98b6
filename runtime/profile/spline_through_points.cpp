#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/arc_lengths.hpp"
#include "railtab/runtime/profile/cubic_spline.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"

namespace railtab {

std::vector<double> chord_lengths(const std::string& name, const std::vector<double>& y, const std::vector<double>& z) {
  std::vector<double> s{0.0};
  for (std::size_t i = 1; i < y.size(); ++i) {
    const double chord = std::hypot(y[i] - y[i - 1], z[i] - z[i - 1]);
    if (!(chord > 0.0)) {
      throw input_error(fmt::format("profile {}, point {}", name, i),
                        fmt::format("the point ({:.9g}, {:.9g}) m of point {} again", y[i], z[i], i - 1),
                        "points that differ");
    }
    s.push_back(s.back() + chord);
  }
  return s;
}

// Gauss-Legendre with 4 points per interval.
std::vector<double> arc_lengths(const ProfileCurve& curve) {
  constexpr std::array<double, 4> node{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                       0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  const std::vector<double>& s = curve.knots().s;
  std::vector<double> arc{0.0};
  for (std::size_t i = 1; i < s.size(); ++i) {
    const double half = 0.5 * (s[i] - s[i - 1]);
    double sum = 0.0;
    for (std::size_t k = 0; k < node.size(); ++k) {
      const CurvePoint p = curve.at(s[i - 1] + half * (1 + node[k]));
      sum += weight[k] * std::hypot(p.dy, p.dz);
    }
    arc.push_back(arc.back() + half * sum);
  }
  return arc;
}

ProfileKnots spline_through_points(ProfileKind kind, std::string name, const std::vector<double>& y,
                                   const std::vector<double>& z) {
  if (y.size() != z.size() || y.size() < 2) {
    throw input_error(fmt::format("profile {}", name), fmt::format("{} values y, {} values z", y.size(), z.size()),
                      "equal numbers of at least 2");
  }
  const auto fitted = [&](std::vector<double> s) {
    std::vector<double> dy = natural_spline_slopes(s, y);
    std::vector<double> dz = natural_spline_slopes(s, z);
    return ProfileKnots{kind, name, std::move(s), y, z, std::move(dy), std::move(dz)};
  };
  const ProfileCurve over_chords(fitted(chord_lengths(name, y, z)));
  return fitted(arc_lengths(over_chords));
}

}  // namespace railtab
