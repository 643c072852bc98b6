#include "railtab/runtime/structure/imported_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"
#include "railtab/runtime/structure/deck_attachment.hpp"
#include "railtab/runtime/structure/deck_interpolation.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"
#include "railtab/runtime/structure/fe_supports.hpp"
#include "railtab/runtime/structure/free_motion.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/structure/modal_bridge.hpp"
#include "railtab/runtime/structure/section_forces.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

void append(const Sparse& matrix, std::vector<Eigen::Triplet<double>>& entries) {
  entries.reserve(entries.size() + static_cast<std::size_t>(matrix.nonZeros()));
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry) {
      entries.emplace_back(static_cast<int>(entry.row()), j, entry.value());
    }
  }
}

void append_supports(const StructureSupports::Columns& matrix, std::vector<Eigen::Triplet<double>>& entries) {
  for (int i = 0; i < matrix.outerSize(); ++i) {
    for (StructureSupports::Columns::InnerIterator entry(matrix, i); entry; ++entry)
      entries.emplace_back(i, support_dof(static_cast<int>(entry.col())), entry.value());
  }
}

/// What the ground does to the structure where it moves.
StructureSupports settled_supports(const FeStructure& structure, const FeDampingMatrix& damping) {
  StructureSupports supports = structure.supports;
  supports.damping = damping.of_supports;
  const auto name = [&](Eigen::Index row) {
    const auto r = static_cast<std::size_t>(row);
    return fmt::format("node {} along {}", structure.node_of_row[r],
                       motion_names[static_cast<std::size_t>(structure.motion[r])]);
  };
  settle_supports({structure.mass, damping.of_unknowns, structure.stiffness}, translations(structure), name, supports);
  return supports;
}

StructureNode reported(std::string name, const FeNode& node) {
  StructureNode result{std::move(name), node.position[0], {}, node.position[1], node.position[2]};
  for (std::size_t k = 0; k < 6; ++k) result.dof[k] = node.rows[k].size() == 1 ? node.rows[k].front() : held;
  return result;
}

/// Vertical motion of every node of a deck, and the forces in sections.
std::vector<DeckRow> deck_channels(const FeStructure& structure, const std::vector<int>& deck) {
  std::vector<DeckRow> rows;
  for (const int number : deck) {
    const FeNode& node = structure.nodes.at(number);
    rows.push_back({{DeckQuantity::displacement, node.position[0], node.position[1]}, node_motion(node, z_dof)});
  }
  rows.insert(rows.end(), structure.sections.begin(), structure.sections.end());
  return rows;
}

/// Motions of nodes that have several rows for one.
void add_mean_motions(const FeStructure& structure, const std::vector<ReportedDeckNode>& reported_nodes,
                      Bridge& bridge) {
  for (std::size_t n = 0; n < reported_nodes.size(); ++n) {
    const FeNode& node = structure.nodes.at(reported_nodes[n].number);
    for (std::size_t k = 0; k < node.rows.size(); ++k) {
      if (node.rows[k].size() > 1) bridge.summed.push_back({n, k, node_motion(node, k)});
    }
  }
}

/// Rotations of a surface's nodes that have none of their own, from the displacements around them.
void fit_rotations(const FeStructure& structure, const std::vector<ReportedDeckNode>& reported_nodes, Bridge& bridge) {
  for (std::size_t n = 0; n < reported_nodes.size(); ++n) {
    const FeNode& node = structure.nodes.at(reported_nodes[n].number);
    if (!node.rows[roll_dof].empty() || !node.rows[pitch_dof].empty() || !node.rows[yaw_dof].empty()) continue;
    const SurfaceSlopes slopes = surface_slopes(bridge.surface, node.position[0], node.position[1]);
    if (slopes.roll) bridge.summed.push_back({n, roll_dof, *slopes.roll});
    if (slopes.pitch) bridge.summed.push_back({n, pitch_dof, *slopes.pitch});
  }
}

/// Sets StructureModel::dof_node; an element's inner mode is a node of its own. @return number of nodes
int number_nodes(const FeStructure& structure, std::vector<int>& nodes) {
  std::map<int, int> known;
  int count = 0;
  for (const int number : structure.node_of_row) {
    nodes.push_back(number == no_node ? count : known.try_emplace(number, count).first->second);
    count += nodes.back() == count ? 1 : 0;
  }
  return count;
}

Bridge bridge_of(FeStructure structure, const ImportParameters& parameters, DeckRecord record) {
  const std::vector<int> deck = selected_nodes(structure, parameters.deck, "structure.deck");
  Bridge bridge;
  append(structure.mass, bridge.matrices.mass);
  append(structure.stiffness, bridge.matrices.stiffness);
  FeDampingMatrix damping = damping_matrix(structure, parameters.damping);
  append(damping.of_unknowns, bridge.matrices.damping);
  bridge.warnings = plausibility_warnings(mass_per_length(structure), damping.first_frequency);
  StructureSupports supports = settled_supports(structure, damping);
  stand_on_ground(deck, structure, supports);
  bridge.attach = deck_function(structure, deck);
  append_supports(supports.mass, bridge.matrices.mass);
  append_supports(supports.stiffness, bridge.matrices.stiffness);
  append_supports(supports.damping, bridge.matrices.damping);
  bridge.support_x = supports.x;
  bridge.beyond_supports = supports.beyond;
  bridge.dof_x = row_positions(structure);
  bridge.node_count = number_nodes(structure, bridge.dof_node);
  const DeckExtent extent = plausible_deck_extent(structure, deck);
  bridge.end = extent.end;
  for (std::string& sentence : deck_place_warnings(extent)) bridge.warnings.push_back(std::move(sentence));
  const auto [low, high] = std::minmax_element(bridge.dof_x.begin(), bridge.dof_x.end());
  constexpr double rounding = 1e-6;  // [m]: the last nodes belong to the bridge
  bridge.spans.push_back({std::min(extent.begin, *low) - rounding, std::max(bridge.end, *high) + rounding});
  const std::vector<ReportedDeckNode> named = reported_deck_nodes(structure, deck, parameters.report);
  for (const ReportedDeckNode& node : named) {
    bridge.nodes.push_back(reported(node.name, structure.nodes.at(node.number)));
  }
  add_mean_motions(structure, named, bridge);
  if (is_surface(structure, deck)) {
    bridge.surface = surface_motion(structure, deck);
    fit_rotations(structure, named, bridge);
  }
  if (record == DeckRecord::everywhere) {
    bridge.deck = deck_channels(structure, deck);
    bridge.deck_ends = {{extent.begin, extent.end}};
  }
  return bridge;
}

RailLine rail_line(const FeStructure& structure, const NodeSelection& selection, const std::string& key) {
  std::vector<std::pair<int, const FeNode*>> nodes;
  for (int number : selected_nodes(structure, selection, key)) nodes.emplace_back(number, &structure.nodes.at(number));
  std::sort(nodes.begin(), nodes.end(),
            [](const auto& a, const auto& b) { return a.second->position[0] < b.second->position[0]; });
  if (nodes.size() < 2) throw input_error(key, fmt::format("{} node", nodes.size()), "at least 2 along the track");
  RailLine line;
  for (const auto& [number, node] : nodes) {
    const std::string place = fmt::format("{}: node {}", key, number);
    if (node->rows[2].size() != 1 || node->rows[4].size() != 1) {
      throw input_error(place, fmt::format("{} rows of z and {} of pitch", node->rows[2].size(), node->rows[4].size()),
                        "one each: rails are beams with rotations of their own (else give structure.deck and let "
                        "railtab lay the track)");
    }
    if (!line.x.empty() && !(node->position[0] > line.x.back())) {
      throw input_error(
          place, fmt::format("a second node of the rail at x = {:.6g} m", without_rounding(node->position[0])), "one");
    }
    line.x.push_back(node->position[0]);
    line.dof.push_back(reported("", *node).dof);
  }
  return line;
}

/// @param first_frequency set where the natural frequencies are sought [Hz]
RayleighDamping rayleigh(const FeStructure& structure, const FeDamping& damping, double& first_frequency) {
  if (damping.mass_factor || damping.stiffness_factor) {
    return {damping.mass_factor.value_or(0.0), damping.stiffness_factor.value_or(0.0)};
  }
  const double ratio = damping.type.empty() ? damping.ratio.value_or(0.0)
                                            : damping_lower_bound("structure.damping_type", damping.type, damping.span);
  if (ratio == 0.0) return {};
  std::array<double, 2> omega{2.0 * std::numbers::pi * damping.frequencies[0],
                              2.0 * std::numbers::pi * damping.frequencies[1]};
  if (damping.frequencies[0] == 0.0) {
    const Eigen::VectorXd squares = lowest_modes(structure.stiffness, structure.mass, 3).omega2;
    omega = {std::sqrt(squares[0]), std::sqrt(squares[squares.size() - 1])};
    first_frequency = omega[0] / (2.0 * std::numbers::pi);
  }
  return rayleigh_damping(ratio, omega[0], omega[1]);
}

}  // namespace

void ImportParameters::validate() const {
  if (files.by_modes()) {
    for (const auto& [file, key] : {std::pair{&files.modes, "structure.mode_table"},
                                    {&files.shapes, "structure.mode_shapes"},
                                    {&files.nodes, "structure.nodes"}}) {
      if (file->empty()) throw input_error(key, "no file", "a file of the modes of the finite-element model");
    }
    return;  // read_modal_structure() knows whether their table has damping
  }
  for (const auto& [file, key] : {std::pair{&files.mass, "structure.mass"},
                                  {&files.stiffness, "structure.stiffness"},
                                  {&files.dofs, "structure.dofs"},
                                  {&files.nodes, "structure.nodes"}}) {
    if (file == &files.dofs && files.format == FeFormat::abaqus) continue;
    if (file->empty()) throw input_error(key, "no file", "a file of the finite-element model");
  }
  const int ways = (files.damping.empty() ? 0 : 1) + (damping.mass_factor || damping.stiffness_factor ? 1 : 0) +
                   (damping.ratio ? 1 : 0) + (damping.type.empty() ? 0 : 1);
  if (ways != 1) {
    throw input_error("structure", fmt::format("damping in {} ways", ways),
                      "one: a file (damping), mass_damping and stiffness_damping, damping_ratio, or damping_type "
                      "with damping_span");
  }
  if ((damping.frequencies[0] > 0.0) != (damping.frequencies[1] > 0.0) ||
      (damping.frequencies[0] > 0.0 && !(damping.frequencies[1] > damping.frequencies[0]))) {
    throw input_error(
        "structure.damping_frequency_low",
        fmt::format("{} Hz with damping_frequency_high = {} Hz", damping.frequencies[0], damping.frequencies[1]),
        "two rising frequencies, or neither");
  }
  const bool by_ratio = damping.ratio || !damping.type.empty();
  if (damping.frequencies[0] > 0.0 && !by_ratio) {
    throw input_error("structure.damping_frequency_low", "no ratio that would hold at it",
                      "damping_ratio or damping_type, or no damping_frequency_low and _high");
  }
  if (damping.span > 0.0 && damping.type.empty()) {
    throw input_error("structure.damping_span", "no damping_type", "one, or no damping_span");
  }
  if (!damping.type.empty()) {
    static_cast<void>(damping_lower_bound("structure.damping_type", damping.type, damping.span));
  }
}

FeStructure read_on_supports(const ImportParameters& parameters) {
  FeStructure structure = read_fe_structure(parameters.files, parameters.frame);
  if (!parameters.sections.empty()) {
    if (!parameters.axis_depth) {
      throw input_error("structure.sections", "no structure.axis_depth", "the depth about which moments are taken");
    }
    structure.sections = section_forces(structure, parameters.sections, *parameters.axis_depth);
  }
  return on_supports(std::move(structure), parameters.supports);
}

FeDampingMatrix damping_matrix(const FeStructure& structure, const FeDamping& damping) {
  if (structure.damping.rows() > 0) return {structure.damping, structure.supports.damping};
  FeDampingMatrix matrix;
  const auto [a, b] = rayleigh(structure, damping, matrix.first_frequency);
  matrix.of_unknowns = a * structure.mass + b * structure.stiffness;
  const StructureSupports& s = structure.supports;
  if (s.columns() > 0) matrix.of_supports = a * s.mass + b * s.stiffness;
  return matrix;
}

double mass_per_length(const FeStructure& structure) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& [number, node] : structure.nodes) {
    low = std::min(low, node.position[0]);
    high = std::max(high, node.position[0]);
  }
  const Eigen::VectorXd heave = translations(structure).col(1);
  return high > low ? heave.dot(structure.mass * heave) / (high - low) : 0.0;
}

std::vector<std::string> plausibility_warnings(double mass_per_length, double first_frequency) {
  constexpr double lightest = 100.0, heaviest = 1e6;  // [kg/m]: rails alone have 120
  constexpr double slowest = 0.01, fastest = 1e3;     // [Hz]: the longest suspension bridges swing at 0.04
  std::vector<std::string> warnings;
  if (mass_per_length > 0.0 && !(mass_per_length >= lightest && mass_per_length <= heaviest)) {
    warnings.push_back(
        fmt::format("[structure] has {:.4g} kg per metre of its length, a bridge {:g} to {:g}: see "
                    "structure.units, and structure.mass",
                    mass_per_length, lightest, heaviest));
  }
  if (first_frequency > 0.0 && !(first_frequency >= slowest && first_frequency <= fastest)) {
    warnings.push_back(
        fmt::format("[structure] has its first natural frequency at {:.4g} Hz, a bridge at {:g} to {:g} Hz: "
                    "see structure.units, structure.mass and structure.stiffness",
                    first_frequency, slowest, fastest));
  }
  return warnings;
}

StructureModel build_track_on_import(const TrackParameters& track, const ImportParameters& parameters,
                                     DeckRecord record) {
  track.validate();
  parameters.validate();
  const TrackMotion motion{MotionPlane::spatial, choose_longitudinal(track, {}, MotionPlane::spatial)};
  if (parameters.files.by_modes()) return lay_track(track, modal_bridge(parameters, record), motion, record);
  FeStructure structure = read_on_supports(parameters);
  require_held(structure);
  return lay_track(track, bridge_of(std::move(structure), parameters, record), motion, record);
}

StructureModel import_with_rails(const ImportParameters& parameters, DeckRecord record) {
  parameters.validate();
  const FeStructure structure = read_on_supports(parameters);
  require_held(structure);
  StructureModel model;
  model.mass = structure.mass;
  model.stiffness = structure.stiffness;
  FeDampingMatrix damping = damping_matrix(structure, parameters.damping);
  model.damping = damping.of_unknowns;
  static_cast<void>(number_nodes(structure, model.dof_node));
  model.warnings = plausibility_warnings(mass_per_length(structure), damping.first_frequency);
  model.supports = settled_supports(structure, damping);
  model.rail[0] = rail_line(structure, parameters.rail_left, "structure.rail_left");
  model.rail[1] = rail_line(structure, parameters.rail_right, "structure.rail_right");
  if (parameters.deck.given()) {
    const std::vector<int> deck = selected_nodes(structure, parameters.deck, "structure.deck");
    for (double x : parameters.report) {
      model.nodes.push_back(
          reported(fmt::format("deck-{}", x), structure.nodes.at(nearest_deck_node(structure, deck, x))));
    }
    if (record == DeckRecord::everywhere) set_channels(deck_channels(structure, deck), model);
  }
  return model;
}

}  // namespace railtab
