#include <fmt/format.h>

#include <string_view>

#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/process_memory.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab::vsi {
namespace {

constexpr const char* usage =
    "usage: vsi COMMAND [OPTIONS]; vsi COMMAND --help says more; vsi FILE says what a file is\n"
    "  new     SCENE.toml [--train NAME] [--span METRES]      write a first scene\n"
    "  check   SCENE.toml [-o LAYOUT.svg]                     validate a scene and draw its layout\n"
    "  contact TABLE.h5 --query Q.csv -o R.csv [--online]     contact patches of a wheelset's positions\n"
    "  creep   --query Q.csv -o R.csv [--law LAW]             normalised creep forces\n"
    "  run     SCENE.toml [-o RESULTS.h5]                     run a train over a track or bridge\n"
    "  sweep   SCENE.toml --speed LO:HI:STEP -o DIR           the same over speeds and random tracks\n"
    "  study   PLAN.toml -o DIR                               runs over any keys, probabilities, fragility curves\n"
    "  report  RESULTS.h5... -o REPORT.html                   results as one page; several: compared\n"
    "  export  RESULTS.h5 [-o FILE.pvd]                       results as files for ParaView\n"
    "  structure SCENE.toml [--modes N]                       mass, extent and natural frequencies of its bridge\n"
    "  moving-load SCENE.toml --speed LO:HI[:STEP]            its deck under HSLM-A or other axle loads, without "
    "contact\n"
    "  assess  SCENE.toml [-o DIR]                            check its bridge by the limits of the standards\n"
    "  critical-speed SCENE.toml [--amplitude M]              linear critical speed of its vehicle on its profiles\n"
    "  vehicle [NAME|FILE.toml]                               masses, axle loads and modes of a vehicle; none: the "
    "library\n";

int dispatch(const Arguments& arguments) {
  if (arguments.empty()) throw InputError(fmt::format("no command\n{}", usage));
  const std::string_view name = arguments.front();
  const Arguments rest(arguments.begin() + 1, arguments.end());
  if (name == "contact") return contact_command(rest);
  if (name == "creep") return creep_command(rest);
  if (name == "run") return run_command(rest);
  if (name == "sweep") return sweep_command(rest);
  if (name == "study") return study_command(rest);
  if (name == "report") return report_command(rest);
  if (name == "export") return export_command(rest);
  if (name == "structure") return structure_command(rest);
  if (name == "assess") return assess_command(rest);
  if (name == "moving-load") return moving_load_command(rest);
  if (name == "critical-speed") return critical_speed_command(rest);
  if (name == "vehicle") return vehicle_command(rest);
  if (name == "check") return check_command(rest);
  if (name == "new") return new_command(rest);
  if (name == "--help" || name == "-h") {
    print_formatted("{}", usage);
    return 0;
  }
  if (name == "--version") {
    print_formatted("railtab {}\n", RAILTAB_VERSION);
    return 0;
  }
  if (is_file(name)) return describe_command(arguments);
  throw InputError(fmt::format("unknown command '{}'\n{}", name, usage));
}

}  // namespace
}  // namespace railtab::vsi

int main(int argc, char** argv) {
  railtab::return_large_pieces();
  return railtab::run_process("vsi", [&] { return railtab::vsi::dispatch({argv + 1, argv + argc}); });
}
