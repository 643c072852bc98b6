#include "railtab/runtime/scene/scene_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_loads.hpp"
#include "railtab/runtime/structure/structure_import.hpp"

namespace railtab {

bool track_on_import(const SceneParameters& scene) noexcept {
  return scene.track_kind == TrackKind::flexible && scene.structure.files.given();
}

bool has_deck_nodes(const SceneParameters& scene) noexcept {
  const bool bridge = !scene.spans.empty() || scene.structure.files.given();
  if (scene.track_kind != TrackKind::imported) return scene.track_kind == TrackKind::flexible && bridge;
  return bridge && !scene.structure.files.nodes.empty() && scene.structure.deck.given();
}

namespace {

/// A lower bound of the natural frequencies of a rail whose nodes, at the sleepers, are held, in bending or torsion
/// [Hz]. Torsion's square is at least the sum of the squares for twist alone and for warping alone.
double lowest_frequency_of_bay(const TrackParameters& track) {
  constexpr double pi = std::numbers::pi, clamped = 22.373;  // (βL)² of a beam with clamped ends
  const RailBeamParameters& rail = track.rail;
  const double L = track.sleeper_spacing;
  const double bending = clamped / (2.0 * pi * L * L) * std::sqrt(rail.E * std::min(rail.Iy, rail.Iz) / rail.mass);
  const double wave_speed = std::sqrt(rail.GJ / rail.rotary_inertia);
  const double warping = clamped / (2.0 * pi * L * L) * rail.warping_length * wave_speed;
  return std::min(bending, std::hypot(wave_speed / (2.0 * L), warping));
}

DeckRecord deck_record(const SceneParameters& scene) noexcept {
  return scene.output.deck_envelope ? DeckRecord::everywhere : DeckRecord::named_nodes;
}

StructureModel build_structure(const SceneParameters& scene) {
  const FeFiles& files = scene.structure.files;
  for (const auto& [file, key] : {std::pair{&files.mass, "mass"}, {&files.damping, "damping"}}) {
    std::error_code none;
    if (file->empty() || !std::filesystem::equivalent(*file, files.stiffness, none)) continue;
    throw input_error(std::string("scene: structure.") + key, "the file of structure.stiffness", "a file of its own");
  }
  const DeckRecord record = deck_record(scene);
  if (scene.track_kind == TrackKind::imported) {
    if (!files.nodes.empty()) return import_with_rails(scene.structure, record);
    return import_structure({files.mass, files.damping, files.stiffness, files.dofs});
  }
  if (track_on_import(scene)) return build_track_on_import(scene.track, scene.structure, record);
  return build_track_bridge(scene.track, scene.spans, structure_plane(scene), scene.structure.report, record);
}

}  // namespace

StructureModel scene_structure(const SceneParameters& scene) {
  const bool built = scene.track_kind == TrackKind::flexible && scene.contact.normal == NormalContact::hertz;
  if (!built || scene.track.elements_per_bay != 0) return build_structure(scene);
  SceneParameters one = scene;
  one.track.elements_per_bay = 1;
  StructureModel structure = build_structure(one);
  structure.left_out.push_back(fmt::format(
      "rail nodes between sleepers: between them a rail deflects under a wheel as at rest; at the frequency f the "
      "inertia that is left out changes this deflection by a share of (f / {:.3g} Hz)²",
      lowest_frequency_of_bay(scene.track)));
  return structure;
}

StructureKey::StructureKey(const SceneParameters& scene)
    : track_kind(scene.track_kind),
      track(scene.track),
      spans(scene.spans),
      import(scene.structure),
      plane(structure_plane(scene)),
      deck(deck_record(scene)),
      normal(scene.contact.normal) {
  const FeFiles& f = import.files;
  for (const std::filesystem::path* file :
       {&f.mass, &f.stiffness, &f.damping, &f.dofs, &f.nodes, &f.modes, &f.shapes, &f.flexibility}) {
    if (!file->empty()) file_checksums.push_back(file_checksum(*file));
  }
}

}  // namespace railtab
