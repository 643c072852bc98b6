#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"

namespace railtab::scene {
namespace {

ImportParameters& import_of(SceneDraft& draft) { return draft.parameters.structure; }

std::vector<KeyBinding> file_keys() {
  return {
      {"structure.format", "", "whose files these are", FileFormatKey{}},
      {"structure.mass", "", "mass matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.mass; }}},
      {"structure.damping", "", "damping matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.damping; }}},
      {"structure.stiffness", "", "stiffness matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.stiffness; }}},
      {"structure.dofs", "", "what the rows of the matrices are",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.dofs; }}},
      {"structure.nodes", "", "positions of the nodes",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.nodes; }}},
      {"structure.units", "", "of the model, with the second",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.units; }, fe_unit_systems}},
      {"structure.axes", "", "the model's directions forward, right and down",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.axes; }, nullptr}},
      {"structure.origin", "", "the model's point at x = 0, in the track's centre, at the height of the rail-head tops",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return import_of(d).frame.origin; }}},
      {"structure.report", "m", "positions along the track at which the deck is reported (its middle where absent)",
       NumberListKey{[](SceneDraft& d) -> std::vector<double>& { return import_of(d).report; }}},
  };
}

template <NodeSelection ImportParameters::*selection>
std::vector<KeyBinding> selection_keys(const std::array<std::string_view, 4>& paths, std::string_view meaning) {
  return {
      {paths[0], "", meaning,
       TextKey{[](SceneDraft& d) -> std::string& { return (import_of(d).*selection).set; }, nullptr}},
      {paths[1], "", "or one corner of a box, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return (import_of(d).*selection).from; }}},
      {paths[2], "", "and the other",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return (import_of(d).*selection).to; }}},
      {paths[3], "", "by which the box is widened on all sides, in the model's unit",
       NumberKey{[](SceneDraft& d) -> double& { return (import_of(d).*selection).tolerance; }, not_negative}},
  };
}

std::vector<KeyBinding> damping_keys() {
  return {
      {"structure.mass_damping", "1/s", "Rayleigh damping, times the mass",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.mass_factor; },
                         {0.0, 1e4}}},
      {"structure.stiffness_damping", "s", "Rayleigh damping, times the stiffness",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.stiffness_factor; },
                         {0.0, 10.0}}},
      {"structure.damping_ratio", "1", "of critical, at two frequencies",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.ratio; },
                         {0.0, 0.5}}},
      {"structure.damping_type", "", "the damping_ratio that EN 1991-2, Table 6.6, has as lower bound for damping_span",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).damping.type; }, bridge_damping_types}},
      {"structure.damping_span", "m", "span for damping_type",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.span; }, {0.0, 1e4, true}}},
      {"structure.damping_frequency_low", "Hz", "at which the ratio holds; 0: the first natural frequency",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.frequencies[0]; }, {0.0, 1e4}}},
      {"structure.damping_frequency_high", "Hz", "at which the ratio holds; 0: the third natural frequency",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.frequencies[1]; }, {0.0, 1e4}}},
  };
}

std::vector<KeyBinding> held_node_keys() {
  return {
      {"support.set", "", "set of nodes that the ground holds and moves alike",
       TextKey{[](SceneDraft& d) -> std::string& { return d.support.nodes.set; }, nullptr}},
      {"support.from", "", "or one corner of a box, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return d.support.nodes.from; }}},
      {"support.to", "", "and the other",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return d.support.nodes.to; }}},
      {"support.tolerance", "", "by which the box is widened on all sides, in the model's unit",
       NumberKey{[](SceneDraft& d) -> double& { return d.support.nodes.tolerance; }, not_negative}},
      {"support.holds", "", "motions that are held, in railtab's axes: x, y, z, roll, pitch, yaw",
       TextListKey{[](SceneDraft& d) -> std::vector<std::string>& { return d.support.holds; }}},
      {"support.x", "m", "place along the track whose ground motion it has (the mean of its nodes where absent)",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return d.support.x; }, {-1e6, 1e6}}},
  };
}

}  // namespace

const std::vector<KeyBinding>& import_keys() {
  static const std::vector<KeyBinding> keys = [] {
    std::vector<KeyBinding> all = file_keys();
    for (const auto& part :
         {damping_keys(),
          selection_keys<&ImportParameters::deck>(
              {"structure.deck.set", "structure.deck.from", "structure.deck.to", "structure.deck.tolerance"},
              "set of the nodes that carry the track"),
          selection_keys<&ImportParameters::rail_left>({"structure.rail_left.set", "structure.rail_left.from",
                                                        "structure.rail_left.to", "structure.rail_left.tolerance"},
                                                       "set of the nodes of the left rail"),
          selection_keys<&ImportParameters::rail_right>({"structure.rail_right.set", "structure.rail_right.from",
                                                         "structure.rail_right.to", "structure.rail_right.tolerance"},
                                                        "set of the nodes of the right rail"),
          held_node_keys()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return keys;
}

}  // namespace railtab::scene
