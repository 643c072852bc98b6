#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "fmu_file.hpp"
#include "railtab/fmi/track_variables.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

void print_summary(const std::string& output, const fmi::DrivenTrack& track) {
  const auto& [left, right] = track.structure.rail;
  print_formatted("FMU: {}\n", output);
  print_formatted("  track from x = {:.6g} to {:.6g} m, {} degrees of freedom\n", left.x.front(), left.x.back(),
                  track.structure.dofs());
  print_formatted("  {} wheelsets, the first at x = {:.6g} m; {} nodes\n", track.wheelset_x.size(),
                  track.wheelset_x.front(), track.structure.nodes.size());
  print_formatted("  step {:g} s\n", track.scheme.time_step);
}

void print_as_json(const std::string& output, const fmi::DrivenTrack& track) {
  const RailLine& rail = track.structure.rail[0];
  print_json_line({{"fmu", output},
                   {"track", {rail.x.front(), rail.x.back()}},
                   {"unknowns", track.structure.dofs()},
                   {"wheelsets", track.wheelset_x.size()},
                   {"nodes", track.structure.nodes.size()},
                   {"variables", fmi::track_variables(track).size()},
                   {"time_step", track.scheme.time_step}});
}

}  // namespace

int fmu_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "whose track and bridges are written")  //
      ("output,o", text_value()->value_name("TRACK.fmu"),
       "FMU for co-simulation by FMI 2.0: loads of wheels in, motions of rails out");
  const CommandLine line("vsi fmu SCENE.toml -o TRACK.fmu", own, {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::filesystem::path file = line.required("scene");
  const std::string output = line.required("output");
  require_fitting_name(output, "-o", "an FMU", {".fmu"});
  require_writable_place(output, "-o");
  const SceneParameters scene = read_scene(file, {}, SceneFiles::of_train_and_structure);
  require_no_input(output, {file});
  for (const std::filesystem::path& read : scene.files) require_no_input(output, {read});
  try {
    const fmi::DrivenTrack track = fmu::driven_track(scene);
    for (const std::string& warning : track.structure.warnings) line.warn(warning);
    fmu::write_fmu(output, track, scene.text);
    if (line.json()) {
      print_as_json(output, track);
    } else if (!line.quiet()) {
      print_summary(output, track);
    }
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, file);
  }
  return 0;
}

}  // namespace railtab::vsi
