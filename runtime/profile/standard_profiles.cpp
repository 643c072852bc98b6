#include "railtab/runtime/profile/standard_profiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/conic_arc_wheel.hpp"
#include "railtab/runtime/profile/lma_type_wheel.hpp"
#include "railtab/runtime/profile/profile_segments.hpp"
#include "railtab/runtime/profile/profile_text.hpp"
#include "railtab/runtime/profile/rail_head.hpp"
#include "railtab/runtime/profile/s1002_wheel.hpp"

namespace railtab {

namespace {

/// Cone z = -slope y over the width of a wheel: the radius grows towards the flange side, there is no flange.
std::vector<ProfileSegment> cone_segments(double slope) {
  constexpr double y_begin = -0.070;
  constexpr double y_end = 0.060;
  return {straight_segment({y_begin, -slope * y_begin}, {y_end, -slope * y_end})};
}

/// Half-circle of knife_edge_radius on top of an upright blade. Inclination would turn the circle in itself.
std::vector<ProfileSegment> knife_edge_segments() {
  constexpr double r = knife_edge_radius;
  constexpr double blade_depth = 37.5e-3;
  using std::numbers::pi;
  return {straight_segment({-r, blade_depth}, {-r, r}), arc_segment({0, r}, r, 1.5 * pi, 0.5 * pi),
          straight_segment({r, r}, {r, blade_depth})};
}

struct Entry {
  ProfileKind kind;
  std::string_view name;   ///< the name that is written to tables
  std::string_view alias;  ///< second name, or empty
  std::vector<ProfileSegment> (*segments)(double rail_inclination);
  bool for_pairs = true;  ///< false: for tests of curves, since the contact search rejects it as too narrow
};

constexpr std::array<Entry, 9> entries{{
    {ProfileKind::wheel, "S1002", "", [](double) { return s1002_segments(); }},
    {ProfileKind::wheel, "cone-1:20", "", [](double) { return cone_segments(1.0 / 20.0); }},
    {ProfileKind::wheel, "cone-1:40", "", [](double) { return cone_segments(1.0 / 40.0); }},
    {ProfileKind::wheel, "LMA-type", "", [](double) { return lma_type_segments(); }},
    {ProfileKind::wheel, "conic-arc-stand-in", "", [](double) { return conic_arc_stand_in_segments(); }},
    {ProfileKind::rail, "60E1", "UIC60", [](double inclination) { return rail_head_segments(rail_60e1, inclination); }},
    {ProfileKind::rail, "CHN60", "", [](double inclination) { return rail_head_segments(rail_chn60, inclination); }},
    {ProfileKind::rail, "JIS60-stand-in", "",
     [](double inclination) { return rail_head_segments(rail_jis60_stand_in, inclination); }},
    {ProfileKind::rail, "knife-edge", "", [](double) { return knife_edge_segments(); }, false},
}};

}  // namespace

std::vector<std::string> standard_profile_names(ProfileKind kind) {
  std::vector<std::string> names;
  for (const Entry& e : entries) {
    if (e.kind != kind || !e.for_pairs) continue;
    names.emplace_back(e.name);
    if (!e.alias.empty()) names.emplace_back(e.alias);
  }
  return names;
}

bool is_standard_profile(ProfileKind kind, std::string_view name) {
  const std::vector<std::string> names = standard_profile_names(kind);
  return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return same_ignoring_case(n, name); });
}

ProfileKnots standard_profile(ProfileKind kind, std::string_view name, double rail_inclination) {
  const bool wheel = kind == ProfileKind::wheel;
  if (!wheel && !(rail_inclination >= 0.0 && rail_inclination <= 0.1)) {
    throw input_error("rail inclination", fmt::format("{}", rail_inclination),
                      "a tangent from 0 (upright) to 0.1, such as 0.025 for 1:40");
  }
  for (const Entry& e : entries) {
    if (e.kind == kind &&
        (same_ignoring_case(name, e.name) || (!e.alias.empty() && same_ignoring_case(name, e.alias)))) {
      ProfileKnots knots = spline_segments(kind, std::string(e.name), e.segments(rail_inclination));
      if (!wheel)
        knots.inclination = rail_inclination > 0.0 ? fmt::format("1:{:.6g}", 1.0 / rail_inclination) : "upright";
      return knots;
    }
  }
  throw input_error(wheel ? "wheel profile" : "rail profile", fmt::format("\"{}\"", name),
                    fmt::format("one of {}", fmt::join(standard_profile_names(kind), ", ")));
}

}  // namespace railtab
