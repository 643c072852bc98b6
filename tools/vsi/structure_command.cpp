#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/mode_files.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/structure/mode_output.hpp"
#include "railtab/runtime/structure/structure_summary.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

/// Summary of a bridge, and what its modes leave out of it.
struct Found {
  StructureSummary summary;
  std::vector<std::string> left_out;
};

Found summary_of(const SceneParameters& scene, int modes) {
  if (scene.structure.files.by_modes()) {
    scene.structure.validate();
    const ModalStructure structure = read_modal_structure(scene.structure);
    return {summarise(structure, modes), lost_by_modes(structure, scene.structure)};
  }
  if (!scene.structure.files.nodes.empty()) {
    const FeStructure structure = read_on_supports(scene.structure);
    return {summarise(structure, scene.structure.damping, modes), {}};
  }
  if (!scene.spans.empty()) return {summarise(scene.spans, modes), {}};
  throw input_error("scene", "no bridge", "a [[bridge]], or a [structure] with a file of nodes");
}

/// What is written of the bridge by its modes.
ModalStructure modes_of(const SceneParameters& scene, int modes) {
  if (modes == 0) throw input_error("--modes", "0 with -o", "modes to write");
  if (scene.structure.files.by_modes()) {
    throw input_error("-o", "a scene whose structure is given by modes", "a [[bridge]], or a [structure] by matrices");
  }
  if (!scene.structure.files.nodes.empty()) return modes_at_deck(scene.structure, modes);
  return modes_at_deck(scene.spans, modes);
}

std::vector<std::string> warnings(const SceneParameters& scene, const StructureSummary& s) {
  const double length = s.high[0] - s.low[0];
  if (scene.structure.files.nodes.empty() || !std::isfinite(s.mass[2]) || !(length > 0.0)) return {};
  return plausibility_warnings(s.mass[2] / length, s.frequencies.empty() ? 0.0 : s.frequencies.front());
}

/// Modes of the summary that the files do not have, since their damping or that of a lower mode is above what files of
/// modes hold; empty where they have all.
std::string not_written(const StructureSummary& s, const ModalStructure& written) {
  const std::size_t asked = s.frequencies.size();
  const auto has = static_cast<std::size_t>(written.omega.size());
  if (has >= asked) return {};
  return fmt::format(
      "the files have the first {} of {} modes, {} are left out: the damping ratio of mode {}, at {:.4g} Hz, is "
      "{:.3g}, and structure.format = \"modes\" takes at most {}",
      has, asked, asked - has, has + 1, s.frequencies[has], s.damping_ratios[has], most_damping_ratio);
}

/// No "-0.000" for what turning axes leaves of zero [m].
double shown(double x) { return std::abs(x) < 5e-4 ? 0.0 : x; }

void print(const SceneParameters& scene, const Found& found) {
  const StructureSummary& s = found.summary;
  print_formatted("{}: {} degrees of freedom, {} nodes\n", scene.name, s.dofs, s.nodes);
  print_formatted("  from x = {:.3f}, y = {:.3f}, z = {:.3f} m to {:.3f}, {:.3f}, {:.3f} m below the rail-head tops\n",
                  shown(s.low[0]), shown(s.low[1]), shown(s.low[2]), shown(s.high[0]), shown(s.high[1]),
                  shown(s.high[2]));
  if (std::isfinite(s.mass[2])) {
    print_formatted("  moving mass along x, y, z: {:.6g}, {:.6g}, {:.6g} t\n", 1e-3 * s.mass[0], 1e-3 * s.mass[1],
                    1e-3 * s.mass[2]);
  } else {
    print_formatted("  moving mass: not known of a structure by modes\n");
  }
  if (!s.free.empty()) {
    print_formatted("  without resistance it {}: supports are missing\n", fmt::join(s.free, "; "));
  }
  for (std::size_t k = 0; k < s.frequencies.size(); ++k) {
    print_formatted("  {:3}. {:10.4f} Hz, damping {:.3f} %\n", k + 1, s.frequencies[k], 100.0 * s.damping_ratios[k]);
  }
  for (const std::string& part : found.left_out) print_formatted("  left out: {}\n", part);
}

void print_as_json(const SceneParameters& scene, const Found& found) {
  const StructureSummary& s = found.summary;
  print_json_line({{"scene", scene.name},
                   {"dofs", s.dofs},
                   {"nodes", s.nodes},
                   {"mass_x", s.mass[0]},
                   {"mass_y", s.mass[1]},
                   {"mass_z", s.mass[2]},
                   {"free", s.free},
                   {"frequencies", s.frequencies},
                   {"damping_ratios", s.damping_ratios},
                   {"left_out", found.left_out}});
}

}  // namespace

int structure_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "a scene with a bridge")  //
      ("modes", text_value("10")->value_name("N"),
       "natural frequencies of the bridge without its track, 0 for none")  //
      ("output,o", text_value()->value_name("PREFIX"),
       "write the modes for structure.format = \"modes\": PREFIX.modes.csv, .shapes.csv, .nodes.csv, "
       ".flexibility.csv");
  const CommandLine line("vsi structure SCENE.toml [--modes N] [-o PREFIX]", own, {"scene"}, arguments);
  if (line.help_printed()) return 0;
  constexpr int most_modes = 500;
  const int modes = static_cast<int>(line.whole_number("modes", 0, most_modes));
  const std::filesystem::path file = line.required("scene");
  if (line.given("output")) require_writable_place(line.text("output") + ".modes.csv", "-o");
  const SceneParameters scene = read_scene(file, {}, SceneFiles::of_train_and_structure);
  const Found found = [&] {
    try {
      return summary_of(scene, modes);
    } catch (const InputError& wrong) {
      throw with_scene_line(wrong, scene, file);
    }
  }();
  std::string section;
  if (line.given("output")) {
    const ModalStructure written = modes_of(scene, modes);
    section = write_modes(written, line.text("output"));
    if (const std::string note = not_written(found.summary, written); !note.empty()) line.warn(note);
  }
  for (const std::string& warning : warnings(scene, found.summary)) line.warn(warning);
  if (line.json()) {
    print_as_json(scene, found);
  } else {
    print(scene, found);
    if (!section.empty()) print_formatted("Modes for a scene:\n{}", section);
  }
  return 0;
}

}  // namespace railtab::vsi
