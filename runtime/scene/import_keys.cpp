#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"

namespace railtab::scene {
namespace {

ImportParameters& import_of(SceneDraft& draft) { return draft.parameters.structure; }

// Points of the model in its own unit of length; offsets along the track in m.
constexpr Range model_position{-1e9, 1e9}, model_length{0.0, 1e6}, track_position{-1e6, 1e6};

ChoiceKey formats() {
  return choice<FeFormat>([](SceneDraft& d) -> FeFormat& { return import_of(d).files.format; },
                          {{"matrix-market", FeFormat::matrix_market},
                           {"calculix", FeFormat::calculix},
                           {"ansys", FeFormat::ansys},
                           {"abaqus", FeFormat::abaqus},
                           {"modes", FeFormat::modes}});
}

std::vector<KeyRow> matrix_keys() {
  return {
      {"structure.mass",
       "",
       "matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.mass; }},
       {},
       {&structure_unlike_a_bridge}},
      {"structure.stiffness", "", "matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.stiffness; }}},
  };
}

std::vector<KeyRow> node_keys() {
  return {
      {"structure.nodes", "", "positions of the nodes",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.nodes; }}},
  };
}

std::vector<KeyRow> mode_keys() {
  return {
      {"structure.mode_table", "", "frequency, modal mass, damping of each mode",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.modes; }}},
      {"structure.mode_shapes", "", "shapes of the modes at nodes",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.shapes; }}},
      {"structure.static_flexibility", "",
       "deflection of nodes under a unit vertical force; what the modes lack of it is reported",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.flexibility; }}},
  };
}

std::vector<KeyRow> row_keys() {
  return {
      {"structure.damping", "", "matrix",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.damping; }}},
      {"structure.dofs", "", "node and direction of each row; not needed for Abaqus's MATRIX INPUT",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return import_of(d).files.dofs; }}},
  };
}

std::vector<KeyRow> model_keys() {
  return {
      {"structure.format", "", "program that wrote the files", formats()},
      {"structure.units", "", "units of length, force, mass",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.units; }, fe_unit_systems}},
      {"structure.axes", "", "model's directions forward, right and down",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).frame.axes; }, nullptr}},
      {"structure.origin", "",
       "point of the model at x = 0, on the track centre, at the rail-head tops, in its axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return import_of(d).frame.origin; }, model_position}},
  };
}

std::vector<KeyRow> report_keys() {
  return {
      {"structure.report",
       "m",
       "reported positions on the deck; absent: the middle of each span",
       NumberListKey{[](SceneDraft& d) -> std::vector<double>& { return import_of(d).report; }, track_position},
       {&with_deck_nodes}},
  };
}

std::vector<KeyRow> section_keys() {
  return {
      {"structure.sections", "m", "positions of sections across the bridge: moment and shear force",
       NumberListKey{[](SceneDraft& d) -> std::vector<double>& { return import_of(d).sections; }, track_position}},
      {"structure.axis_depth",
       "m",
       "depth of their centroid below the rail-head tops: moments are taken there",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).axis_depth; },
                         {-100.0, 100.0}},
       {&with_sections}},
  };
}

template <NodeSelection ImportParameters::*selection>
std::vector<KeyRow> selection_keys(const std::array<std::string_view, 4>& paths, std::string_view meaning) {
  return {
      {paths[0], "", meaning,
       TextKey{[](SceneDraft& d) -> std::string& { return (import_of(d).*selection).set; }, nullptr}},
      {paths[1], "", "corners of a box, in place of a set, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return (import_of(d).*selection).from; }, model_position}},
      {paths[2], "", "corners of a box, in place of a set, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return (import_of(d).*selection).to; }, model_position}},
      {paths[3], "", "margin of the box, in the model's unit",
       NumberKey{[](SceneDraft& d) -> double& { return (import_of(d).*selection).tolerance; }, model_length}},
  };
}

std::vector<KeyRow> rayleigh_keys() {
  return {
      {"structure.mass_damping", "1/s", "Rayleigh damping, of the mass",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.mass_factor; },
                         {0.0, 1e4}}},
      {"structure.stiffness_damping", "s", "Rayleigh damping, of the stiffness",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.stiffness_factor; },
                         {0.0, 10.0}}},
  };
}

std::vector<KeyRow> ratio_keys() {
  return {
      {"structure.damping_ratio", "1", "damping ratio at two frequencies, or of all modes",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return import_of(d).damping.ratio; },
                         {0.0, 0.5}}},
      {"structure.damping_type", "", "lower bound of the damping ratio, EN 1991-2, Table 6.6",
       TextKey{[](SceneDraft& d) -> std::string& { return import_of(d).damping.type; }, bridge_damping_types}},
      {"structure.damping_span", "m", "span of the bridge, for damping_type",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.span; }, {0.5, 1e4}}},
  };
}

std::vector<KeyRow> damping_frequency_keys() {
  return {
      {"structure.damping_frequency_low", "Hz", "where the ratio holds; 0: first, third natural frequency",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.frequencies[0]; }, {1e-3, 1e4, true}}},
      {"structure.damping_frequency_high", "Hz", "where the ratio holds; 0: first, third natural frequency",
       NumberKey{[](SceneDraft& d) -> double& { return import_of(d).damping.frequencies[1]; }, {1e-3, 1e4, true}}},
  };
}

std::vector<KeyRow> support_keys() {
  return {
      {"support.set", "", "set of nodes",
       TextKey{[](SceneDraft& d) -> std::string& { return d.support.nodes.set; }, nullptr}},
      {"support.from", "", "corners of a box, in place of a set, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return d.support.nodes.from; }, model_position}},
      {"support.to", "", "corners of a box, in place of a set, in the model's axes and unit",
       PointKey{[](SceneDraft& d) -> std::optional<Point>& { return d.support.nodes.to; }, model_position}},
      {"support.tolerance", "", "margin of the box, in the model's unit",
       NumberKey{[](SceneDraft& d) -> double& { return d.support.nodes.tolerance; }, model_length}},
      {"support.holds", "", "fixed directions, in railtab's axes: x, y, z, roll, pitch, yaw",
       TextListKey{[](SceneDraft& d) -> std::vector<std::string>& { return d.support.holds; }}},
      {"support.x", "m", "position of the ground below it; absent: the mean of its nodes",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return d.support.x; }, track_position}},
  };
}

}  // namespace

std::vector<KeyRow> import_keys() {
  const auto deck = selection_keys<&ImportParameters::deck>(
      {"structure.deck.set", "structure.deck.from", "structure.deck.to", "structure.deck.tolerance"}, "set of nodes");
  const auto left =
      selection_keys<&ImportParameters::rail_left>({"structure.rail_left.set", "structure.rail_left.from",
                                                    "structure.rail_left.to", "structure.rail_left.tolerance"},
                                                   "set of nodes");
  const auto right =
      selection_keys<&ImportParameters::rail_right>({"structure.rail_right.set", "structure.rail_right.from",
                                                     "structure.rail_right.to", "structure.rail_right.tolerance"},
                                                    "set of nodes");
  const auto damping = [] {
    return all_of({applying(with_imported_matrices, rayleigh_keys()), applying(with_imported_structure, ratio_keys()),
                   applying(with_imported_matrices, damping_frequency_keys())});
  };
  return applying(
      with_any_structure,
      all_of({applying(with_matrices, matrix_keys()), applying(with_modes, mode_keys()), node_keys(),
              applying(with_imported_matrices, row_keys()),
              applying(with_imported_structure, applying(with_structure_nodes, model_keys())), report_keys(),
              applying(with_imported_matrices,
                       applying(with_structure_nodes, applying(with_deck_envelope, section_keys()))),
              applying(with_structure_nodes, damping()),
              applying(with_structure_nodes, applying(with_use_of_deck, deck)),
              applying(with_structure_nodes, applying(with_imported_rails, all_of({left, right})))}));
}

std::vector<KeyRow> held_node_keys() {
  return applying(with_any_structure, applying(with_model_nodes, support_keys()));
}

}  // namespace railtab::scene
