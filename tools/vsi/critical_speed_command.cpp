#include <fmt/format.h>

#include <optional>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

using Json = nlohmann::ordered_json;

constexpr double to_kmh = 3.6;

struct Stability {
  VsiModel model;
  std::optional<double> amplitude, conicity;
  SpeedSearch search;
  LinearCriticalSpeed found;
};

// The equivalent conicity at the amplitude that the command line names.
void set_conicity(const CommandLine& line, Stability& s) {
  if (!line.given("amplitude")) return;
  s.amplitude = line.number("amplitude");
  if (!(*s.amplitude > 0.0 && *s.amplitude < 0.01)) {
    throw input_error("--amplitude", fmt::format("{} m", *s.amplitude), "above 0, below 0.01 m");
  }
  s.conicity = equivalent_conicity(s.model.geometry->pair(), *s.amplitude);
  if (s.conicity) return;
  throw input_error("--amplitude", fmt::format("{} m, at which these profiles have no wave", *s.amplitude),
                    "a smaller amplitude, or none: the contact at rest");
}

std::string name_of(const Stability& s) {
  const WheelRailPair& pair = s.model.geometry->pair();
  const std::string about = s.conicity ? fmt::format("equivalent conicity {:.4f} at an amplitude of {:.3g} mm",
                                                     *s.conicity, 1e3 * *s.amplitude)
                                       : std::string("the contact at rest");
  return fmt::format("{}, {} on {}, friction {:.3g}, {}", s.model.vehicle.name, pair.wheel().knots().name,
                     pair.rail().knots().name, s.model.contact.friction, about);
}

void print(const Stability& s) {
  print_formatted("{}\n", name_of(s));
  if (s.found.critical) {
    const LeastStableMotion& c = *s.found.critical;
    print_formatted("  linear critical speed {:.2f} km/h: a motion of {:.3f} Hz, {:.2f} m long\n", to_kmh * c.speed,
                    c.frequency, c.frequency > 0.0 ? c.speed / c.frequency : 0.0);
  } else {
    print_formatted("  no linear critical speed up to {:.6g} km/h\n", to_kmh * s.search.high);
  }
  print_formatted("  {:>8} {:>12} {:>10} {:>14}\n", "km/h", "growth 1/s", "Hz", "damping ratio");
  for (const LeastStableMotion& motion : s.found.searched) {
    print_formatted("  {:8.1f} {:12.4f} {:10.3f} {:14.5f}\n", to_kmh * motion.speed, motion.growth, motion.frequency,
                    motion.damping);
  }
}

Json as_json(const LeastStableMotion& motion) {
  return {{"speed", motion.speed},
          {"growth", motion.growth},
          {"frequency", motion.frequency},
          {"damping_ratio", motion.damping}};
}

Json as_json(const SceneParameters& scene, const Stability& s) {
  Json searched = Json::array();
  for (const LeastStableMotion& motion : s.found.searched) searched.push_back(as_json(motion));
  const auto& critical = s.found.critical;
  const WheelRailPair& pair = s.model.geometry->pair();
  const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(); };
  return {{"scene", scene.name},
          {"vehicle", s.model.vehicle.name},
          {"wheel", pair.wheel().knots().name},
          {"rail", pair.rail().knots().name},
          {"friction", s.model.contact.friction},
          {"amplitude", number(s.amplitude)},
          {"equivalent_conicity", number(s.conicity)},
          {"linear_critical_speed", critical ? Json(critical->speed) : Json()},
          {"frequency", critical ? Json(critical->frequency) : Json()},
          {"top_speed", s.model.vehicle.top_speed > 0.0 ? Json(s.model.vehicle.top_speed) : Json()},
          {"searched_to", s.search.high},
          {"searched", searched}};
}

}  // namespace

int critical_speed_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "a scene with contact.normal = \"hertz\"")(
      "amplitude", text_value()->value_name("M"),
      "lateral amplitude in m whose equivalent conicity counts; none: the contact at rest")(
      "to-kmh", text_value("540")->value_name("V"), "highest speed of the search in km/h");
  const CommandLine line("vsi critical-speed SCENE.toml [--amplitude M] [--to-kmh V]", own, {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::filesystem::path file = line.required("scene");
  const SceneParameters scene = read_scene(file);
  Stability stability;
  try {
    stability.model = stability_model(scene);
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, file);
  }
  set_conicity(line, stability);
  stability.search.high = line.number("to-kmh") / to_kmh;
  if (!(stability.search.high > stability.search.low && stability.search.high <= 200.0)) {
    throw input_error("--to-kmh", line.text("to-kmh"),
                      fmt::format("above {:.6g}, at most 720 km/h", to_kmh * stability.search.low));
  }
  stability.found = linear_critical_speed(stability.model, stability.search, stability.conicity);
  if (line.json()) {
    print_json_line(as_json(scene, stability));
  } else {
    print(stability);
  }
  return 0;
}

}  // namespace railtab::vsi
