#include <fmt/format.h>

#include <array>
#include <optional>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "conicity_output.hpp"
#include "conicity_request.hpp"
#include "geometry_request.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

namespace {

void print_profile_notes(const TableCommandLine& line, const WheelsetPair& pair) {
  print_notes("conicity", pair.right);
  if (line.given("left-wheel") || line.given("left-rail")) print_notes("conicity", pair.left);
}

WheelsetFunctions computed_functions(const ConicityRequest& request) {
  std::optional<WheelsetFunctions> found =
      request.table ? in_file(request.name, [&] { return wheelset_functions(*request.table, request.contact); })
                    : wheelset_functions(searched_contacts(*request.pair, request.contact), request.contact);
  if (found) return std::move(*found);
  throw ComputationError(request.name + ": the centred wheelset does not touch both rails in the lateral range");
}

std::array<ConicityRuns, 3> computed_runs(const ConicityRequest& request, bool quiet) {
  if (!request.errors) return {};
  ProgressBar bar("errors", !quiet);
  const auto runs = [&](ErrorBearer bearer) {
    return conicity_with_errors(*request.exact, bearer, *request.errors, [&](double share) { bar.show(share); });
  };
  return {runs(ErrorBearer::wheels), runs(ErrorBearer::rails), runs(ErrorBearer::both)};
}

nlohmann::ordered_json pair_json(const WheelsetPair& pair) {
  const auto side = [](const WheelRailPair& p) {
    return nlohmann::ordered_json{{"wheel", p.wheel().knots().name},
                                  {"rail", p.rail().knots().name},
                                  {"gauge", p.dimensions().track_gauge},
                                  {"tape_circle_offset", p.tape_circle_offset()},
                                  {"rail_offset", p.rail_offset()}};
  };
  return {{"right", side(pair.right)}, {"left", side(pair.left)}};
}

void print_results(const TableCommandLine& line, const ConicityRequest& request, const WheelsetFunctions& functions,
                   const std::vector<ConicityPoint>& points) {
  const EquivalentConicity wave = conicity_of_wave(functions.radius_difference, request.amplitude);
  const EquivalentConicity regression = conicity_of_regression(functions.radius_difference, request.amplitude);
  if (!line.json()) {
    print_formatted("{}: equivalent conicity {} at an amplitude of {:g} mm (regression: {})\n", request.name,
                    conicity_text(wave), 1e3 * request.amplitude, conicity_text(regression));
    if (!line.quiet()) print_formatted("{}", functions_text(functions, request.amplitudes));
    if (!line.quiet()) print_formatted("{}", points_text(request, points));
    return;
  }
  nlohmann::ordered_json j{{"kind", "conicity"}};
  if (request.table) {
    j["file"] = request.name;
  } else {
    j["pair"] = pair_json(*request.pair);
  }
  j["amplitude"] = request.amplitude;
  j["wave"] = conicity_json(wave);
  j["regression"] = conicity_json(regression);
  j.update(functions_json(functions, request.amplitudes));
  j.update(points_json(request, points));
  print_json(j);
}

void require_wave(const ConicityRequest& request, const WheelsetFunctions& functions) {
  const EquivalentConicity wave = conicity_of_wave(functions.radius_difference, request.amplitude);
  if (wave.status == ConicityStatus::found) return;
  throw ComputationError(fmt::format("no equivalent conicity at an amplitude of {:g} m: {}", request.amplitude,
                                     wave.status == ConicityStatus::outside
                                         ? "the wave leaves the lateral range"
                                         : "no closed wave of this amplitude (negative conicity)"));
}

}  // namespace

void conicity_command(const std::vector<std::string>& arguments) {
  const TableCommandLine line("tablegen conicity FILE.h5 | --wheel P --rail P [options]", conicity_options(), {"file"},
                              arguments);
  if (line.help_printed()) return;
  ConicityRequest request = conicity_request(line);
  if (request.pair && !line.quiet()) print_profile_notes(line, *request.pair);
  const WheelsetFunctions functions = computed_functions(request);
  if (request.amplitudes.empty()) request.amplitudes = conicity_amplitudes(functions.radius_difference);
  if (request.errors) request.errors->amplitudes = request.amplitudes;
  const std::vector<ConicityPoint> points = conicity_points(request, functions, computed_runs(request, line.quiet()));
  if (!request.output.empty()) {
    write_text_file(request.output, points_csv(request, points), conicity_csv_mark);
  }
  print_results(line, request, functions, points);
  require_wave(request, functions);
}

}  // namespace railtab
