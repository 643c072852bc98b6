#include "scene_decks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::vsi {
namespace {

bool alike(const BridgeParameters& a, const BridgeParameters& b) {
  return a.length == b.length && a.mass == b.mass && a.E * a.Iy == b.E * b.Iy && a.E * a.Iz == b.E * b.Iz &&
         a.damping_ratio == b.damping_ratio && a.track_offset == b.track_offset && a.G * a.J == b.G * b.J &&
         a.rotary_inertia == b.rotary_inertia;
}

}  // namespace

std::vector<ModalDeck> decks_of_scene(const SceneParameters& scene, const DynamicModes& modes) {
  if (!scene.structure.files.nodes.empty()) return {imported_deck(scene.structure, modes)};
  if (scene.spans.empty()) {
    throw input_error("scene", "no bridge", "a [[bridge]], or a [structure] with a file of nodes");
  }
  std::vector<ModalDeck> decks;
  std::vector<const BridgeParameters*> known;
  std::vector<int> count;
  double start = 0.0;
  for (std::size_t s = 0; s < scene.spans.size(); ++s) {
    const BridgeParameters& span = scene.spans[s];
    const auto same = std::find_if(known.begin(), known.end(), [&](const auto* other) { return alike(*other, span); });
    if (same == known.end()) {
      known.push_back(&span);
      decks.push_back(simply_supported_deck(span, modes));
      decks.back().name = fmt::format("span {}", s + 1);
      count.push_back(1);
      decks.back().start = start;
    } else {
      ++count[static_cast<std::size_t>(same - known.begin())];
    }
    start += span.length;
  }
  for (std::size_t d = 0; d < decks.size(); ++d) {
    if (count[d] > 1) decks[d].name += fmt::format(" and {} more like it", count[d] - 1);
  }
  return decks;
}

}  // namespace railtab::vsi
