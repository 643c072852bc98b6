#include <fmt/format.h>

#include <string>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

po::options_description loaded_options() {
  const LoadedSweepOptions defaults;
  po::options_description own("Options (SI units)");
  own.add_options()("file", po::value<std::string>()->value_name("FILE.h5"), "the geometry table of the pair")  //
      ("lateral", text_value("-0.008:0.008")->value_name("LO:HI"),
       "wheelset lateral shift at the roll -climb * shift, without yaw")                //
      ("yaw", text_value("0.010")->value_name("RAD"), "largest wheelset yaw; 0: none")  //
      ("yaw-nodes", text_value("4")->value_name("N"), "nodes of yaw^2, 2 to 9")         //
      ("roll", text_value("-0.005:0.005")->value_name("LO:HI"),
       "wheelset roll against the rail head plus climb * shift, LO below HI")  //
      ("climb", text_value("0")->value_name("RAD/M"),
       "roll that a wheelset loses per lateral shift as it climbs a flange")  //
      ("roll-spacing", text_value("0.001")->value_name("RAD"),
       "distance of the table's nodes of roll, at most; halved once where pressures between them are off by more than "
       "4 %")  //
      ("largest-load", text_value("300e3")->value_name("N"),
       "vertical force of the centred wheel at the last level of energy")  //
      ("levels", text_value("33")->value_name("N"), "levels of energy")    //
      ("force-error", text_value("2.5e-3")->value_name("E"),
       "relative error of the force above 5 kN at which the lateral nodes are refined")                   //
      ("light-error", text_value("8e-3")->value_name("E"), "the same from 1 to 5 kN")                     //
      ("elements", text_value("28")->value_name("N"), "elements across the narrowest part of a contact")  //
      ("modulus", text_value("210e9")->value_name("PA"), "Young's modulus of wheel and rail")             //
      ("poisson", text_value("0.28")->value_name("NU"), "Poisson's ratio of wheel and rail");
  return own;
}

LoadedSweepOptions requested(const TableCommandLine& line) {
  LoadedSweepOptions options;
  options.lateral = line.interval("lateral");
  options.yaw = line.number("yaw");
  options.yaw_nodes = static_cast<int>(line.whole_number("yaw-nodes", 2, LoadedTable::most_yaws));
  options.roll = line.interval("roll");
  options.climb = line.number("climb");
  options.roll_spacing = line.number("roll-spacing");
  options.largest_load = line.number("largest-load");
  options.levels = static_cast<int>(line.whole_number("levels", 5, 1000));
  options.force_error = line.number("force-error");
  options.light_error = line.number("light-error");
  options.contact.elements.across_narrowest = static_cast<int>(line.whole_number("elements", 4, 1000));
  options.contact.wheel = options.contact.rail = {line.number("modulus"), line.number("poisson")};
  if (options.yaw == 0.0 && line.chosen("yaw-nodes")) {
    throw input_error("--yaw-nodes", "given with --yaw 0", "a range of yaw to divide");
  }
  options.validate();
  return options;
}

}  // namespace

void loaded_command(const std::vector<std::string>& arguments) {
  const TableCommandLine line("tablegen loaded FILE.h5 [options]", loaded_options(), {"file"}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("file");
  ProgressBar bar("loaded contact", !line.quiet());
  add_loaded_table(file, requested(line), provenance("loaded", arguments), [&](double share) { bar.show(share); });
  const GeometryTableData table = read_geometry_table(file);
  if (const double error = table.loaded->certified_force_error(); error > largest_certified_force_error) {
    const std::string warning = fmt::format(
        "tablegen loaded: warning: {}: the force above 5 kN is off by {:.2g} % (99 % of its check), more than {:.0f} "
        "%; runs use it only with contact.elastic = \"half-space\". Where the contact jumps may differ too much with "
        "roll and yaw for one table (smaller --roll, --yaw or --lateral, another --climb), or nodes be too far apart "
        "(--levels, --yaw-nodes, --roll-spacing, --elements, --force-error).\n",
        file, 100.0 * error, 100.0 * largest_certified_force_error);
    print_message(warning);
  }
  if (line.quiet() && !line.json()) return;
  if (line.json()) {
    print_json(table_description(table, file));
  } else {
    print_formatted("{}", table_text(table, file));
  }
}

}  // namespace railtab
