#include <fmt/format.h>

#include <optional>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "hunting_case.hpp"
#include "limit_cycle_output.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

using Json = nlohmann::ordered_json;

constexpr double to_kmh = 3.6;
// What the outputs of limit cycles begin with.
constexpr const char *branch_mark = "speed_m_s,", *svg_mark = "<svg ";

struct Stability : HuntingCase {
  SpeedSearch search;
  LinearCriticalSpeed found;
  std::optional<HuntingBranch> branch;
};

void print(const Stability& s) {
  print_formatted("{}\n", name_of(s));
  if (s.found.critical) {
    const LeastStableMotion& c = *s.found.critical;
    const std::string motion =
        c.frequency > 0.0 ? fmt::format("a motion of {:.3f} Hz, {:.2f} m long", c.frequency, c.speed / c.frequency)
                          : std::string("a motion that grows without oscillation");
    print_formatted("  linear critical speed {:.2f} km/h: {}\n", to_kmh * c.speed, motion);
  } else {
    print_formatted("  no linear critical speed up to {:.6g} km/h\n", to_kmh * s.search.high);
  }
  print_formatted("  {:>8} {:>12} {:>10} {:>14}\n", "km/h", "growth 1/s", "Hz", "damping ratio");
  for (const LeastStableMotion& motion : s.found.searched) {
    print_formatted("  {:8.1f} {:12.4f} {:10.3f} {:14.5f}\n", to_kmh * motion.speed, motion.growth, motion.frequency,
                    motion.damping);
  }
  if (s.branch) print_formatted("{}", branch_text(*s.branch));
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
  Json result = {{"scene", scene.name},
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
  if (s.branch) result.update(branch_json(*s.branch));
  return result;
}

po::options_description critical_speed_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "a scene with contact.normal = \"hertz\"")(
      "amplitude", text_value()->value_name("M"),
      "lateral amplitude in m whose equivalent conicity counts; none: the contact at rest")(
      "to-kmh", text_value("540")->value_name("V"), "highest speed of the search in km/h")(
      "motion", text_value("1")->value_name("N"),
      "the speed from which on N motions grow: vehicles hunt in several ways")(
      "limit-cycles", "follow the limit cycles from that speed on, in steps no longer than integration.time_step")(
      "start-kmh", text_value()->value_name("V"),
      "with --limit-cycles: the branch through the cycle that a simulation at V settles on, to both sides")(
      "shift", text_value("0.005")->value_name("M"), "lateral shift in m with which that simulation begins")(
      "max-cycles", text_value("300")->value_name("N"), "limit cycles to compute at most")(
      "output,o", text_value()->value_name("BRANCH.csv"), "a row per limit cycle")(
      "diagram", text_value()->value_name("DIAGRAM.svg"), "amplitude over speed as a picture");
  return own;
}

// Where the outputs of limit cycles are wanted without these, or cannot be written.
void check_outputs(const CommandLine& line) {
  const bool cycles = line.given("limit-cycles");
  for (const char* option : {"output", "diagram", "start-kmh", "shift", "max-cycles"}) {
    if (line.chosen(option) && !cycles) {
      throw input_error(fmt::format("--{}", option), "no --limit-cycles", "--limit-cycles with it");
    }
  }
  if (cycles && line.given("amplitude")) {
    throw input_error("--amplitude", "--limit-cycles too", "one of them: limit cycles have their own amplitudes");
  }
  if (line.given("output")) {
    require_fitting_name(line.text("output"), "-o", "a table in CSV", {".csv"});
    require_writable_place(line.text("output"), "-o");
    require_replaceable_text(line.text("output"), branch_mark);
  }
  if (line.given("diagram")) {
    require_fitting_name(line.text("diagram"), "--diagram", "a picture in SVG", {".svg"});
    require_writable_place(line.text("diagram"), "--diagram");
    require_replaceable_text(line.text("diagram"), svg_mark);
  }
}

HuntingBranch followed_branch(const CommandLine& line, const SceneParameters& scene, const Stability& s) {
  HuntingSearch search;
  search.speed = s.search;
  search.time_step = scene.integration.time_step;
  search.alpha = scene.integration.alpha;
  search.max_cycles = static_cast<int>(line.whole_number("max-cycles", 1, 100000));
  if (line.given("start-kmh")) {
    search.start = SettledStart{.speed = line.number("start-kmh") / to_kmh, .shift = line.number("shift")};
    if (!(search.start->speed > s.search.low && search.start->speed < s.search.high)) {
      throw input_error(
          "--start-kmh", line.text("start-kmh"),
          fmt::format("{:.6g} to {:.6g} km/h, below --to-kmh", to_kmh * s.search.low, to_kmh * s.search.high));
    }
    if (!(search.start->shift > 0.0 && search.start->shift < 0.02)) {
      throw input_error("--shift", line.text("shift"), "above 0, below 0.02 m");
    }
  }
  ProgressBar bar("limit cycles", !line.quiet() && !line.json());
  int computed = 0;
  return hunting_branch(s.model, limit_cycle_model(scene), search, [&](const LimitCycle&) {
    bar.show(static_cast<double>(++computed) / search.max_cycles);
    return true;
  });
}

void write_outputs(const CommandLine& line, const Stability& s) {
  if (line.given("output")) write_text_file(line.text("output"), branch_csv(*s.branch), branch_mark);
  if (line.given("diagram")) write_text_file(line.text("diagram"), branch_svg(*s.branch, name_of(s)), svg_mark);
}

// A branch that breaks off has been written and printed as far as it is known.
void require_whole_branch(const HuntingBranch& branch) {
  if (branch.end != BranchEnd::no_convergence || branch.cycles.empty()) return;
  const LimitCycle& last = branch.cycles.back();
  throw ComputationError(
      fmt::format("the branch of limit cycles breaks off at {:.2f} km/h with an amplitude of {:.3f} mm, where Newton's "
                  "method does not converge: set a shorter integration.time_step, which resolves how the contact "
                  "points jump",
                  to_kmh * last.speed, 1e3 * last.amplitude()));
}

}  // namespace

int critical_speed_command(const Arguments& arguments) {
  const CommandLine line(
      "vsi critical-speed SCENE.toml [--amplitude M | --limit-cycles [-o BRANCH.csv] [--diagram DIAGRAM.svg]] "
      "[--to-kmh V]",
      critical_speed_options(), {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::filesystem::path file = line.required("scene");
  check_outputs(line);
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
  stability.search.motion = static_cast<int>(line.whole_number("motion", 1, 20));
  if (line.given("limit-cycles")) {
    try {
      stability.branch = followed_branch(line, scene, stability);
    } catch (const InputError& wrong) {
      throw with_scene_line(wrong, scene, file);
    }
    stability.found = stability.branch->linear;
    write_outputs(line, stability);
  } else {
    stability.found = linear_critical_speed(stability.model, stability.search, stability.conicity);
  }
  if (line.json()) {
    print_json_line(as_json(scene, stability));
  } else {
    print(stability);
  }
  if (stability.branch) require_whole_branch(*stability.branch);
  return 0;
}

}  // namespace railtab::vsi
