#include "geometry_request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/tables/geometry_table_file.hpp"
#include "railtab/tables/input_error.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab {

namespace po = boost::program_options;

namespace {

PairDimensions dimensions(const CommandLine& line) {
  PairDimensions d;
  d.track_gauge = line.number("gauge");
  d.gauge_height = line.number("gauge-height");
  d.flange_back = line.number("flange-back");
  d.nominal_radius = line.number("wheel-radius");
  return d;
}

}  // namespace

po::options_description geometry_options() {
  po::options_description own("Options (SI units)");
  own.add_options()("wheel", po::value<std::string>()->value_name("P"), "wheel profile: built-in name or file")  //
      ("rail", po::value<std::string>()->value_name("P"), "rail profile: built-in name or file")                 //
      ("smoothing", text_value("0")->value_name("M"),
       "measuring noise of profile files, standard deviation normal to the outline; 0: no smoothing")           //
      ("rail-inclination", text_value("1:40")->value_name("1:N"), "of a built-in rail")                         //
      ("gauge", text_value("1.435")->value_name("M"), "track gauge")                                            //
      ("gauge-height", text_value("0.014")->value_name("M"), "depth of the gauge points below the rail heads")  //
      ("flange-back", text_value("1.360")->value_name("M"), "distance of the flange backs")                     //
      ("wheel-radius", text_value("0.460")->value_name("M"), "nominal radius")                                  //
      ("lateral", text_value("-0.012:0.012")->value_name("LO:HI"), "wheelset lateral shift")                    //
      ("yaw", text_value("-0.030:0.030")->value_name("LO:HI"), "wheelset yaw")                                  //
      ("roll", text_value("0:0")->value_name("LO:HI"), "wheelset roll against the rail head")                   //
      ("tolerance", text_value("1e-8")->value_name("M"), "penetration error asked for")                         //
      ("refinement", text_value("0")->value_name("N"),
       "finer cells from the start, each time as after a missed tolerance (0..4)")                            //
      ("shard", po::value<std::string>()->value_name("I/N"), "make one of N parts only, for tablegen merge")  //
      ("output,o", po::value<std::string>()->value_name("FILE.h5"), "the table, or the shard");
  return own;
}

GeometryRequest geometry_request(const CommandLine& line) {
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

  const double inclination = line.slope("rail-inclination");
  const double noise = line.number("smoothing");
  if (!(noise >= 0.0)) throw input_error("--smoothing", line.text("smoothing"), "a length, 0 or above");
  ProfileCurve wheel(load_profile(wheel_name, ProfileKind::wheel, inclination, noise));
  ProfileCurve rail(load_profile(rail_name, ProfileKind::rail, inclination, noise));
  return {file, options, ContactSearch(WheelRailPair(std::move(wheel), std::move(rail), dimensions(line)))};
}

void print_notes(const GeometryRequest& request) {
  const WheelRailPair& pair = request.search.pair();
  for (const ProfileCurve* profile : {&pair.wheel(), &pair.rail()}) {
    for (const std::string& note : profile->knots().notes) fmt::print(stderr, "tablegen geometry: note: {}\n", note);
  }
}

}  // namespace railtab
