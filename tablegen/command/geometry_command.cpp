#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "command_line.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/tables/geometry_table_file.hpp"
#include "railtab/tables/input_error.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

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
      ("shard", text_value("1/1")->value_name("I/N"), "make part I of N only, for tablegen merge")              //
      ("output,o", po::value<std::string>()->value_name("FILE.h5"), "the table");
  return own;
}

PairDimensions dimensions(const CommandLine& line) {
  PairDimensions d;
  d.track_gauge = line.number("gauge");
  d.gauge_height = line.number("gauge-height");
  d.flange_back = line.number("flange-back");
  d.nominal_radius = line.number("wheel-radius");
  return d;
}

TableShard shard(const CommandLine& line) {
  const std::string text = line.required("shard");
  TableShard result;
  const char* const end = text.data() + text.size();
  const auto [slash, first_error] = std::from_chars(text.data(), end, result.index);
  const bool separated = first_error == std::errc() && slash != end && *slash == '/';
  if (separated) {
    const auto [last, error] = std::from_chars(slash + 1, end, result.count);
    if (error == std::errc() && last == end) return result;
  }
  throw input_error("--shard", text, "I/N, part I of N");
}

void check_folder(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder)) {
    throw input_error("--output " + file, "no folder " + folder.string(), "a file in an existing folder");
  }
}

}  // namespace

void geometry_command(const std::vector<std::string>& arguments) {
  const CommandLine line("tablegen geometry --wheel P --rail P [options] -o FILE.h5", geometry_options(), {},
                         arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("output");
  const std::string wheel_name = line.required("wheel");
  const std::string rail_name = line.required("rail");
  check_folder(file);
  require_no_input(file, {wheel_name, rail_name});
  GeometrySweepOptions options;
  options.lateral = line.interval("lateral");
  options.yaw = line.interval("yaw");
  options.roll = line.interval("roll");
  options.tolerance = line.number("tolerance");
  options.shard = shard(line);
  options.validate();

  const double inclination = line.slope("rail-inclination");
  const double noise = line.number("smoothing");
  if (!(noise >= 0.0)) throw input_error("--smoothing", line.text("smoothing"), "a length, 0 or above");
  ProfileCurve wheel(load_profile(wheel_name, ProfileKind::wheel, inclination, noise));
  ProfileCurve rail(load_profile(rail_name, ProfileKind::rail, inclination, noise));
  // To stderr, before the table is made: what was repaired should be looked at.
  for (const ProfileCurve* profile : {&wheel, &rail}) {
    for (const std::string& note : profile->knots().notes) {
      if (!line.quiet()) fmt::print(stderr, "tablegen geometry: note: {}\n", note);
    }
  }
  const ContactSearch search(WheelRailPair(std::move(wheel), std::move(rail), dimensions(line)));
  ProgressBar bar("geometry table", !line.quiet());
  GeometryTableData table = generate_geometry_table(search, options, [&](double share) { bar.show(share); });
  table.provenance.program_version = RAILTAB_VERSION;
  table.provenance.command_line = fmt::format("tablegen geometry {}", fmt::join(arguments, " "));
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  table.provenance.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
  write_geometry_table(file, table);
  if (line.json()) {
    fmt::print("{}\n", table_description(table, file).dump(2));
  } else if (!line.quiet()) {
    fmt::print("{}", table_text(table, file));
  }
}

}  // namespace railtab
