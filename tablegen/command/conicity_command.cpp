#include <fmt/format.h>

#include <optional>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"
#include "wheelset_functions.hpp"

namespace railtab {

namespace {

WheelsetRoll roll_option(const TableCommandLine& line) {
  const std::string found = line.text("roll");
  if (found == "on") return WheelsetRoll::free;
  if (found == "off") return WheelsetRoll::off;
  throw input_error("--roll", fmt::format("\"{}\"", found), "on or off");
}

}  // namespace

void conicity_command(const std::vector<std::string>& arguments) {
  namespace po = boost::program_options;
  po::options_description own("Options (SI units)");
  own.add_options()("file", po::value<std::string>()->value_name("FILE.h5"), "a geometry table")                //
      ("amplitude", text_value("3e-3")->value_name("M"), "of the kinematic wave")                               //
      ("diameter-difference", text_value("0")->value_name("M"), "right wheel's diameter minus the left one's")  //
      ("roll", text_value("off")->value_name("on|off"), "off: as EN 15302; on: the wheelset rests on both rails");
  const TableCommandLine line("tablegen conicity FILE.h5 [options]", own, {"file"}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("file");
  const double amplitude = line.number("amplitude");
  if (!(amplitude >= 1e-6 && amplitude <= 0.1)) {
    throw input_error("--amplitude", line.text("amplitude"), "a number in 1e-6..0.1 m");
  }
  const WheelsetRoll roll = roll_option(line);
  const double difference = line.number("diameter-difference");
  const TableContact table = in_file(file, [&] { return TableContact(GeometryTable(read_geometry_table(file))); });
  const std::optional<WheelsetFunctions> found =
      in_file(file, [&] { return wheelset_functions(table, roll, difference); });
  if (!found) throw ComputationError(file + ": the centred wheelset does not touch both rails in the table's range");
  const WheelsetFunctions& functions = *found;
  const EquivalentConicity wave = conicity_of_wave(functions.radius_difference, amplitude);
  const EquivalentConicity regression = conicity_of_regression(functions.radius_difference, amplitude);
  if (line.json()) {
    nlohmann::ordered_json j{{"kind", "conicity"}, {"file", file}, {"amplitude", amplitude}};
    j["wave"] = conicity_json(wave);
    j["regression"] = conicity_json(regression);
    j.update(functions_json(functions));
    print_json(j);
  } else {
    print_formatted("{}: equivalent conicity {} at an amplitude of {:g} mm (regression: {})\n", file,
                    conicity_text(wave), 1e3 * amplitude, conicity_text(regression));
    if (!line.quiet()) print_formatted("{}", functions_text(functions));
  }
  if (wave.status != ConicityStatus::found) {
    throw ComputationError(fmt::format("no equivalent conicity at an amplitude of {:g} m: {}", amplitude,
                                       wave.status == ConicityStatus::outside
                                           ? "the wave leaves the table's lateral range"
                                           : "no closed wave of this amplitude (negative conicity)"));
  }
}

}  // namespace railtab
