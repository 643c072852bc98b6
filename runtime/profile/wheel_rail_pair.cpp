#include "railtab/runtime/profile/wheel_rail_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

void require(bool in_range, std::string_view member, double value, std::string_view range) {
  if (!in_range) throw input_error(member, fmt::format("{} m", value), fmt::format("{} m", range));
}

void require_kind(const ProfileCurve& curve, ProfileKind kind, std::string_view word) {
  if (curve.knots().kind != kind) {
    throw input_error(fmt::format("profile {}", curve.knots().name),
                      kind == ProfileKind::wheel ? "a rail profile" : "a wheel profile", word);
  }
}

/// A wheel profile whose origin is not on the tape circle would give all its radii a wrong nominal value.
void require_origin(const ProfileCurve& wheel) {
  constexpr double most = 1e-3;  // m
  const double z = wheel.at(wheel.s_at_y(0.0)).z;
  if (!(std::abs(z) <= most)) {
    throw input_error(fmt::format("profile {}", wheel.knots().name), fmt::format("z = {:.6g} m at y = 0", z),
                      "z = 0 at the tape circle, within 1 mm");
  }
}

/// Arc length at which z passes `level` between a point below it and a point above it, by bisection.
double s_at_level(const ProfileCurve& rail, double level, double s_below, double s_above) {
  constexpr int most_halvings = 2200;  // of any interval of doubles down to one bit
  double middle = 0.5 * (s_below + s_above);
  for (int i = 0; i < most_halvings && middle > s_below && middle < s_above; ++i) {
    (rail.at(middle).z >= level ? s_below : s_above) = middle;
    middle = 0.5 * (s_below + s_above);
  }
  return middle;
}

/// y of the gauge point: the point of the gauge face nearest to the track centre, between the highest point and
/// `height` below it [EN13848-1].
double gauge_point(const ProfileCurve& rail, double height) {
  const ProfileKnots& k = rail.knots();
  const double s_top = rail.s_at_highest_point();
  const CurvePoint top = rail.at(s_top);
  const double level = top.z + height;
  double y_least = top.y;
  double s_above = s_top;
  const auto below_top = static_cast<std::size_t>(std::lower_bound(k.s.begin(), k.s.end(), s_top) - k.s.begin());
  for (std::size_t i = below_top; i-- > 0;) {
    if (k.z[i] >= level) return std::min(y_least, rail.at(s_at_level(rail, level, k.s[i], s_above)).y);
    y_least = std::min(y_least, k.y[i]);
    s_above = k.s[i];
  }
  throw input_error(fmt::format("profile {}", k.name),
                    fmt::format("a gauge side that ends {:.6g} m below the top", k.z.front() - top.z),
                    fmt::format("one that reaches the gauge height {} m", height));
}

}  // namespace

void PairDimensions::validate() const {
  require(track_gauge >= 0.5 && track_gauge <= 2.0, "track gauge", track_gauge, "0.5 to 2");
  require(gauge_height >= 0.0 && gauge_height <= 0.05, "gauge height", gauge_height, "0 to 0.05");
  require(flange_back >= 0.4 && flange_back <= 2.0, "flange-back distance", flange_back, "0.4 to 2");
  require(nominal_radius >= 0.1 && nominal_radius <= 1.0, "nominal radius", nominal_radius, "0.1 to 1");
}

double track_gauge(const ProfileCurve& rail, double rail_offset, double gauge_height) {
  return 2.0 * (rail_offset + gauge_point(rail, gauge_height));
}

WheelRailPair::WheelRailPair(ProfileCurve wheel, ProfileCurve rail, PairDimensions dimensions)
    : wheel_(std::move(wheel)), rail_(std::move(rail)), dimensions_(dimensions) {
  dimensions_.validate();
  require_kind(wheel_, ProfileKind::wheel, "a wheel profile");
  require_kind(rail_, ProfileKind::rail, "a rail profile");
  require_origin(wheel_);
  tape_circle_offset_ = 0.5 * dimensions_.flange_back + PairDimensions::tape_circle_to_flange_back;
  rail_offset_ = 0.5 * dimensions_.track_gauge - gauge_point(rail_, dimensions_.gauge_height);
}

}  // namespace railtab
