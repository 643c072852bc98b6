#include <fmt/format.h>

#include <filesystem>

#include "assess_trains.hpp"
#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/results/output_selection.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_warnings.hpp"
#include "scene_layout.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

struct Checked {
  SceneLayout layout;
  ModelParts parts;
  std::vector<std::string> warnings;
};

/// All that a run does before it factorises, and the trains that an assessment adds.
Checked check(const SceneParameters& scene, const std::filesystem::path& file) {
  const VsiModel model = build_model(scene);
  static_cast<void>(OutputSelection(scene.output, model_header(model)));
  if (const std::vector<std::string>& trains = scene.assessment.trains; !trains.empty()) {
    static_cast<void>(assess_trains(scene, trains, file.parent_path()));
  }
  return {scene_layout(scene, model), model_parts(scene, model), scene_warnings(scene, model)};
}

void print(const SceneParameters& scene, const std::filesystem::path& file, const Checked& checked) {
  print_formatted("{}\n{}", scene.name, layout_text(checked.layout));
  for (const std::string& part : checked.parts.built) print_formatted("  built:    {}\n", part);
  for (const std::string& part : checked.parts.left_out) print_formatted("  left out: {}\n", part);
  for (const std::string& node : checked.layout.nodes) print_formatted("  recorded: {}\n", node);
  for (const std::filesystem::path& read : scene.files) print_formatted("  read:     {}\n", read.string());
  print_formatted("The scene is valid. vsi run {} runs it\n", file.string());
}

void print_as_json(const SceneParameters& scene, const Checked& checked) {
  const SceneLayout& layout = checked.layout;
  std::vector<std::string> files;
  for (const std::filesystem::path& read : scene.files) files.push_back(read.string());
  print_json_line({{"scene", scene.name},
                   {"valid", true},
                   {"track", {layout.track_from, layout.track_to}},
                   {"spans", layout.spans},
                   {"wheelsets", layout.wheelsets},
                   {"travel", layout.travel},
                   {"duration", layout.duration},
                   {"nodes", layout.nodes},
                   {"files", files},
                   {"built", checked.parts.built},
                   {"left_out", checked.parts.left_out},
                   {"warnings", checked.warnings}});
}

}  // namespace

int check_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "what is checked")  //
      ("output,o", text_value()->value_name("LAYOUT.svg"), "the layout as a picture");
  const CommandLine line("vsi check SCENE.toml [-o LAYOUT.svg]", own, {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::filesystem::path file = line.required("scene");
  const SceneParameters scene = read_scene(file);
  try {
    const Checked checked = check(scene, file);
    if (line.given("output")) {
      const std::string output = line.text("output");
      const std::string picture = layout_svg(checked.layout, scene.name);
      require_writable_place(output, "-o");
      require_no_input(output, {file});
      for (const std::filesystem::path& read : scene.files) require_no_input(output, {read});
      require_fitting_name(output, "-o", "a picture in SVG", {".svg"});
      write_text_file(output, picture, "<svg ");
    }
    for (const std::string& warning : checked.warnings) line.warn(warning);
    if (line.json()) {
      print_as_json(scene, checked);
    } else if (!line.quiet()) {
      print(scene, file, checked);
    }
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, file);
  }
  return 0;
}

}  // namespace railtab::vsi
