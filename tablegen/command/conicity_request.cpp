#include "conicity_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "command/output_place.hpp"
#include "geometry_request.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

namespace po = boost::program_options;

namespace {

constexpr std::array error_sizes = {"random-error", "grid", "spacing"};

bool errors_chosen(const TableCommandLine& line) {
  return std::any_of(error_sizes.begin(), error_sizes.end(), [&](const char* option) { return line.chosen(option); });
}

/// The text of an option that has one of a few words.
template <class Value>
Value choice(const TableCommandLine& line, const std::string& option,
             std::initializer_list<std::pair<const char*, Value>> values) {
  const std::string found = line.text(option);
  std::string expected;
  for (const auto& [word, value] : values) {
    if (found == word) return value;
    expected += (expected.empty() ? "" : " or ") + std::string(word);
  }
  throw input_error("--" + option, fmt::format("\"{}\"", found), expected);
}

/// A built-in rail has its origin on its head, which the standard gauge puts some 3.5 mm farther out than the tape
/// circle: both at one distance would press the flanges against the rails.
void require_rail_file(const TableCommandLine& line, const std::string& rail_name) {
  if (is_file(rail_name)) return;
  throw input_error("--half-spacing", fmt::format("{} with the built-in rail {}", line.text("half-spacing"), rail_name),
                    "a rail file whose origin lies that far from the track's centre, or --gauge and --flange-back");
}

WheelRailPair requested_side(const TableCommandLine& line, const std::string& wheel_name, const std::string& rail_name,
                             double noise) {
  const double inclination = requested_inclination(line);
  const bool by_origins = line.chosen("half-spacing");
  const RailOrigin origin = by_origins ? RailOrigin::of_file : RailOrigin::highest_point;
  ProfileCurve wheel(load_profile(wheel_name, ProfileKind::wheel, inclination, noise));
  ProfileCurve rail(load_profile(rail_name, ProfileKind::rail, inclination, noise, origin));
  PairDimensions dimensions = requested_dimensions(line);
  if (by_origins) {
    const double half_spacing = line.number("half-spacing");
    require_between("--half-spacing", half_spacing, 0.3, 1.0, "m");
    require_rail_file(line, rail_name);
    dimensions.flange_back = 2.0 * (half_spacing - PairDimensions::tape_circle_to_flange_back);
    dimensions.track_gauge = track_gauge(rail, half_spacing, dimensions.gauge_height);
  }
  WheelRailPair pair(std::move(wheel), std::move(rail), dimensions);
  if (!by_origins) require_flanges_between_rails(pair);
  return pair;
}

WheelsetPair requested_wheelset(const TableCommandLine& line, double noise) {
  const std::string wheel = line.required("wheel"), rail = line.required("rail");
  return {requested_side(line, wheel, rail, noise),
          requested_side(line, line.given("left-wheel") ? line.text("left-wheel") : wheel,
                         line.given("left-rail") ? line.text("left-rail") : rail, noise)};
}

/// Files in different folders may have the same name: unlike sides are named as the options are.
std::string names_of(const TableCommandLine& line, const WheelRailPair& right) {
  const auto left = [&](const std::string& option) {
    return line.text((line.given("left-" + option) ? "left-" : "") + option);
  };
  const std::string wheel = line.text("wheel"), rail = line.text("rail");
  if (left("wheel") == wheel && left("rail") == rail) {
    return fmt::format("{} on {}", right.wheel().knots().name, right.rail().knots().name);
  }
  return fmt::format("right {} on {}, left {} on {}", wheel, rail, left("wheel"), left("rail"));
}

std::vector<double> requested_amplitudes(const TableCommandLine& line) {
  constexpr double most_count = 10000.0;
  constexpr double rounding = 1e-9;
  std::vector<std::string_view> fields;
  const std::string text = line.text("amplitudes");
  cut(text, ':', fields);
  double low = 0.0, high = 0.0, step = 0.0;
  if (fields.size() != 3 || !parse(fields[0], low) || !parse(fields[1], high) || !parse(fields[2], step) ||
      !(low > 0.0 && high >= low && high <= 0.1 && step > 0.0 && (high - low) / step < most_count)) {
    throw input_error("--amplitudes", fmt::format("\"{}\"", text),
                      "LO:HI:STEP, three numbers above 0 with LO not above HI, HI up to 0.1 m and up to 10000 steps");
  }
  std::vector<double> amplitudes;
  for (int k = 0; low + k * step <= high + rounding * step; ++k) amplitudes.push_back(low + k * step);
  return amplitudes;
}

void set_amplitudes(const TableCommandLine& line, ConicityRequest& request) {
  request.amplitude = line.number("amplitude");
  if (!(request.amplitude >= 1e-6 && request.amplitude <= 0.1)) {
    throw input_error("--amplitude", line.text("amplitude"), "a number in 1e-6..0.1 m");
  }
  if (line.given("reference")) {
    line.reject({"amplitudes"}, "no amplitudes beside --reference, whose file has its own");
    request.reference = read_conicity_bands(line.text("reference"));
    for (const ConicityBand& band : request.reference) request.amplitudes.push_back(band.amplitude);
  } else if (line.given("amplitudes")) {
    request.amplitudes = requested_amplitudes(line);
  }
}

WheelsetContactOptions contact_options(const TableCommandLine& line) {
  WheelsetContactOptions options;
  const NumberRange lateral = line.range("lateral");
  options.y_low = lateral.low;
  options.y_high = lateral.high;
  options.roll = choice<WheelsetRoll>(line, "roll", {{"on", WheelsetRoll::free}, {"off", WheelsetRoll::off}});
  options.diameter_difference = line.number("diameter-difference");
  options.sampling =
      choice<ShiftSampling>(line, "sampling", {{"refined", ShiftSampling::refined}, {"even", ShiftSampling::even}});
  options.step = line.number("step");
  options.validate();
  return options;
}

ConicityErrorOptions error_options(const TableCommandLine& line, const ConicityRequest& request) {
  ConicityErrorOptions options;
  options.errors = {
      line.number("random-error"), line.number("grid"), line.number("spacing"),
      choice<ErrorDirection>(line, "error-direction",
                             {{"y", ErrorDirection::y}, {"z", ErrorDirection::z}, {"both", ErrorDirection::both}})};
  options.errors.validate();
  options.smoothing = requested_noise(line);
  options.runs = static_cast<int>(line.whole_number("runs", 2, 100000));
  options.seed = static_cast<std::uint64_t>(line.whole_number("seed", 0, 1LL << 53));
  options.contact = request.contact;
  return options;
}

void set_table(const TableCommandLine& line, ConicityRequest& request) {
  line.reject({"wheel", "rail", "left-wheel", "left-rail", "smoothing", "rail-inclination", "gauge", "gauge-height",
               "flange-back", "wheel-radius", "half-spacing", "lateral", "random-error", "grid", "spacing"},
              "only with --wheel and --rail in place of a table");
  request.name = line.text("file");
  request.table.emplace(
      in_file(request.name, [&] { return TableContact(GeometryTable(read_geometry_table(request.name))); }));
}

void set_pair(const TableCommandLine& line, ConicityRequest& request) {
  if (line.chosen("half-spacing")) {
    line.reject({"gauge", "flange-back"}, "no gauge and no flange-back distance beside --half-spacing");
  }
  if (errors_chosen(line)) {
    require_rail_to_incline(line);  // built-in profiles with errors are smoothed, too
  } else {
    require_options_of_profiles(line);
  }
  const double noise = requested_noise(line);
  request.pair = requested_wheelset(line, noise);
  request.name = names_of(line, request.pair->right);
  if (!errors_chosen(line)) return;
  request.errors = error_options(line, request);
  request.exact = noise > 0.0 ? requested_wheelset(line, 0.0) : *request.pair;
}

}  // namespace

po::options_description conicity_options() {
  po::options_description pair = pair_options("Profiles in place of a table (SI units)");
  pair.add_options()("left-wheel", text_value()->value_name("P"), "where it is unlike the right one")  //
      ("left-rail", text_value()->value_name("P"), "where it is unlike the right one")                 //
      ("half-spacing", text_value()->value_name("M"),
       "in place of gauge and flange-back: distance of the origins of wheels and rails from the centre; "
       "a rail file keeps its origin")  //
      ("lateral", text_value("-0.010:0.010")->value_name("LO:HI"), "wheelset lateral shift");
  po::options_description conicity("Conicity");
  conicity.add_options()("file", text_value()->value_name("FILE.h5"), "a geometry table")                          //
      ("amplitude", text_value("3e-3")->value_name("M"), "of the kinematic wave")                                  //
      ("amplitudes", text_value()->value_name("LO:HI:STEP"), "of the curve; 0.5 mm apart")                         //
      ("diameter-difference", text_value("0")->value_name("M"), "right wheel's diameter minus left one's")         //
      ("roll", text_value("off")->value_name("on|off"), "off: as EN 15302; on: the wheelset rests on both rails")  //
      ("sampling", text_value("refined")->value_name("refined|even"),
       "of lateral shifts; even: at every --step alone, as the reference curves of EN 15302:2008")  //
      ("step", text_value("1e-4")->value_name("M"), "of lateral shifts, at most")                   //
      ("reference", text_value()->value_name("FILE"),
       "amplitudes [mm], reference conicities, upper and lower limits of the narrow and the wide band")  //
      ("output,o", text_value()->value_name("CSV"), "the curve over amplitudes");
  po::options_description errors("Errors of measured profiles (EN 15302, step 2)");
  errors.add_options()("random-error", text_value("0")->value_name("M"), "standard deviation of each coordinate")  //
      ("grid", text_value("0")->value_name("M"), "to which coordinates are rounded, its origin random")            //
      ("spacing", text_value("0")->value_name("M"), "of the points, the first one random; 0: as in the file")      //
      ("error-direction", text_value("both")->value_name("y|z|both"), "of random error and rounding")              //
      ("runs", text_value("20")->value_name("N"), "for wheels, for rails and for both")                            //
      ("seed", text_value("1")->value_name("N"), "of the random numbers");
  po::options_description own;
  own.add(conicity).add(pair).add(errors);
  return own;
}

ConicityRequest conicity_request(const TableCommandLine& line) {
  ConicityRequest request;
  set_amplitudes(line, request);
  request.contact = contact_options(line);
  if (!errors_chosen(line)) {
    line.reject({"runs", "seed", "error-direction"}, "only with --random-error, --grid or --spacing");
  }
  if (line.given("output")) {
    request.output = line.text("output");
    require_writable_place(request.output, "--output");
    require_replaceable_text(request.output, conicity_csv_mark);
  }
  line.given("file") ? set_table(line, request) : set_pair(line, request);
  return request;
}

}  // namespace railtab
