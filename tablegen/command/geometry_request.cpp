#include "geometry_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/profile/point_noise.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "wheelset_functions.hpp"

namespace railtab {

namespace {

/// As load_profile() takes a name: built-in ones first.
bool is_profile_file(ProfileKind kind, const std::string& name) {
  return !is_standard_profile(kind, name) && is_file(name);
}

double length_between(const TableCommandLine& line, const std::string& option, double low, double high) {
  const double length = line.number(option);
  require_between("--" + option, length, low, high, "m");
  return length;
}

/// y of the flange's face, `depth` below the tread, in the wheel's frame; none of a wheel without a flange.
std::optional<double> flange_face(const ProfileCurve& wheel, double depth) {
  const ProfileKnots& k = wheel.knots();
  const auto tread =
      static_cast<std::size_t>(std::lower_bound(k.s.begin(), k.s.end(), wheel.s_at_y(0.0)) - k.s.begin());
  for (std::size_t i = tread; i-- > 0;) {
    if (k.z[i] >= depth) return k.y[i];
  }
  return std::nullopt;
}

}  // namespace

PairDimensions requested_dimensions(const TableCommandLine& line) {
  PairDimensions d;
  d.track_gauge = length_between(line, "gauge", 0.5, 2.0);
  d.gauge_height = length_between(line, "gauge-height", 0.0, 0.05);
  d.flange_back = length_between(line, "flange-back", 0.4, 2.0);
  d.nominal_radius = length_between(line, "wheel-radius", 0.1, 1.0);
  return d;
}

double requested_inclination(const TableCommandLine& line) {
  const double inclination = line.slope("rail-inclination");
  if (inclination >= 0.0 && inclination <= 0.1) return inclination;
  throw input_error("--rail-inclination", line.text("rail-inclination"), "0 (upright) to 0.1, such as 1:40 or 0.025");
}

double requested_noise(const TableCommandLine& line) {
  constexpr double largest = 1e-3;  // m
  const double noise = line.number("smoothing");
  if (noise >= 0.0 && noise <= largest) return noise;
  throw input_error("--smoothing", line.text("smoothing"),
                    fmt::format("0 to {} m, the standard deviation of the noise, such as 3e-6", largest));
}

void require_rail_to_incline(const TableCommandLine& line) {
  if (!line.chosen("rail-inclination")) return;
  const std::string rail = line.required("rail");
  const auto is_rail_file = [](const std::string& name) { return is_profile_file(ProfileKind::rail, name); };
  if (!is_rail_file(rail) || (line.given("left-rail") && !is_rail_file(line.text("left-rail")))) return;
  throw input_error("--rail-inclination", fmt::format("{} with the rail file {}", line.text("rail-inclination"), rail),
                    "a built-in rail, or no --rail-inclination: the points of a file are those of the inclined rail");
}

void require_options_of_profiles(const TableCommandLine& line) {
  require_rail_to_incline(line);
  if (requested_noise(line) == 0.0) return;
  const std::string wheel = line.required("wheel"), rail = line.required("rail");
  if (is_profile_file(ProfileKind::wheel, wheel) || is_profile_file(ProfileKind::rail, rail)) return;
  if (line.given("left-wheel") && is_profile_file(ProfileKind::wheel, line.text("left-wheel"))) return;
  if (line.given("left-rail") && is_profile_file(ProfileKind::rail, line.text("left-rail"))) return;
  throw input_error("--smoothing",
                    fmt::format("{} with the built-in profiles {} and {}", line.text("smoothing"), wheel, rail),
                    "a profile file, or no --smoothing: built-in profiles have no noise");
}

void require_flanges_between_rails(const WheelRailPair& pair) {
  const PairDimensions& d = pair.dimensions();
  const std::optional<double> face = flange_face(pair.wheel(), d.gauge_height);
  if (!face) return;
  const double width = 2.0 * (pair.tape_circle_offset() + *face);
  if (width < d.track_gauge) return;
  throw input_error("--flange-back",
                    fmt::format("{} m, with which the flanges are {:.4g} m wide over their outer faces, {:.3g} mm "
                                "below the tread",
                                d.flange_back, width, 1e3 * d.gauge_height),
                    fmt::format("flanges that fit between the rails, narrower than the track gauge of {} m (--gauge)",
                                d.track_gauge));
}

namespace {

WheelRailPair pair_smoothed_by(const TableCommandLine& line, double noise) {
  const double inclination = requested_inclination(line);
  ProfileCurve wheel(load_profile(line.required("wheel"), ProfileKind::wheel, inclination, noise));
  ProfileCurve rail(load_profile(line.required("rail"), ProfileKind::rail, inclination, noise));
  WheelRailPair pair(std::move(wheel), std::move(rail), requested_dimensions(line));
  require_flanges_between_rails(pair);
  return pair;
}

/// At 3 mm. Refined samples would follow every bump of the noise.
std::string conicity_of(const WheelRailPair& pair) {
  const ContactSearch search(pair);
  const WheelsetContactOptions options{.y_low = -6e-3, .y_high = 6e-3, .sampling = ShiftSampling::even};
  const auto functions = wheelset_functions(wheelset_contacts(search, options), options);
  return functions ? conicity_text(conicity_of_wave(functions->radius_difference, 3e-3)) : "no contact";
}

}  // namespace

WheelRailPair requested_pair(const TableCommandLine& line) { return pair_smoothed_by(line, requested_noise(line)); }

GeometryRequest geometry_request(const TableCommandLine& line) {
  const std::string file = line.required("output");
  const std::string wheel_name = line.required("wheel");
  const std::string rail_name = line.required("rail");
  require_output(file, {geometry_table_filetype});
  require_no_input(file, {wheel_name, rail_name});
  GeometrySweepOptions options;
  options.lateral = line.interval("lateral");
  options.yaw = line.interval("yaw");
  options.roll = line.interval("roll");
  options.tolerance = line.number("tolerance");
  const double refinement = line.number("refinement");
  if (!(refinement >= 0 && refinement <= 4 && refinement == std::floor(refinement))) {
    throw input_error("--refinement", line.text("refinement"), "0, 1, 2, 3 or 4");
  }
  options = options.refined(static_cast<int>(refinement));
  if (line.given("shard")) options.shard = line.shard("shard");
  options.validate();
  return {file, options, ContactSearch(requested_pair(line))};
}

void print_notes(const std::string& command, const WheelRailPair& pair) {
  for (const ProfileCurve* profile : {&pair.wheel(), &pair.rail()}) {
    for (const std::string& note : profile->knots().notes)
      print_message(fmt::format("tablegen {}: note: {}\n", command, note));
    const PointNoise noise = point_noise(profile->knots());
    if (const std::string warning = noise_warning(profile->knots().name, noise); !warning.empty()) {
      print_message(fmt::format("tablegen {}: warning: {}; smooth them by --smoothing {:.1g}\n", command, warning,
                                noise.smoothing));
    }
  }
}

void print_effect_of_smoothing(const TableCommandLine& line, const WheelRailPair& pair) {
  double deviation = 0.0;
  for (const ProfileCurve* profile : {&pair.wheel(), &pair.rail()}) {
    const PointNoise noise = point_noise(profile->knots());
    if (!noise_warning(profile->knots().name, noise).empty()) deviation = std::max(deviation, noise.smoothing);
  }
  if (deviation == 0.0) return;
  const std::string proposed = fmt::format("{:.1g}", deviation);
  print_message(
      fmt::format("tablegen geometry: equivalent conicity at 3 mm: {} as the profiles are, {} with "
                  "--smoothing {}\n",
                  conicity_of(pair), conicity_of(pair_smoothed_by(line, std::stod(proposed))), proposed));
}

}  // namespace railtab
