#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/vehicle/vehicle_data.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr const char* mark = "# A scene of railtab, written by vsi new.";

struct NewScene {
  std::string vehicle;
  int coaches = 1, spans = 1;
  double speed_kmh = 200.0, span = 0.0;  ///< span 0: no bridge [m]
};

/// @throws InputError
double number_in(const CommandLine& line, const std::string& option, double low, double high, const char* unit) {
  const double value = line.number(option);
  if (value >= low && value <= high) return value;
  throw input_error("--" + option, fmt::format("{}", value), fmt::format("{:g} to {:g} {}", low, high, unit));
}

/// A text as TOML writes it.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string bridge_text(const NewScene& scene) {
  if (scene.span == 0.0) return "";
  std::string text =
      fmt::format("\n[[bridge]]                  # simply supported beams from x = 0\nlength = {:.6g}\n", scene.span);
  if (scene.spans > 1) text += fmt::format("count = {}\n", scene.spans);
  return text +
         "damping_ratio = 0.01\n"
         "# The cross-section of a concrete box girder of 32 m, which is not that of another span: write your own.\n"
         "mass = 33.9e3               # with ballast, without rails and sleepers [kg/m]\n"
         "E = 34.5e9                  # [Pa]\n"
         "Iy = 10.947                 # vertical bending [m4]\n"
         "Iz = 86.216                 # lateral bending [m4]\n"
         "J = 22.65                   # torsion [m4]\n";
}

/// Vertical data of a vehicle say nothing of what a contact patch needs.
std::string contact_text(const VehicleModel& vehicle, MotionPlane motion) {
  if (motion == MotionPlane::vertical) {
    return "[contact]\nnormal = \"rigid\"            # wheels that follow the rails: the vehicle's data are vertical "
           "only\n";
  }
  constexpr double usual = 0.46;  // PairDimensions' default [m]
  return fmt::format(
      "[contact]\n"
      "mode = \"online\"             # needs no table; with one, a run takes a third less time:\n"
      "wheel = \"S1002\"             #   tablegen geometry --wheel S1002 --rail 60E1 --rail-inclination 1:40 \\\n"
      "rail = \"60E1\"               #       --roll=-0.005:0.005{1} -o table.h5\n"
      "rail_inclination = 0.025    #   then, in place of these lines: table = \"table.h5\"\n"
      "{0}"
      "friction = 0.3\n",
      vehicle.wheel_radius.front() == usual
          ? std::string()
          : fmt::format("dimensions.nominal_radius = {:.6g}\n", vehicle.wheel_radius.front()),
      vehicle.wheel_radius.front() == usual ? std::string()
                                            : fmt::format(" --wheel-radius {:.6g}", vehicle.wheel_radius.front()));
}

std::string scene_text(const NewScene& scene, double length, const std::string& contact) {
  // the rear wheelset starts on the track, the last one leaves the bridge
  constexpr double run_in = 20.0, straight_duration = 5.0;
  const double rising = SpectrumParameters{}.fade_length();
  const double train = length * scene.coaches;
  const double after = scene.span > 0.0 ? train + 2.0 * run_in : straight_duration * scene.speed_kmh / 3.6 + run_in;
  const std::string what =
      scene.span > 0.0 ? fmt::format("over {} of {:.6g} m",
                                     scene.spans == 1 ? "a bridge" : fmt::format("{} spans", scene.spans), scene.span)
                       : std::string("on straight track");
  return fmt::format(
             "{}\n# SI units unless a key says otherwise; every key: docs/guide/scene.md. vsi check draws it.\n"
             "name = {}\n\n"
             "[train]\n"
             "vehicle = {}   # vsi vehicle lists others\n"
             "count = {}\n"
             "speed_kmh = {:.6g}\n"
             "start = {:.6g}                 # of the first wheelset [m]; track fully uneven from the bridge, x = 0\n\n"
             "{}\n"
             "[track]\n"
             "length_before = {:.6g}        # the train's length and its pre-roll [m]\n"
             "length_after = {:.6g}         # so that the train can leave the bridge [m]\n",
             mark,
             quoted(fmt::format("{} x {} {} at {:.6g} km/h", scene.coaches, scene.vehicle, what, scene.speed_kmh)),
             quoted(scene.vehicle), scene.coaches, scene.speed_kmh, -rising - run_in / 2.0, contact,
             std::ceil(rising + train + 2.0 * run_in), std::ceil(after)) +
         bridge_text(scene) +
         fmt::format(
             "\n[irregularity]\nspectrum = \"german-low\"     # a random track; remove the section for an even one\n"
             "seed = 1\n\n[integration]\ntime_step = 1e-3            # [s]\n{}",
             scene.span > 0.0 ? "# duration: until the last wheelset has left the bridge, if not stated\n"
                              : fmt::format("duration = {:.4g}              # [s]\n", straight_duration));
}

}  // namespace

int new_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "the scene that is written")  //
      ("train", text_value("manchester-coach")->value_name("NAME|FILE.toml"),
       "vehicle of the library or of a file")                                            //
      ("coaches", text_value("1")->value_name("N"), "number of vehicles, 1 to 100")      //
      ("span", text_value()->value_name("METRES"), "length of a span; none: no bridge")  //
      ("spans", text_value("1")->value_name("N"), "number of equal spans")               //
      ("speed", text_value("200")->value_name("KM/H"), "running speed");
  const CommandLine line("vsi new SCENE.toml [--train NAME] [--coaches N] [--span METRES [--spans N]] [--speed KM/H]",
                         own, {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::string output = line.required("scene");
  NewScene scene;
  scene.vehicle = line.text("train");
  scene.coaches = static_cast<int>(line.whole_number("coaches", 1, 100));
  scene.spans = static_cast<int>(line.whole_number("spans", 1, 1000));
  scene.speed_kmh = number_in(line, "speed", 1.0, 720.0, "km/h");
  if (line.given("span")) scene.span = number_in(line, "span", 0.5, 1000.0, "m");
  if (!line.given("span") && scene.spans > 1) {
    throw input_error("--spans", fmt::format("{}", scene.spans), "--span METRES too, the length of each");
  }
  require_fitting_name(output, "vsi new", "a scene in TOML", {".toml"});
  require_writable_place(output, "vsi new");
  if (std::filesystem::exists(output)) {
    throw input_error(output, "a file", "a new name: scenes are not replaced");
  }
  const VehicleData data = in_file("--train", [&] { return find_vehicle(scene.vehicle); });
  const VehicleModel vehicle = build_vehicle(data, data.motion);
  if (scene.vehicle.ends_with(".toml")) {  // a scene's files are relative to it
    const std::filesystem::path folder =
        std::filesystem::weakly_canonical(std::filesystem::absolute(output)).parent_path();
    scene.vehicle = std::filesystem::canonical(scene.vehicle).lexically_relative(folder).string();
  }
  write_text_file(output, scene_text(scene, vehicle.length, contact_text(vehicle, data.motion)), mark);
  if (line.json()) {
    print_json_line({{"scene", output}});
  } else if (!line.quiet()) {
    print_formatted("Scene: {}. vsi check {} draws it, vsi run {} runs it\n", output, output, output);
  }
  return 0;
}

}  // namespace railtab::vsi
