#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "command/command_line.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "moving_load_output.hpp"
#include "railtab/runtime/assessment/dynamic_need.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "scene_decks.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

constexpr double slowest = 1.0, fastest = 200.0;  // [m/s]
constexpr const char* moving_load_usage =
    "vsi moving-load [SCENE.toml | --length M --mass KG/M --bending-stiffness N*M2 --damping RATIO] [--train NAME] "
    "--speed LO:HI[:STEP] [-o RESPONSE.csv]";

po::options_description moving_load_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "a scene with a bridge; its train is not used")  //
      ("length", text_value()->value_name("M"), "without a scene: span of a simply supported beam")                   //
      ("mass", text_value()->value_name("KG/M"), "its mass per length, with track")                                   //
      ("bending-stiffness", text_value()->value_name("N*M2"), "its bending stiffness EI")                             //
      ("damping", text_value()->value_name("RATIO"), "its damping ratio, 0.01 for 1 %")                               //
      ("train", po::value<std::vector<std::string>>()->composing()->value_name("NAME"),
       "a train, NAME*N wagons or AXLES.csv, may be given many times; default hslm-a, its ten trains")  //
      ("speed", text_value()->value_name("LO:HI[:STEP]"),
       "speeds in m/s; without STEP: search for the critical ones between LO and HI")  //
      ("speed-kmh", text_value()->value_name("LO:HI[:STEP]"), "speeds in km/h")        //
      ("sleeper-spacing", text_value()->value_name("M"), "spreads each axle load 25/50/25 % over three sleepers")(
          "modes", text_value("0")->value_name("N"),
          "modes that vibrate; 0: up to the greatest of 30 Hz, 1.5 f1 and f3")  //
      ("output,o", text_value()->value_name("RESPONSE.csv"), "a row per deck, train and speed");
  return own;
}

/// None where the command line has none.
std::optional<SpeedRange> speed_range(const CommandLine& line) {
  const bool si = line.given("speed"), kmh = line.given("speed-kmh");
  if (si && kmh) throw input_error("--speed-kmh", "--speed too", "one of them");
  if (!si && !kmh) return std::nullopt;
  const std::string option = si ? "speed" : "speed-kmh", text = line.text(option);
  const double unit = si ? 1.0 : 1.0 / 3.6;
  SpeedRange range;
  if (std::count(text.begin(), text.end(), ':') == 1) {
    const NumberRange ends = line.range(option);
    range.low = unit * ends.low;
    range.high = unit * ends.high;
  } else {
    range.speeds = values_of_range("--" + option, text, "LO:HI, LO:HI:STEP or one number");
    for (double& speed : range.speeds) speed *= unit;
    range.low = range.speeds.front();
    range.high = range.speeds.back();
  }
  if (!(range.low >= slowest && range.high <= fastest && range.low <= range.high) ||
      (range.speeds.empty() && !(range.low < range.high))) {
    throw input_error("--" + option, text,
                      fmt::format("speeds from {} to {} m/s, LO below HI (--speed-kmh takes km/h)", slowest, fastest));
  }
  return range;
}

/// A span from the command line.
ModalDeck deck_of_options(const CommandLine& line, const DynamicModes& modes) {
  for (const char* option : {"length", "mass", "bending-stiffness", "damping"}) {
    if (!line.given(option)) {
      throw input_error("vsi moving-load", fmt::format("no --{}", option),
                        "a scene, or --length, --mass, --bending-stiffness and --damping");
    }
  }
  BridgeParameters span;
  span.length = line.number("length");
  span.mass = line.number("mass");
  span.E = line.number("bending-stiffness");
  span.Iy = 1.0;
  span.damping_ratio = line.number("damping");
  require_between("--length", span.length, 0.5, 1000.0, "m");
  require_between("--mass", span.mass, 100.0, 1e7, "kg/m");
  require_between("--bending-stiffness", span.E, 1.0, 1e16, "N m²");
  require_between("--damping", span.damping_ratio, 0.0, 0.5, "-");
  ModalDeck deck = simply_supported_deck(span, modes);
  deck.name = "span";
  return deck;
}

/// Of simply supported spans: their mass or stiffness may be in another unit.
void warn_of_frequencies(const CommandLine& line, const std::vector<ModalDeck>& spans, std::string_view keys) {
  for (const ModalDeck& span : spans) {
    const std::string unlike = frequency_unlike_a_bridge(span.length(), span.frequency(0));
    if (unlike.empty()) continue;
    return line.warn(fmt::format("{}: are {} meant so?", unlike, keys));
  }
}

std::vector<ModalDeck> decks_of(const CommandLine& line, const DynamicModes& modes) {
  if (!line.given("scene")) {
    const std::vector<ModalDeck> span{deck_of_options(line, modes)};
    warn_of_frequencies(line, span, "--mass (in kg/m) and --bending-stiffness (in N m²)");
    return span;
  }
  for (const char* option : {"length", "mass", "bending-stiffness", "damping"}) {
    if (line.given(option)) throw input_error(fmt::format("--{}", option), "a scene too", "one of them");
  }
  const std::filesystem::path file = line.required("scene");
  const SceneParameters scene = read_scene(file, {}, SceneFiles::of_train_and_structure);
  try {
    std::vector<ModalDeck> decks = decks_of_scene(scene, modes);
    if (!scene.spans.empty()) warn_of_frequencies(line, decks, "bridge.mass (per metre) and E Iy");
    for (const ModalDeck& deck : decks) {
      if (const std::string doubt = doubtful_cut_off(deck); modes.count == 0 && !doubt.empty()) line.warn(doubt);
    }
    return decks;
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, file);
  }
}

std::vector<AxleTrain> trains_on(const ModalDeck& deck, const CommandLine& line) {
  std::vector<std::string> names{"hslm-a"};
  if (line.given("train")) names = line.required_many("train");
  std::vector<AxleTrain> trains;
  for (const std::string& name : expanded_names(names)) {
    trains.push_back(find_axle_train(name, deck.length()));
    if (!line.given("sleeper-spacing")) continue;
    const double spacing = line.number("sleeper-spacing");
    require_between("--sleeper-spacing", spacing, 0.1, 2.0, "m");
    trains.back() = spread_over_sleepers(trains.back(), spacing);
  }
  return trains;
}

/// A passage has 16 samples in the shortest period: not for hours.
void check_effort(const DeckResponse& response, double slowest_speed) {
  constexpr double most_periods = 1e6;
  const double top = response.deck.frequency(response.deck.dynamic_modes - 1);
  for (const AxleTrain& train : response.trains) {
    const double periods = top * (train.reach() + response.deck.length()) / slowest_speed;
    if (train.only_static || periods <= most_periods) continue;
    throw input_error("--speed", fmt::format("{:.3g} periods of {:.4g} Hz while {} crosses", periods, top, train.name),
                      fmt::format("at most {:.0e}: a higher speed or fewer --modes", most_periods));
  }
}

/// All trains on all decks.
std::vector<DeckResponse> respond(std::vector<ModalDeck> decks, const std::optional<SpeedRange>& speeds,
                                  const CommandLine& line) {
  ProgressBar bar("trains", !line.quiet() && !line.json());
  std::vector<DeckResponse> responses;
  for (ModalDeck& deck : decks) {
    DeckResponse& response = responses.emplace_back();
    response.deck = std::move(deck);
    response.trains = trains_on(response.deck, line);
    const bool moving =
        std::any_of(response.trains.begin(), response.trains.end(), [](const auto& t) { return !t.only_static; });
    if (moving && !speeds) {
      throw input_error("--speed", "no speeds",
                        "--speed LO:HI[:STEP] (m/s) or --speed-kmh LO:HI[:STEP]; EN 1991-2 asks for 40 m/s to 1.2 "
                        "times the line's speed");
    }
    const double passed = static_cast<double>(responses.size() - 1), all = static_cast<double>(decks.size());
    if (speeds) check_effort(response, speeds->low);
    response.responses = train_responses(response.deck, response.trains, speeds.value_or(SpeedRange{}), line.workers(),
                                         [&](double share) { bar.show((passed + share) / all); });
  }
  bar.wipe();
  return responses;
}

}  // namespace

int moving_load_command(const Arguments& arguments) {
  const CommandLine line(moving_load_usage, moving_load_options(), {"scene"}, arguments);
  if (line.help_printed()) return 0;
  if (arguments.empty() || (arguments.size() == 1 && line.json())) {
    print_trains(line.json());
    return 0;
  }
  constexpr int most_modes = 100;
  const DynamicModes modes{static_cast<int>(line.whole_number("modes", 0, most_modes))};
  if (line.given("output")) {
    require_writable_place(line.text("output"), "-o");
    require_replaceable_text(line.text("output"), response_columns());
    if (line.given("scene")) require_no_input(line.text("output"), {line.text("scene")});
  }
  const std::optional<SpeedRange> speeds = speed_range(line);
  double seconds = 0.0;
  const std::vector<DeckResponse> responses = [&] {
    const Stopwatch watch(seconds);
    return respond(decks_of(line, modes), speeds, line);
  }();
  if (line.given("output")) write_text_file(line.text("output"), response_rows(responses), response_columns());
  if (line.json()) {
    print_responses_as_json(responses, seconds);
  } else if (!line.quiet()) {
    print_responses(responses, seconds);
  }
  return 0;
}

}  // namespace railtab::vsi
