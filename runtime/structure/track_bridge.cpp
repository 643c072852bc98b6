#include "railtab/runtime/structure/track_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "matrix_assembly.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/interval_search.hpp"
#include "railtab/runtime/vehicle/spring_damper.hpp"

namespace railtab {
namespace {

constexpr int to_number = 0;  // a free dof before the dofs are numbered
constexpr DofIndices all_free{to_number, to_number, to_number, to_number, to_number, to_number};

/// A line of nodes along x: a rail, the sleepers, or a deck.
struct NodeLine {
  std::vector<double> x;
  std::vector<DofIndices> dof;
};

struct TrackNodes {
  std::array<NodeLine, 2> rail;  // indexed by RailSide
  NodeLine sleeper;              // sleeper i stands at rail node i·elements_per_bay
  std::vector<NodeLine> deck;    // per span
};

std::vector<NodeLine> deck_lines(const std::vector<BridgeParameters>& spans) {
  std::vector<NodeLine> decks;
  double start = 0;
  for (const BridgeParameters& span : spans) {
    NodeLine deck;
    for (int i = 0; i <= span.elements; ++i) {
      deck.x.push_back(start + span.length * i / span.elements);
      deck.dof.push_back(all_free);
    }
    deck.dof.front() = {held, held, held, held, to_number, to_number};
    deck.dof.back() = {to_number, held, held, held, to_number, to_number};
    start = deck.x.back();
    decks.push_back(std::move(deck));
  }
  return decks;
}

TrackNodes place_nodes(const TrackParameters& track, const std::vector<BridgeParameters>& spans) {
  TrackNodes nodes;
  nodes.deck = deck_lines(spans);
  const double bridge_end = nodes.deck.empty() ? 0.0 : nodes.deck.back().x.back();
  // a length that is a whole number of bays but for rounding must not get one more
  constexpr double rounding = 1e-9;
  const int first = -static_cast<int>(std::ceil(track.length_before / track.sleeper_spacing - rounding));
  const int last = static_cast<int>(std::ceil((bridge_end + track.length_after) / track.sleeper_spacing - rounding));
  for (int i = first; i <= last; ++i) {
    nodes.sleeper.x.push_back(i * track.sleeper_spacing);
    nodes.sleeper.dof.push_back(all_free);
  }
  NodeLine rail;
  for (int j = first * track.elements_per_bay; j <= last * track.elements_per_bay; ++j) {
    rail.x.push_back(j * track.sleeper_spacing / track.elements_per_bay);
    rail.dof.push_back(all_free);
  }
  rail.dof.front() = rail.dof.back() = {held, to_number, to_number, to_number, held, held};
  nodes.rail = {rail, rail};
  return nodes;
}

/// Numbers the free dofs in the order of x, so that the matrices are banded as they stand; returns their positions.
std::vector<double> number_dofs(TrackNodes& nodes) {
  std::vector<std::pair<double, DofIndices*>> order;
  auto enlist = [&order](NodeLine& line) {
    for (size_t i = 0; i < line.x.size(); ++i) order.emplace_back(line.x[i], &line.dof[i]);
  };
  for (NodeLine& deck : nodes.deck) enlist(deck);
  enlist(nodes.sleeper);
  for (NodeLine& rail : nodes.rail) enlist(rail);
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> dof_x;
  for (const auto& [x, dof] : order) {
    for (int& index : *dof) {
      if (index == held) continue;
      index = static_cast<int>(dof_x.size());
      dof_x.push_back(x);
    }
  }
  return dof_x;
}

void add_beam(MatrixAssembly& assembly, const NodeLine& line, const BeamSection& section,
              const RayleighDamping& damping) {
  for (size_t e = 0; e + 1 < line.x.size(); ++e) {
    const double length = line.x[e + 1] - line.x[e];
    const BeamMatrix K = beam_stiffness(section, length);
    const BeamMatrix M = beam_mass(section, length);
    const BeamMatrix C = damping.mass_factor * M + damping.stiffness_factor * K;
    const std::array<int, 12> dof = joined(line.dof[e], line.dof[e + 1]);
    add_element(assembly.stiffness, dof, K);
    add_element(assembly.mass, dof, M);
    add_element(assembly.damping, dof, C);
  }
}

void add_rails(MatrixAssembly& assembly, const TrackNodes& nodes, const RailBeamParameters& rail) {
  const BeamSection section{rail.E, rail.A, rail.Iy, rail.Iz, rail.GJ, rail.mass, rail.rotary_inertia};
  for (const NodeLine& line : nodes.rail)
    add_beam(assembly, line, section, {rail.mass_damping, rail.stiffness_damping});
}

void add_decks(MatrixAssembly& assembly, const TrackNodes& nodes, const std::vector<BridgeParameters>& spans) {
  for (size_t s = 0; s < spans.size(); ++s) {
    const BridgeParameters& span = spans[s];
    const BeamSection section{span.E, span.A, span.Iy, span.Iz, span.G * span.J, span.mass, span.rotary_inertia};
    const double omega_1 = simply_supported_frequency(section, span.length, 1);
    const double omega_2 = simply_supported_frequency(section, span.length, 2);
    add_beam(assembly, nodes.deck[s], section, rayleigh_damping(span.damping_ratio, omega_1, omega_2));
  }
}

struct SpringDamper {
  Eigen::Vector3d k, c;              // along x, y, z
  Eigen::Vector3d k_about, c_about;  // about x, y, z

  SpringDamper(const SupportParameters& support, double k_roll, double c_roll)
      : k(support.kx, support.ky, support.kz),
        c(support.cx, support.cy, support.cz),
        k_about(k_roll, 0, 0),
        c_about(c_roll, 0, 0) {}
};

void add_sleeper_mass(MatrixAssembly& assembly, const DofIndices& dof, const SleeperParameters& sleeper) {
  Eigen::Matrix<double, 6, 1> inertia;
  inertia << sleeper.mass, sleeper.mass, sleeper.mass, sleeper.Jx, sleeper.Jy, sleeper.Jz;
  const Eigen::Matrix<double, 6, 6> M = inertia.asDiagonal();
  add_element(assembly.mass, dof, M);
}

/// Pad between the rail foot and the sleeper's top.
void add_pad(MatrixAssembly& assembly, const TrackParameters& track, const DofIndices& sleeper, const DofIndices& rail,
             double y) {
  const SpringDamper pad(track.pad, track.pad_roll_stiffness, track.pad_roll_damping);
  const Eigen::Vector3d arm_sleeper(0, y, -0.5 * track.sleeper.height);
  const Eigen::Vector3d arm_rail(0, 0, track.rail.height - track.rail.head_height);
  const std::array<int, 12> dof = joined(sleeper, rail);
  add_element(assembly.stiffness, dof, spring_matrix(arm_sleeper, arm_rail, pad.k, pad.k_about));
  add_element(assembly.damping, dof, spring_matrix(arm_sleeper, arm_rail, pad.c, pad.c_about));
}

void add_ballast_on_ground(MatrixAssembly& assembly, const TrackParameters& track, const DofIndices& sleeper,
                           double y) {
  const SpringDamper ballast(track.ballast_ground, 0, 0);
  const Eigen::Vector3d arm(0, y, 0.5 * track.sleeper.height);
  // the ground stands still: only the sleeper's block of the pair remains
  const Eigen::Matrix<double, 6, 6> K = spring_matrix(arm, arm, ballast.k, ballast.k_about).topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 6> C = spring_matrix(arm, arm, ballast.c, ballast.c_about).topLeftCorner<6, 6>();
  add_element(assembly.stiffness, sleeper, K);
  add_element(assembly.damping, sleeper, C);
}

/// Ballast between the sleeper at `x` and the deck: the deck's end is the beam axis at x, expressed by the element's
/// nodes, and a rigid arm from there.
void add_ballast_on_deck(MatrixAssembly& assembly, const TrackParameters& track, const BridgeParameters& span,
                         const NodeLine& deck, const DofIndices& sleeper, double x, double y) {
  const SpringDamper ballast(track.ballast_deck, 0, 0);
  const double sleeper_bottom = track.rail.height + track.sleeper.height;  // below the rail-head top
  const Eigen::Vector3d arm_sleeper(0, y, 0.5 * track.sleeper.height);
  const Eigen::Vector3d arm_deck(0, span.track_offset + y, sleeper_bottom - span.axis_depth);
  const size_t e = interval_at(deck.x, x);

  using DeckPair = Eigen::Matrix<double, 18, 18>;
  Eigen::Matrix<double, 12, 18> T = Eigen::Matrix<double, 12, 18>::Zero();
  T.topLeftCorner<6, 6>().setIdentity();
  T.bottomRightCorner<6, 12>() = beam_shape(deck.x[e + 1] - deck.x[e], x - deck.x[e]);
  const DeckPair K = T.transpose() * spring_matrix(arm_sleeper, arm_deck, ballast.k, ballast.k_about) * T;
  const DeckPair C = T.transpose() * spring_matrix(arm_sleeper, arm_deck, ballast.c, ballast.c_about) * T;

  std::array<int, 18> dof;
  const std::array<int, 12> deck_dof = joined(deck.dof[e], deck.dof[e + 1]);
  std::copy(sleeper.begin(), sleeper.end(), dof.begin());
  std::copy(deck_dof.begin(), deck_dof.end(), dof.begin() + 6);
  add_element(assembly.stiffness, dof, K);
  add_element(assembly.damping, dof, C);
}

void add_sleepers(MatrixAssembly& assembly, const TrackNodes& nodes, const TrackParameters& track,
                  const std::vector<BridgeParameters>& spans) {
  for (size_t i = 0; i < nodes.sleeper.x.size(); ++i) {
    const double x = nodes.sleeper.x[i];
    const DofIndices& sleeper = nodes.sleeper.dof[i];
    const auto deck = std::find_if(nodes.deck.begin(), nodes.deck.end(),
                                   [x](const NodeLine& line) { return line.x.front() <= x && x < line.x.back(); });
    add_sleeper_mass(assembly, sleeper, track.sleeper);
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const double sign = side == RailSide::left ? -1.0 : 1.0;
      const NodeLine& rail = nodes.rail[static_cast<size_t>(side)];
      const DofIndices& rail_dof = rail.dof[i * static_cast<size_t>(track.elements_per_bay)];
      const double ballast_y = sign * track.half_ballast_distance;
      add_pad(assembly, track, sleeper, rail_dof, sign * track.half_rail_distance);
      if (deck == nodes.deck.end()) {
        add_ballast_on_ground(assembly, track, sleeper, ballast_y);
      } else {
        const BridgeParameters& span = spans[static_cast<size_t>(deck - nodes.deck.begin())];
        add_ballast_on_deck(assembly, track, span, *deck, sleeper, x, ballast_y);
      }
    }
  }
}

StructureNode nearest_node(std::string name, const NodeLine& line, double x) {
  size_t nearest = 0;
  for (size_t i = 1; i < line.x.size(); ++i) {
    if (std::abs(line.x[i] - x) < std::abs(line.x[nearest] - x)) nearest = i;
  }
  return {std::move(name), line.x[nearest], line.dof[nearest]};
}

std::vector<StructureNode> named_nodes(const TrackNodes& nodes) {
  std::vector<StructureNode> named;
  const auto& [left, right] = nodes.rail;
  for (size_t s = 0; s < nodes.deck.size(); ++s) {
    const NodeLine& deck = nodes.deck[s];
    const size_t middle = deck.x.size() / 2;
    named.push_back({fmt::format("deck-midspan-{}", s + 1), deck.x[middle], deck.dof[middle]});
    named.push_back(nearest_node(fmt::format("rail-left-midspan-{}", s + 1), left, deck.x[middle]));
    named.push_back(nearest_node(fmt::format("rail-right-midspan-{}", s + 1), right, deck.x[middle]));
  }
  if (nodes.deck.empty()) {
    named.push_back(nearest_node("rail-left-origin", left, 0.0));
    named.push_back(nearest_node("rail-right-origin", right, 0.0));
  }
  return named;
}

}  // namespace

StructureModel build_track_bridge(const TrackParameters& track, const std::vector<BridgeParameters>& spans) {
  track.validate();
  for (const BridgeParameters& span : spans) span.validate();
  TrackNodes nodes = place_nodes(track, spans);
  std::vector<double> dof_x = number_dofs(nodes);

  MatrixAssembly assembly;
  add_rails(assembly, nodes, track.rail);
  add_decks(assembly, nodes, spans);
  add_sleepers(assembly, nodes, track, spans);

  StructureModel model;
  build_matrices(assembly, static_cast<int>(dof_x.size()), model);
  model.dof_x = std::move(dof_x);
  for (const NodeLine& deck : nodes.deck) model.spans.push_back({deck.x.front(), deck.x.back()});
  for (size_t side = 0; side < 2; ++side) {
    model.rail[side] = {nodes.rail[side].x, nodes.rail[side].dof, track.rail.head_height};
  }
  model.nodes = named_nodes(nodes);
  return model;
}

}  // namespace railtab
