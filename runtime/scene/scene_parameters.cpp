#include "railtab/runtime/scene/scene_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

/// `ok` is false for NaN in every use below.
void require(bool ok, std::string_view key, double found, std::string_view expected) {
  if (!ok) throw input_error(key, fmt::format("{}", found), expected);
}

/// Rails come from the imported structure, or the track is laid over its deck.
void check_structure(const SceneParameters& scene) {
  const ImportParameters& structure = scene.structure;
  const FeFiles& files = structure.files;
  if (scene.track_kind == TrackKind::imported && files.nodes.empty()) {
    const bool all_files =
        !files.mass.empty() && !files.damping.empty() && !files.stiffness.empty() && !files.dofs.empty();
    if (!all_files) {
      throw input_error("track.kind", "\"imported\" without all its files",
                        "structure.mass, structure.damping, structure.stiffness and structure.dofs");
    }
    return;
  }
  if (scene.track_kind == TrackKind::imported) {
    if (!structure.rail_left.given() || !structure.rail_right.given()) {
      throw input_error("track.kind", "\"imported\" without both rails",
                        "structure.rail_left and structure.rail_right, or track.kind = \"flexible\"");
    }
    structure.validate();
  }
  const bool described = structure.deck.given() || !files.mass.empty() || !files.nodes.empty();
  if (scene.track_kind == TrackKind::flexible && files.stiffness.empty() && described) {
    throw input_error("structure", "no structure.stiffness", "its matrices, or a [[bridge]] alone");
  }
  if (scene.track_kind != TrackKind::flexible || files.stiffness.empty()) return;
  if (!scene.spans.empty()) throw input_error("structure.stiffness", "a [[bridge]] too", "one of them under the track");
  if (!structure.deck.given()) {
    throw input_error("structure.stiffness", "no structure.deck",
                      "the deck's nodes, which the track is laid upon, or track.kind = \"imported\"");
  }
  structure.validate();
}

}  // namespace

std::string_view contact_mode_name(const ContactParameters& contact) noexcept {
  if (contact.normal == NormalContact::rigid) return "rigid";
  return contact.mode == ContactMode::table ? "table" : contact.mode == ContactMode::online ? "online" : "paper";
}

namespace {

void check_loads(const SceneParameters& scene) {
  int number = 0;
  for (const LoadParameters& load : scene.loads) {
    const std::string which = fmt::format("[[load]] {} of {}", ++number, scene.loads.size());
    const bool components =
        std::any_of(load.load.begin(), load.load.end(), [](const auto& f) { return f.has_value(); });
    if (load.file.empty() != components) {
      throw input_error(which, components ? "file and components" : "neither file nor component",
                        "load.file, or components Fx to Mz");
    }
    if (!load.file.empty() && load.gust_duration > 0.0) {
      throw input_error(which, "load.gust_duration beside load.file", "one of them");
    }
    if (load.file.empty() && load.gust_duration == 0.0 && load.start != 0.0) {
      throw input_error(which, fmt::format("load.start = {} s of a constant load", load.start),
                        "load.gust_duration or load.file with it, or no load.start");
    }
    if (load.coach > scene.train.count) {
      throw input_error(which, fmt::format("load.coach = {}", load.coach),
                        fmt::format("0 to {}, the coaches of the train", scene.train.count));
    }
  }
}

void check_ground_motion(const SceneParameters& scene) {
  int number = 0;
  for (const GroundMotionParameters& ground : scene.ground_motion) {
    const std::string place = fmt::format("[[ground_motion]] {} of {}", ++number, scene.ground_motion.size());
    if (ground.file.empty()) throw input_error(place, "no file", "ground_motion.file");
    const double before = number > 1 ? scene.ground_motion[static_cast<std::size_t>(number) - 2].x : -INFINITY;
    if (!(ground.x > before)) {
      throw input_error(place, fmt::format("a station at x = {} m after one at {} m", ground.x, before),
                        "stations in the order of ground_motion.x, each at a place of its own");
    }
    if (ground.wave_speed != 0.0 && scene.ground_motion.size() > 1) {
      throw input_error(place, "ground_motion.wave_speed with several records", "a single record that travels");
    }
    if (ground.x != 0.0 && scene.ground_motion.size() == 1) {
      throw input_error(place, fmt::format("ground_motion.x = {} m of a single record", ground.x),
                        "several [[ground_motion]], or no ground_motion.x: one record holds everywhere");
    }
    require(std::abs(ground.wave_speed) >= 10.0 || ground.wave_speed == 0.0, "ground_motion.wave_speed",
            ground.wave_speed, "0, or 10 m/s and more forward or backward");
  }
  const bool alike =
      scene.ground_motion.size() <= 1 && (scene.ground_motion.empty() || scene.ground_motion.front().wave_speed == 0.0);
  const ImportParameters& structure = scene.structure;
  if (!alike && scene.track_kind != TrackKind::rigid && !structure.files.nodes.empty() && structure.supports.empty()) {
    throw input_error(fmt::format("[[ground_motion]] 1 of {}", scene.ground_motion.size()),
                      "ground motion that differs along the track under an imported structure without [[support]]",
                      "one record for all, or matrices written without constraints, which have the supports' rows, and "
                      "a [[support]] for each");
  }
}

// Wheels that follow the rails have no lateral motion that could answer.
void check_vertical(const SceneParameters& scene) {
  if (scene.contact.normal != NormalContact::rigid) return;
  int number = 0;
  for (const LoadParameters& load : scene.loads) {
    ++number;
    const auto acts = [&](std::size_t component) { return load.load[component].value_or(0.0) != 0.0; };
    if (!acts(1) && !acts(3) && !acts(5)) continue;
    throw input_error(fmt::format("[[load]] {} of {}", number, scene.loads.size()),
                      "a load along y or about x or z with contact.normal = \"rigid\"",
                      "contact.normal = \"hertz\": a vertical scene has no lateral motion");
  }
  if (scene.span_deviation && scene.span_deviation->direction == SpanDeviationDirection::lateral) {
    throw input_error("span_deviation.direction", "\"lateral\" with contact.normal = \"rigid\"",
                      "contact.normal = \"hertz\": a vertical scene has no lateral motion");
  }
}

}  // namespace

void SceneParameters::validate() const {
  if (contact.normal == NormalContact::hertz && contact.mode == ContactMode::table && contact.table.empty()) {
    throw input_error("contact.mode", "\"table\" without contact.table",
                      "a geometry table (tablegen geometry makes one), or contact.mode = \"online\"");
  }
  if (!contact.creep_table.empty() && contact.creep_law != "table") {
    throw input_error("contact.creep_table", fmt::format("one with contact.creep_law = \"{}\"", contact.creep_law),
                      "contact.creep_law = \"table\", or no contact.creep_table");
  }
  if (track_kind != TrackKind::flexible && !spans.empty()) {
    throw input_error("track.kind",
                      fmt::format("\"{}\" and a [[bridge]]", track_kind == TrackKind::rigid ? "rigid" : "imported"),
                      "\"flexible\", or no bridge");
  }
  check_structure(*this);
  if (train.vehicle == imported_vehicle) vehicle.validate(train.count);
  if (train.count < 1) throw input_error("train.count", fmt::format("{}", train.count), ">= 1");
  require(train.speed >= 1e-3, "train.speed", train.speed, ">= 0.001 m/s");
  integration.validate();
  reduction.validate();
  if (spectrum) spectrum->validate();
  if (output.energy && contact.normal == NormalContact::rigid) {
    throw input_error("output.energy", "true with contact.normal = \"rigid\"",
                      "contact.normal = \"hertz\": wheels that follow the rails have no contact springs");
  }
  if (span_deviation) span_deviation->validate();
  check_loads(*this);
  check_ground_motion(*this);
  check_vertical(*this);
  if (track_kind == TrackKind::flexible) {
    track.validate();
    for (const BridgeParameters& span : spans) span.validate();
  }
}

}  // namespace railtab
