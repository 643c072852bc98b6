#include "command/command_table.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/process_memory.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab::vsi {
namespace {

const CommandTable& commands() {
  static const CommandTable table{
      "vsi",
      "run trains over tracks and bridges with three-dimensional wheel-rail contact",
      "says what the file is, and what can be done with it",
      {{"new", "SCENE.toml [--train NAME] [--span METRES]", "write a first scene", new_command},
       {"check", "SCENE.toml [-o LAYOUT.svg]", "validate a scene and draw its layout", check_command},
       {"contact", "TABLE.h5 --query Q.csv -o R.csv [--online]", "contact patches of a wheelset's positions",
        contact_command},
       {"creep", "--query Q.csv -o R.csv [--law LAW]", "normalised creep forces", creep_command},
       {"run", "SCENE.toml [-o RESULTS.h5]", "run a train over a track or bridge", run_command},
       {"sweep", "SCENE.toml --speed LO:HI:STEP -o DIR", "the same over speeds and random tracks", sweep_command},
       {"study", "PLAN.toml -o DIR", "runs over any keys, probabilities, fragility curves", study_command},
       {"report", "RESULTS.h5... -o REPORT.html", "results as one page; several: compared", report_command},
       {"export", "RESULTS.h5 [-o FILE.pvd]", "results as files for ParaView", export_command},
       {"fmu", "SCENE.toml -o TRACK.fmu", "its track and bridges as an FMU, for other programs", fmu_command},
       {"structure", "SCENE.toml [--modes N]", "mass, extent and natural frequencies of its bridge", structure_command},
       {"moving-load", "SCENE.toml --speed LO:HI[:STEP]", "its deck under HSLM-A or other axle loads, without contact",
        moving_load_command},
       {"assess", "SCENE.toml [-o DIR]", "check its bridge by the limits of the standards", assess_command},
       {"critical-speed", "SCENE.toml [--amplitude M]", "linear critical speed of its vehicle on its profiles",
        critical_speed_command},
       {"vehicle", "[NAME|FILE.toml]", "masses, axle loads and modes of a vehicle; none: the library",
        vehicle_command}},
      {{exit_code::done, "done"},
       {exit_code::failed, "the computation failed"},
       {exit_code::wrong_input, "the input is wrong"},
       {exit_code::clause_fails, "computed, and a limit fails (assess --fail-on)"},
       {exit_code::interrupted, "ended by Ctrl-C"}}};
  return table;
}

int run_arguments(const Arguments& arguments) {
  if (arguments.empty() || commands().find(arguments.front())) return run_command_table(commands(), arguments);
  const std::string& name = arguments.front();
  if (is_file(name)) return describe_command(arguments);
  const std::string_view there = what_is_at(name);
  const bool folder = there == "a folder";
  const bool meant_as_file = !name.starts_with('-') && name.find_first_of("./") != std::string::npos;
  if (folder || meant_as_file) {
    throw input_error(
        name, there,
        folder ? "a file, as of those in this folder, or a command (vsi --help)" : "a file, or a command (vsi --help)");
  }
  return run_command_table(commands(), arguments);
}

}  // namespace
}  // namespace railtab::vsi

int main(int argc, char** argv) {
  railtab::return_large_pieces();
  return railtab::run_process("vsi", [&] { return railtab::vsi::run_arguments({argv + 1, argv + argc}); });
}
