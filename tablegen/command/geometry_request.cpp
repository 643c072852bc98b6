#include "geometry_request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

PairDimensions requested_dimensions(const TableCommandLine& line) {
  PairDimensions d;
  d.track_gauge = line.number("gauge");
  d.gauge_height = line.number("gauge-height");
  d.flange_back = line.number("flange-back");
  d.nominal_radius = line.number("wheel-radius");
  return d;
}

double requested_noise(const TableCommandLine& line) {
  const double noise = line.number("smoothing");
  if (!(noise >= 0.0)) throw input_error("--smoothing", line.text("smoothing"), "a length, 0 or above");
  return noise;
}

WheelRailPair requested_pair(const TableCommandLine& line) {
  const double inclination = line.slope("rail-inclination");
  const double noise = requested_noise(line);
  ProfileCurve wheel(load_profile(line.required("wheel"), ProfileKind::wheel, inclination, noise));
  ProfileCurve rail(load_profile(line.required("rail"), ProfileKind::rail, inclination, noise));
  return WheelRailPair(std::move(wheel), std::move(rail), requested_dimensions(line));
}

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
  }
}

}  // namespace railtab
