#include "railtab/runtime/scene/scene_parameters.hpp"

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/key_ranges.hpp"
#include "railtab/runtime/scene/scene_rules.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"

namespace railtab {

std::string_view contact_mode_name(const ContactParameters& contact) noexcept {
  if (contact.normal == NormalContact::rigid) return "rigid";
  return contact.mode == ContactMode::table ? "table" : contact.mode == ContactMode::online ? "online" : "paper";
}

std::vector<ConsistEntry> TrainParameters::entries() const {
  return consist.empty() ? std::vector<ConsistEntry>{{vehicle, count, false}} : consist;
}

int TrainParameters::vehicles() const noexcept {
  if (consist.empty()) return count;
  int vehicles = 0;
  for (const ConsistEntry& entry : consist) vehicles += entry.count;
  return vehicles;
}

void SceneParameters::validate() const {
  scene::require_ranges(*this);
  for (const scene::SceneRule& rule : scene::scene_rules()) {
    if (const auto broken = rule.violation(*this)) throw input_error(broken->place, broken->found, broken->expected);
  }
  // what each part requires of itself
  const bool by_nodes = track_kind == TrackKind::imported && !structure.files.nodes.empty();
  if (by_nodes || track_on_import(*this)) structure.validate();
  if (train.vehicle == imported_vehicle) vehicle.validate(train.count);
  if (spectrum) spectrum->validate();
  if (span_deviation) span_deviation->validate();
  if (track_kind != TrackKind::flexible) return;
  track.validate();
  for (const BridgeParameters& span : spans) span.validate();
}

}  // namespace railtab
