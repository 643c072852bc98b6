#include "railtab/runtime/scene/scene_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/scene/judged_stretch.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"

namespace railtab::scene {
namespace {

using Scene = const SceneParameters&;
using Broken = std::optional<Violation>;

std::string entry(std::string_view section, std::size_t index, std::size_t count) {
  return fmt::format("[[{}]] {} of {}", section, index + 1, count);
}

bool vertical(Scene scene) { return scene.contact.normal == NormalContact::rigid; }

Broken table_of_contact_mode(Scene scene) {
  const ContactParameters& contact = scene.contact;
  if (vertical(scene) || contact.mode != ContactMode::table || !contact.table.empty()) return {};
  return Violation{"contact.mode", "\"table\" without contact.table",
                   "a geometry table (tablegen geometry generates one), or contact.mode = \"online\""};
}

Broken length_of_a_consist(Scene scene) {
  constexpr int most = 100;
  const int vehicles = scene.train.vehicles();
  if (vehicles <= most) return {};
  return Violation{"train.consist", fmt::format("{} vehicles", vehicles), fmt::format("at most {}", most)};
}

Broken bridge_under_flexible_track(Scene scene) {
  if (scene.track_kind == TrackKind::flexible || scene.spans.empty()) return {};
  return Violation{"track.kind",
                   fmt::format("\"{}\" and a [[bridge]]", scene.track_kind == TrackKind::rigid ? "rigid" : "imported"),
                   "\"flexible\", or no [[bridge]]"};
}

/// Rails of an imported structure: by the rows of its matrices, or by its nodes.
Broken files_of_imported_rails(Scene scene) {
  const FeFiles& files = scene.structure.files;
  if (scene.track_kind != TrackKind::imported || !files.nodes.empty()) return {};
  if (!files.mass.empty() && !files.damping.empty() && !files.stiffness.empty() && !files.dofs.empty()) return {};
  return Violation{"track.kind", "\"imported\" without all its files",
                   "structure.mass, structure.damping, structure.stiffness and structure.dofs"};
}

Broken nodes_of_imported_rails(Scene scene) {
  const ImportParameters& structure = scene.structure;
  if (scene.track_kind != TrackKind::imported || structure.files.nodes.empty()) return {};
  if (structure.rail_left.given() && structure.rail_right.given()) return {};
  return Violation{"track.kind", "\"imported\" without both rails",
                   "structure.rail_left and structure.rail_right, or track.kind = \"flexible\""};
}

/// The track on an imported bridge.
Broken matrices_of_imported_bridge(Scene scene) {
  const FeFiles& files = scene.structure.files;
  const bool described = scene.structure.deck.given() || !files.mass.empty() || !files.nodes.empty();
  if (scene.track_kind != TrackKind::flexible || files.given() || !described) return {};
  return Violation{"structure", "no structure.stiffness", "its matrices, or a [[bridge]] alone"};
}

bool track_on_imported_bridge(Scene scene) {
  return scene.track_kind == TrackKind::flexible && scene.structure.files.given();
}

/// The key that says that a bridge is imported.
std::string key_of_import(Scene scene) {
  return scene.structure.files.by_modes() ? "structure.format" : "structure.stiffness";
}

Broken track_on_modes(Scene scene) {
  if (!scene.structure.files.by_modes() || scene.track_kind != TrackKind::imported) return {};
  return Violation{"track.kind", "\"imported\" with structure.format = \"modes\"",
                   "\"flexible\": modes describe the deck, and railtab lays its own track on it"};
}

Broken ground_under_modes(Scene scene) {
  if (!scene.structure.files.by_modes() || scene.ground_motion.empty()) return {};
  return Violation{entry("ground_motion", 0, scene.ground_motion.size()),
                   "ground motion under a structure by modes, whose supports are not known",
                   "the structure's matrices in place of structure.format = \"modes\""};
}

Broken one_bridge_under_track(Scene scene) {
  if (!track_on_imported_bridge(scene) || scene.spans.empty()) return {};
  return Violation{key_of_import(scene), "a [[bridge]] too", "one of them under the track"};
}

Broken deck_of_imported_bridge(Scene scene) {
  if (!track_on_imported_bridge(scene) || scene.structure.deck.given()) return {};
  return Violation{key_of_import(scene), "no structure.deck",
                   "the deck's nodes, which carry the track, or track.kind = \"imported\""};
}

Broken energy_of_contact_springs(Scene scene) {
  if (!scene.output.energy || !vertical(scene)) return {};
  return Violation{"output.energy", "true with contact.normal = \"rigid\"",
                   "contact.normal = \"hertz\": wheels that follow the rails have no contact springs"};
}

Broken deck_of_envelope(Scene scene) {
  if (!scene.output.deck_envelope || has_deck_nodes(scene)) return {};
  return Violation{"output.deck_envelope", "true without a deck",
                   "a [[bridge]] under flexible track, or a [structure] with nodes and structure.deck"};
}

Broken steps_of_envelope(Scene scene) {
  if (!scene.output.deck_envelope) return {};
  const double step = scene.integration.time_step, cut_off = scene.output.deck_cut_off;
  if (samples_fast_enough(cut_off, step)) return {};
  return Violation{"output.deck_cut_off", fmt::format("{:g} Hz with integration.time_step = {:g} s", cut_off, step),
                   fmt::format("at most {:.4g} Hz, or shorter steps", 0.25 / step)};
}

/// The first load for which `found` says something.
template <class Found>
Broken of_loads(Scene scene, std::string_view expected, const Found& found) {
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const std::string what = found(scene.loads[i]);
    if (!what.empty()) return Violation{entry("load", i, scene.loads.size()), what, std::string(expected)};
  }
  return {};
}

Broken one_source_of_a_load(Scene scene) {
  constexpr const char* expected = "load.file, or components Fx to Mz; of wind load.file or load.wind_speed";
  return of_loads(scene, expected, [](const LoadParameters& load) -> std::string {
    const bool components =
        std::any_of(load.load.begin(), load.load.end(), [](const auto& f) { return f.has_value(); });
    const bool file = !load.file.empty(), wind = !load.aerodynamics.empty(), speed = load.wind_speed.has_value();
    if (wind && components) return "components beside load.aerodynamics";
    if (wind)
      return file != speed ? "" : file ? "load.file and load.wind_speed" : "neither load.file nor load.wind_speed";
    if (file != components) return {};
    return components ? "file and components" : "neither file nor component";
  });
}

Broken gust_without_file(Scene scene) {
  return of_loads(scene, "one of them", [](const LoadParameters& load) -> std::string {
    return load.file.empty() || load.gust_duration == 0.0 ? "" : "load.gust_duration beside load.file";
  });
}

Broken start_of_a_history(Scene scene) {
  return of_loads(scene, "load.gust_duration or load.file with it, or no load.start", [](const LoadParameters& load) {
    const bool constant = load.file.empty() && load.gust_duration == 0.0;
    return constant && load.start != 0.0 ? fmt::format("load.start = {} s of a constant load", load.start) : "";
  });
}

Broken coach_of_a_load(Scene scene) {
  const int per_vehicle = std::max<int>(1, static_cast<int>(scene.vehicle.car_bodies.size()));
  const int coaches = scene.train.vehicles() * per_vehicle;
  return of_loads(scene, fmt::format("0 to {}, the coaches of the train", coaches), [&](const LoadParameters& load) {
    return load.coach > coaches ? fmt::format("load.coach = {}", load.coach) : "";
  });
}

Broken vertical_loads(Scene scene) {
  if (!vertical(scene)) return {};
  return of_loads(scene, "contact.normal = \"hertz\": a vertical scene has no lateral motion",
                  [](const LoadParameters& load) -> std::string {
                    const auto acts = [&](std::size_t component) { return load.load[component].value_or(0.0) != 0.0; };
                    if (!acts(1) && !acts(3) && !acts(5)) return {};
                    return "a load along y or about x or z with contact.normal = \"rigid\"";
                  });
}

Broken table_of_profiles(Scene scene) {
  for (std::size_t i = 0; i < scene.profiles.size(); ++i) {
    if (scene.contact.table.empty() || !scene.profiles[i].table.empty()) continue;
    return Violation{entry("profiles", i, scene.profiles.size()), "no profiles.table beside contact.table",
                     "the geometry table of these wheels (tablegen geometry)"};
  }
  return {};
}

/// The first [[wheel]] for which `found` says something.
template <class Found>
Broken of_wheels(Scene scene, std::string_view expected, const Found& found) {
  for (std::size_t i = 0; i < scene.wheels.size(); ++i) {
    const std::string what = found(scene.wheels[i]);
    if (!what.empty()) return Violation{entry("wheel", i, scene.wheels.size()), what, std::string(expected)};
  }
  return {};
}

Broken deviation_of_a_wheel(Scene scene) {
  return of_wheels(scene, "wheel.flat_length, wheel.polygon_amplitude, wheel.run_out or wheel.file",
                   [](const WheelParameters& wheel) -> std::string {
                     const bool round = wheel.flat.length == 0.0 && wheel.polygon.amplitude == 0.0 &&
                                        wheel.run_out.amplitude == 0.0 && wheel.file.empty();
                     return round ? "no deviation" : "";
                   });
}

Broken edges_of_a_flat(Scene scene) {
  if (!vertical(scene)) return {};
  return of_wheels(scene, "wheel.flat_edges = \"rounded\", or contact.normal = \"hertz\": no wheel can follow a kink",
                   [](const WheelParameters& wheel) -> std::string {
                     const bool sharp = wheel.flat.length > 0.0 && wheel.flat.edges == WheelFlat::Edges::sharp;
                     return sharp ? "a flat with sharp edges and contact.normal = \"rigid\"" : "";
                   });
}

Broken vertical_deviation_of_spans(Scene scene) {
  if (!vertical(scene) || !scene.span_deviation) return {};
  if (scene.span_deviation->direction == SpanDeviationDirection::vertical) return {};
  return Violation{"span_deviation.direction", "\"lateral\" with contact.normal = \"rigid\"",
                   "contact.normal = \"hertz\": a vertical scene has no lateral motion"};
}

/// The first record of ground motion for which `found` says something.
template <class Found>
Broken of_records(Scene scene, std::string_view expected, const Found& found) {
  for (std::size_t i = 0; i < scene.ground_motion.size(); ++i) {
    const std::string what = found(i);
    if (what.empty()) continue;
    return Violation{entry("ground_motion", i, scene.ground_motion.size()), what, std::string(expected)};
  }
  return {};
}

Broken file_of_a_record(Scene scene) {
  return of_records(scene, "ground_motion.file",
                    [&](std::size_t i) { return scene.ground_motion[i].file.empty() ? "no file" : std::string(); });
}

Broken order_of_stations(Scene scene) {
  return of_records(scene, "stations in the order of ground_motion.x, each at a position of its own",
                    [&](std::size_t i) -> std::string {
                      if (i == 0) return {};
                      const double x = scene.ground_motion[i].x, before = scene.ground_motion[i - 1].x;
                      return x > before ? "" : fmt::format("a station at x = {} m after one at {} m", x, before);
                    });
}

Broken wave_of_one_record(Scene scene) {
  return of_records(scene, "a single record that travels", [&](std::size_t i) -> std::string {
    const bool several = scene.ground_motion.size() > 1;
    return several && scene.ground_motion[i].wave_speed != 0.0 ? "ground_motion.wave_speed with several records" : "";
  });
}

Broken position_of_one_record(Scene scene) {
  return of_records(scene, "several [[ground_motion]], or no ground_motion.x: one record holds everywhere",
                    [&](std::size_t i) -> std::string {
                      const double x = scene.ground_motion[i].x;
                      const bool single = scene.ground_motion.size() == 1;
                      return single && x != 0.0 ? fmt::format("ground_motion.x = {} m of a single record", x) : "";
                    });
}

Broken supports_under_moving_ground(Scene scene) {
  const bool uniform =
      scene.ground_motion.size() <= 1 && (scene.ground_motion.empty() || scene.ground_motion.front().wave_speed == 0.0);
  const ImportParameters& structure = scene.structure;
  if (uniform || scene.track_kind == TrackKind::rigid || structure.files.nodes.empty() || !structure.supports.empty()) {
    return {};
  }
  return Violation{entry("ground_motion", 0, scene.ground_motion.size()),
                   "ground motion that differs along the track under an imported structure without [[support]]",
                   "one record for all, or matrices written without constraints, which have the supports' rows, and a "
                   "[[support]] for each"};
}

Broken way_that_is_judged(Scene scene) {
  const std::optional<double>& end = scene.assessment.end;
  const double begin = judging_begin(scene);
  if (!end || *end > begin) return {};
  return Violation{"assessment.end", fmt::format("{:g} m, and judging begins at {:g} m", *end, begin),
                   "more than assessment.begin; without it more than train.start + irregularity.fade_in"};
}

}  // namespace

const std::vector<SceneRule>& scene_rules() {
  static const std::vector<SceneRule> rules{
      {"contact.mode = \"table\" has a table", table_of_contact_mode},
      {"a train has a hundred vehicles at most", length_of_a_consist},
      {"a [[bridge]] carries flexible track", bridge_under_flexible_track},
      {"imported rails by rows have all files", files_of_imported_rails},
      {"imported rails by nodes are two", nodes_of_imported_rails},
      {"an imported bridge has matrices", matrices_of_imported_bridge},
      {"track lies on an imported bridge or on a [[bridge]]", one_bridge_under_track},
      {"an imported bridge has a deck", deck_of_imported_bridge},
      {"modes carry railtab's track", track_on_modes},
      {"modes have no supports", ground_under_modes},
      {"energy is that of contact springs", energy_of_contact_springs},
      {"an envelope has a deck", deck_of_envelope},
      {"an envelope's steps are short", steps_of_envelope},
      {"a load has a file or components", one_source_of_a_load},
      {"a gust has components", gust_without_file},
      {"a constant load has no start", start_of_a_history},
      {"a load acts on a coach of the train", coach_of_a_load},
      {"a vertical scene has vertical loads", vertical_loads},
      {"a vertical scene has vertical deviations", vertical_deviation_of_spans},
      {"[[profiles]] have a table where contact has one", table_of_profiles},
      {"a [[wheel]] is not round", deviation_of_a_wheel},
      {"wheels that follow the rails have no kinks", edges_of_a_flat},
      {"ground motion has a record", file_of_a_record},
      {"stations are in order", order_of_stations},
      {"a wave has one record", wave_of_one_record},
      {"one record has no position", position_of_one_record},
      {"judging ends after it begins", way_that_is_judged},
      {"supports follow ground that moves differently along the track", supports_under_moving_ground},
  };
  return rules;
}

}  // namespace railtab::scene
