#include "railtab/runtime/scene/key_conditions.hpp"

#include <fmt/format.h>

#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab::scene {
namespace {

using At = const KeySurroundings&;

std::string unless(bool holds, std::string_view contradiction) { return holds ? "" : std::string(contradiction); }

std::string track_kind(const SceneParameters& scene) {
  return fmt::format("track.kind = \"{}\"", scene.track_kind == TrackKind::rigid      ? "rigid"
                                            : scene.track_kind == TrackKind::imported ? "imported"
                                                                                      : "flexible");
}

/// A reduction that has these keys, or one that was switched off.
std::string reduction_among(At at, std::initializer_list<Reduction> kinds) {
  const Reduction kind = at.scene.reduction.kind;
  if (kind == Reduction::none && at.names("structure.reduction")) return {};
  for (const Reduction other : kinds) {
    if (kind == other) return {};
  }
  return fmt::format("structure.reduction = \"{}\"", reduction_name(kind));
}

bool imported(At at) { return at.scene.structure.files.given(); }
bool rails_by_rows(At at) {
  return at.scene.track_kind == TrackKind::imported && at.scene.structure.files.nodes.empty();
}

}  // namespace

const Condition without_speed_kmh{"no train.speed_kmh",
                                  [](At at) { return unless(!at.names("train.speed_kmh"), "train.speed_kmh too"); }};
const Condition without_speed_file{
    "no train.speed_file", [](At at) { return unless(at.scene.train.speed_file.empty(), "train.speed_file too"); }};
const Condition without_contact_table{
    "no contact.table", [](At at) { return unless(at.scene.contact.table.empty(), "contact.table too"); }};
const Condition with_contact_table{"contact.table",
                                   [](At at) { return unless(!at.scene.contact.table.empty(), "no contact.table"); }};
const Condition without_irregularity_file{
    "no irregularity.file", [](At at) { return unless(!at.scene.irregularity, "irregularity.file too"); }};
const Condition without_friction_file{
    "no contact.friction_file",
    [](At at) { return unless(at.scene.contact.friction_file.empty(), "contact.friction_file too"); }};
const Condition with_speed_file{
    "train.speed_file", [](At at) { return unless(!at.scene.train.speed_file.empty(), "no train.speed_file"); }};
const Condition with_polach_law{"contact.creep_law = \"polach\"", [](At at) {
                                  return unless(at.scene.contact.creep_law == "polach",
                                                fmt::format("contact.creep_law = \"{}\"", at.scene.contact.creep_law));
                                }};
const Condition with_built_in_rail{"a built-in contact.rail", [](At at) {
                                     const std::string& rail = at.scene.contact.rail;
                                     return unless(is_standard_profile(ProfileKind::rail, rail),
                                                   fmt::format("the file contact.rail = \"{}\"", rail));
                                   }};
const Condition without_damping_type{"no bridge.damping_type", [](At at) {
                                       return unless(!at.names("bridge.damping_type"), "bridge.damping_type too");
                                     }};

const Condition without_duration{"no integration.duration", [](At at) {
                                   return unless(at.scene.integration.duration == 0.0, "integration.duration too");
                                 }};

const Condition without_consist{"no train.consist",
                                [](At at) { return unless(at.scene.train.consist.empty(), "train.consist too"); }};
const Condition without_imported_vehicle{
    "no imported vehicle",
    [](At at) { return unless(at.scene.train.vehicle != imported_vehicle, "train.vehicle = \"imported\""); }};
const Condition with_imported_vehicle{"train.vehicle = \"imported\"", [](At at) {
                                        const std::string& vehicle = at.scene.train.vehicle;
                                        return unless(vehicle == imported_vehicle,
                                                      fmt::format("train.vehicle = \"{}\"", vehicle));
                                      }};
const Condition with_hertz_contact{
    "contact.normal = \"hertz\"",
    [](At at) { return unless(at.scene.contact.normal == NormalContact::hertz, "contact.normal = \"rigid\""); }};
const Condition with_creep_table_law{"contact.creep_law = \"table\"", [](At at) {
                                       const std::string& law = at.scene.contact.creep_law;
                                       return unless(law == "table", fmt::format("contact.creep_law = \"{}\"", law));
                                     }};
const Condition with_automatic_contact_force{
    "integration.contact_force = \"automatic\"", [](At at) {
      const std::optional<ContactForceRule>& rule = at.scene.integration.contact_force;
      if (!rule) return std::string();
      return fmt::format("integration.contact_force = \"{}\"",
                         rule == ContactForceRule::energy ? "energy" : "endpoint");
    }};
const Condition with_smooth_search{
    "contact.mode = \"table\" or \"online\"",
    [](At at) { return unless(at.scene.contact.mode != ContactMode::paper, "contact.mode = \"paper\""); }};
const Condition with_aerodynamics{"load.aerodynamics",
                                  [](At at) { return unless(at.names("load.aerodynamics"), "no load.aerodynamics"); }};
const Condition with_spectrum{"irregularity.spectrum",
                              [](At at) { return unless(at.scene.spectrum.has_value(), "no irregularity.spectrum"); }};
const Condition with_turning_spans{"span_deviation.shape = \"bending\" or \"parallel-shift\"", [](At at) {
                                     return unless(at.scene.span_deviation.has_value(), "no span_deviation.shape");
                                   }};

const Condition with_any_structure{"track.kind = \"flexible\" or \"imported\"", [](At at) {
                                     return unless(at.scene.track_kind != TrackKind::rigid, track_kind(at.scene));
                                   }};
const Condition with_flexible_track{"track.kind = \"flexible\"", [](At at) {
                                      return unless(at.scene.track_kind == TrackKind::flexible, track_kind(at.scene));
                                    }};
const Condition with_ballast_on_deck{"a [[bridge]] or an imported bridge", [](At at) {
                                       return unless(imported(at) || !at.scene.spans.empty(), "no bridge");
                                     }};
const Condition with_imported_structure{"structure.stiffness, or structure.format = \"modes\"",
                                        [](At at) { return unless(imported(at), "no structure.stiffness"); }};
const Condition with_imported_matrices{
    "structure.stiffness",
    [](At at) { return unless(!at.scene.structure.files.stiffness.empty(), "no structure.stiffness"); }};
const Condition with_matrices{"another structure.format than \"modes\"", [](At at) {
                                return unless(!at.scene.structure.files.by_modes(), "structure.format = \"modes\"");
                              }};
const Condition with_modes{"structure.format = \"modes\"", [](At at) {
                             return unless(at.scene.structure.files.by_modes(), "no structure.format = \"modes\"");
                           }};
const Condition with_structure_nodes{"structure.nodes",
                                     [](At at) { return unless(!rails_by_rows(at), "no structure.nodes"); }};
const Condition with_imported_rails{"track.kind = \"imported\"", [](At at) {
                                      return unless(at.scene.track_kind == TrackKind::imported, track_kind(at.scene));
                                    }};
const Condition with_deck_nodes{
    "a [[bridge]] or structure.deck", [](At at) {
      const bool bridge = !at.scene.spans.empty() || imported(at);
      return unless(at.scene.structure.deck.given() || (bridge && at.scene.track_kind != TrackKind::imported),
                    "no [[bridge]] and no structure.deck");
    }};
const Condition with_use_of_deck{"track.kind = \"flexible\", structure.report or output.deck_envelope", [](At at) {
                                   const bool recorded =
                                       !at.scene.structure.report.empty() || at.scene.output.deck_envelope;
                                   return unless(recorded || at.scene.track_kind != TrackKind::imported,
                                                 "track.kind = \"imported\" and no structure.report");
                                 }};
const Condition with_model_nodes{"structure.stiffness and structure.nodes", [](At at) {
                                   if (at.scene.structure.files.by_modes())
                                     return std::string("structure.format = \"modes\"");
                                   if (!imported(at) && !at.scene.structure.files.nodes.empty())
                                     return std::string("no structure.stiffness");
                                   return unless(!at.scene.structure.files.nodes.empty(), "no structure.nodes");
                                 }};

const Condition with_deck_envelope{"output.deck_envelope = true", [](At at) {
                                     return unless(at.scene.output.deck_envelope, "no output.deck_envelope = true");
                                   }};

const Condition with_sections{
    "structure.sections", [](At at) { return unless(!at.scene.structure.sections.empty(), "no structure.sections"); }};

const Condition with_structure_to_reduce{
    "track.kind = \"flexible\" or \"imported\"", [](At at) {
      return unless(at.scene.reduction.kind == Reduction::none || at.scene.track_kind != TrackKind::rigid,
                    track_kind(at.scene));
    }};
const Condition with_window{"structure.reduction = \"window\"",
                            [](At at) { return reduction_among(at, {Reduction::window}); }};

}  // namespace railtab::scene
