#include "railtab/runtime/scene/idle_keys.hpp"

#include <algorithm>

namespace railtab::scene {
namespace {

struct Rule {
  std::vector<std::string_view> keys;  ///< whole, or the beginning of several where it ends with . or _
  bool used;
  std::string_view found, expected;
  std::vector<std::string_view> but{};  ///< keys, likewise, for which the rule does not hold
};

bool is_among(std::string_view path, const std::vector<std::string_view>& keys) {
  return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) {
    return key.ends_with('.') || key.ends_with('_') ? path.starts_with(key) : path == key;
  });
}

/// Keys that say another time what is said already.
std::vector<Rule> second_ways(const SceneDraft& draft) {
  const SceneParameters& scene = draft.parameters;
  return {
      {{"train.speed"}, !draft.speed_kmh, "train.speed_kmh too", "either train.speed or train.speed_kmh"},
      {{"train.speed", "train.speed_kmh"},
       scene.train.speed_file.empty(),
       "train.speed_file too",
       "either a constant speed or train.speed_file"},
      {{"contact.wheel", "contact.rail", "contact.rail_inclination", "contact.dimensions."},
       scene.contact.table.empty(),
       "contact.table too",
       "either contact.table, which has profiles and dimensions of its own, or keys that name them"},
      {{"irregularity.spectrum"},
       draft.irregularity.empty(),
       "irregularity.file too",
       "either irregularity.file or irregularity.spectrum"},
  };
}

/// Keys of vehicles, wheels, rails and deviations that the scene does not have.
std::vector<Rule> without_contact_or_deviation(const SceneDraft& draft) {
  const bool contact = draft.parameters.contact.normal == NormalContact::hertz;
  const bool random = !draft.spectrum_name.empty();
  constexpr std::string_view follow = "contact.normal = \"rigid\"";
  return {
      {{"vehicle."},
       draft.parameters.train.vehicle == imported_vehicle,
       "a published train.vehicle",
       "train.vehicle = \"imported\", or no [vehicle]"},
      {{"contact."}, contact, follow, "no other key of contact: such wheels follow the rails", {"contact.normal"}},
      {{"train.initial_"}, contact, follow, "contact.normal = \"hertz\": a vertical scene has no lateral motion"},
      {{"integration.contact_force"},
       contact,
       follow,
       "contact.normal = \"hertz\": wheels that follow the rails have no contact springs"},
      {{"integration.impact_step"},
       contact && !draft.parameters.integration.contact_force,
       contact ? "an integration.contact_force of every step" : follow,
       "integration.contact_force = \"automatic\""},
      {{"integration.impact_step"},
       draft.parameters.contact.mode != ContactMode::paper,
       "contact.mode = \"paper\"",
       "contact.mode = \"table\" or \"online\": no impact of points that jump is divided"},
      {{"irregularity.seed"}, random, "no irregularity.spectrum", "one, or no seed"},
      {{"irregularity.shortest_wave", "irregularity.longest_wave"},
       random,
       "no irregularity.spectrum",
       "one, or no wavelengths"},
      {{"span_deviation."},
       draft.deviation_shape != "none",
       "no span_deviation.shape",
       "one, \"bending\" or \"parallel-shift\"",
       {"span_deviation.shape"}},
  };
}

/// Keys of a track or of an imported structure that the scene does not have.
std::vector<Rule> without_structure(const SceneDraft& draft) {
  const SceneParameters& scene = draft.parameters;
  const bool rigid = scene.track_kind == TrackKind::rigid, own_rails = scene.track_kind == TrackKind::imported;
  const bool import = !scene.structure.files.stiffness.empty();
  const bool by_rows = own_rails && scene.structure.files.nodes.empty();
  const bool deck = scene.structure.deck.given(), report = !scene.structure.report.empty();
  const std::vector<std::string_view> reductions{"structure.reduction", "structure.window_"};
  constexpr std::string_view no_stiffness = "no structure.stiffness";
  return {
      {{"track."},
       !rigid,
       "track.kind = \"rigid\"",
       "track.kind = \"flexible\", or no other key of track",
       {"track.kind"}},
      {{"track."},
       !own_rails,
       "track.kind = \"imported\"",
       "track.kind = \"flexible\", or no other key of track",
       {"track.kind"}},
      {{"structure."}, !rigid, "track.kind = \"rigid\"", "track.kind = \"flexible\" or \"imported\"", reductions},
      {{"track.ballast_deck."},
       import || !scene.spans.empty(),
       "no bridge",
       "a [[bridge]] or a [structure] that carries ballast, or track.ballast_ground"},
      {{"structure.damping_"},
       import,
       no_stiffness,
       "an imported structure, or damping_ratio and damping_type in [[bridge]]"},
      {{"structure.mass_damping", "structure.stiffness_damping", "structure.format", "structure.damping",
        "structure.dofs", "structure.units", "structure.axes", "structure.origin", "structure.report"},
       import,
       no_stiffness,
       "an imported structure"},
      {{"structure.format", "structure.units", "structure.axes", "structure.origin", "structure.report",
        "structure.deck.", "structure.rail_left.", "structure.rail_right.", "structure.damping_",
        "structure.mass_damping", "structure.stiffness_damping"},
       !by_rows,
       "no structure.nodes",
       "structure.nodes, or no key that speaks of nodes or damping: structure.dofs and structure.damping say it all"},
      {{"structure.rail_left.", "structure.rail_right."},
       own_rails,
       "track.kind = \"flexible\"",
       "track.kind = \"imported\", or structure.deck alone"},
      {{"structure.report"}, deck || !own_rails, "no structure.deck", "the nodes to choose from, or no report"},
      {{"structure.deck."},
       report || !own_rails,
       "track.kind = \"imported\" and no structure.report",
       "positions to report, or track.kind = \"flexible\""},
      {{"support."},
       !rigid && import && !scene.structure.files.nodes.empty(),
       "no structure.nodes",
       "an imported structure with its nodes"},
  };
}

/// Keys of reductions that the scene does not have. "none", written out, is a reduction that was switched off: its keys
/// may stay.
std::vector<Rule> without_reduction(const SceneDraft& draft, const std::vector<Leaf>& leaves) {
  const SceneParameters& scene = draft.parameters;
  const Reduction kind = scene.reduction.kind;
  const bool off = kind == Reduction::none && std::any_of(leaves.begin(), leaves.end(), [](const Leaf& leaf) {
                     return leaf.path == "structure.reduction";
                   });
  return {
      {{"structure.reduction"},
       off || scene.track_kind != TrackKind::rigid,
       "track.kind = \"rigid\"",
       "a structure to reduce, or \"none\""},
      {{"structure.window_"}, off || kind == Reduction::window, "a structure.reduction without window", "\"window\""},
  };
}

/// The bound of a type of bridge, or a ratio.
void refuse_two_dampings(const std::filesystem::path& file, const std::vector<Leaf>& leaves) {
  for (const Leaf& type : leaves) {
    if (type.path != "bridge.damping_type") continue;
    for (const Leaf& leaf : leaves) {
      if (leaf.path != "bridge.damping_ratio" || leaf.entry != type.entry) continue;
      throw leaf_error(file, leaf, "bridge.damping_type too", "either damping_ratio or damping_type of a bridge");
    }
  }
}

}  // namespace

void refuse_idle_keys(const SceneDraft& draft, const std::filesystem::path& file, const std::vector<Leaf>& leaves) {
  for (const std::vector<Rule>& rules : {second_ways(draft), without_contact_or_deviation(draft),
                                         without_structure(draft), without_reduction(draft, leaves)}) {
    for (const Rule& rule : rules) {
      if (rule.used) continue;
      for (const Leaf& leaf : leaves) {
        if (is_among(leaf.path, rule.keys) && !is_among(leaf.path, rule.but)) {
          throw leaf_error(file, leaf, rule.found, rule.expected);
        }
      }
    }
  }
  refuse_two_dampings(file, leaves);
}

}  // namespace railtab::scene
