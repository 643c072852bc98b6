#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/bridge.hpp"

namespace railtab {
namespace {

/// The beam nodes of one span.
struct DeckLine {
  std::vector<double> x;
  std::vector<DofIndices> dof;
};

/// Numbers the free dofs of a span, and its two supports, after those that the bridge has.
DeckLine deck_line(const BridgeParameters& span, double start, MotionPlane plane, Bridge& bridge) {
  std::vector<double>& dof_x = bridge.dof_x;
  DeckLine deck;
  for (int i = 0; i <= span.elements; ++i) {
    const double x = start + span.length * i / span.elements;
    const bool supported = i == 0 || i == span.elements;
    DofIndices dof{held, held, held, held, held, held};
    if (supported) dof = supported_node(x, bridge.support_x);
    for (std::size_t k = 0; k < 6; ++k) {
      const bool at_first = i == 0 && k < 4, at_last = i == span.elements && k >= 1 && k < 4;
      if (at_first || at_last || !has_dof(plane, k)) continue;
      dof[k] = static_cast<int>(dof_x.size());
      dof_x.push_back(x);
      bridge.dof_line.push_back(track_lines + static_cast<int>(k));
      bridge.dof_node.push_back(bridge.node_count);
    }
    bridge.end_node();
    deck.x.push_back(x);
    deck.dof.push_back(dof);
  }
  return deck;
}

BeamSection section_of(const BridgeParameters& span) {
  return {span.E, span.A, span.Iy, span.Iz, span.G * span.J, span.mass, span.rotary_inertia};
}

/// Damping in proportion to the mass acts on the motion against the line that joins the span's two supports: as C_s is
/// assembled it would act on the motion against a point at rest, and damp a bridge that moves with its ground.
void damp_against_supports(MatrixAssembly& assembly, const DeckLine& deck, const BeamSection& section,
                           double mass_factor) {
  const double span = deck.x.back() - deck.x.front();
  for (size_t e = 0; e + 1 < deck.x.size(); ++e) {
    const BeamMatrix C = mass_factor * beam_mass(section, deck.x[e + 1] - deck.x[e]);
    const std::array<int, 12> dof = joined(deck.dof[e], deck.dof[e + 1]);
    for (const bool first : {true, false}) {
      const DofIndices& support = first ? deck.dof.front() : deck.dof.back();
      const double turn = (first ? -1.0 : 1.0) / span;  // d/dx of the line per translation of this support
      Eigen::Matrix<double, 12, 2> line = Eigen::Matrix<double, 12, 2>::Zero();
      for (int node = 0; node < 2; ++node) {
        const double part = (deck.x[e + static_cast<size_t>(node)] - deck.x.front()) / span;
        line(6 * node + 1, 0) = line(6 * node + 2, 1) = first ? 1.0 - part : part;
        line(6 * node + 5, 0) = turn;
        line(6 * node + 4, 1) = -turn;
      }
      const Eigen::Matrix<double, 12, 2> load = C * line;
      for (int i = 0; i < 12; ++i) {
        const int row = dof[static_cast<size_t>(i)];
        if (row < 0) continue;
        for (int k = 0; k < 2; ++k) {
          assembly.damping.emplace_back(row, support[static_cast<size_t>(k + 1)], -load(i, k));
        }
      }
    }
  }
}

/// The beam axis at x, expressed by the nodes of its element, and a rigid arm from there to (y, z).
DeckAttachment attachment(const DeckLine& deck, const BridgeParameters& span, double x, double y, double z) {
  const size_t e = interval_at(deck.x, x);
  const std::array<int, 12> dof = joined(deck.dof[e], deck.dof[e + 1]);
  return {{dof.begin(), dof.end()},
          beam_shape(deck.x[e + 1] - deck.x[e], x - deck.x[e]),
          {0, span.track_offset + y, z - span.axis_depth}};
}

StructureNode deck_node(std::string name, const BridgeParameters& span, const DeckLine& deck, std::size_t i) {
  return {std::move(name), deck.x[i], deck.dof[i], -span.track_offset, span.axis_depth};
}

/// The node nearest to x that is no support: those move with the ground.
StructureNode reported(double x, const std::vector<BridgeParameters>& spans, const std::vector<DeckLine>& decks) {
  for (std::size_t s = 0; s < decks.size(); ++s) {
    const std::vector<double>& nodes = decks[s].x;
    if (x < nodes.front() || x > nodes.back()) continue;
    const double element = spans[s].length / spans[s].elements;
    const double nearest = std::clamp(std::round((x - nodes.front()) / element), 1.0, spans[s].elements - 1.0);
    return deck_node(fmt::format("deck-{}", x), spans[s], decks[s], static_cast<std::size_t>(nearest));
  }
  throw input_error(
      "structure.report", fmt::format("{} m", x),
      decks.empty() ? "a [[bridge]] that has decks" : fmt::format("0 to {:.6g} m, the bridge", decks.back().x.back()));
}

DofSum deck_dof(const DeckLine& deck, std::size_t node, std::size_t k, double factor) {
  const int dof = deck.dof[node][k];
  return dof == held ? DofSum{} : DofSum{{dof, factor}};
}

/// −E Iy d²z/dx² at the first or the second node of element e, or −E Iy d³z/dx³ (Hermite's cubic; dz/dx = −pitch).
enum class BeamForce { moment_first, moment_second, shear };
DofSum beam_force(const DeckLine& deck, std::size_t e, double EI, BeamForce force) {
  const double L = deck.x[e + 1] - deck.x[e];
  std::array<double, 4> of{-6.0, -4.0, 6.0, -2.0};  // z, L·dz/dx of the first node, then of the second
  if (force == BeamForce::moment_second) of = {6.0, 2.0, -6.0, 4.0};
  if (force == BeamForce::shear) of = {12.0, 6.0, -12.0, 6.0};
  const double unit = -EI / (force == BeamForce::shear ? L * L * L : L * L);
  DofSum sum;
  for (std::size_t node = 0; node < 2; ++node) {
    add_sum(deck_dof(deck, e + node, 2, 1.0), unit * of[2 * node], sum);
    add_sum(deck_dof(deck, e + node, 4, 1.0), -unit * L * of[2 * node + 1], sum);
  }
  return sum;
}

/// Vertical motion of the nodes and, where the track stands beside the axis, of the deck under it.
void add_displacements(const BridgeParameters& span, const DeckLine& deck, std::vector<DeckRow>& rows) {
  for (std::size_t i = 0; i < deck.x.size(); ++i) {
    const DofSum axis = deck_dof(deck, i, 2, 1.0);
    rows.push_back({{DeckQuantity::displacement, deck.x[i], -span.track_offset}, axis});
    if (span.track_offset == 0.0) continue;
    DeckRow& under = rows.emplace_back(DeckRow{{DeckQuantity::displacement, deck.x[i], 0.0}, axis});
    add_sum(deck_dof(deck, i, 3, 1.0), span.track_offset, under.sum);
  }
}

/// At the nodes the mean of both elements' moments, in the elements' middles the shear.
void add_moments(const BridgeParameters& span, const DeckLine& deck, std::vector<DeckRow>& rows) {
  const double EI = span.E * span.Iy;
  const std::size_t last = deck.x.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    DeckRow& row = rows.emplace_back(DeckRow{{DeckQuantity::bending_moment, deck.x[i], -span.track_offset}, {}});
    const double share = i == 0 || i == last ? 1.0 : 0.5;
    if (i > 0) add_sum(beam_force(deck, i - 1, EI, BeamForce::moment_second), share, row.sum);
    if (i < last) add_sum(beam_force(deck, i, EI, BeamForce::moment_first), share, row.sum);
  }
}
void add_shear(const BridgeParameters& span, const DeckLine& deck, std::vector<DeckRow>& rows) {
  for (std::size_t e = 0; e + 1 < deck.x.size(); ++e) {
    const double middle = 0.5 * (deck.x[e] + deck.x[e + 1]);
    rows.push_back({{DeckQuantity::shear_force, middle, -span.track_offset},
                    beam_force(deck, e, span.E * span.Iy, BeamForce::shear)});
  }
}

}  // namespace

DofIndices supported_node(double x, std::vector<double>& support_x) {
  const int column = static_cast<int>(2 * support_x.size());
  support_x.push_back(x);
  return {held, support_dof(column), support_dof(column + 1), held, held, held};
}

Bridge beam_bridge(const std::vector<BridgeParameters>& spans, MotionPlane plane, const std::vector<double>& report,
                   DeckRecord record) {
  Bridge bridge;
  std::vector<DeckLine> decks;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const BridgeParameters& span = spans[s];
    span.validate();
    const DeckLine deck = deck_line(span, bridge.end, plane, bridge);
    const BeamSection section = section_of(span);
    const double omega_1 = simply_supported_frequency(section, span.length, 1);
    const double omega_2 = simply_supported_frequency(section, span.length, 2);
    const RayleighDamping damping = rayleigh_damping(span.damping_ratio, omega_1, omega_2);
    add_beam(bridge.matrices, deck.x, deck.dof, section, damping);
    damp_against_supports(bridge.matrices, deck, section, damping.mass_factor);
    if (report.empty()) {
      bridge.nodes.push_back(deck_node(fmt::format("deck-midspan-{}", s + 1), span, deck, deck.x.size() / 2));
    }
    bridge.spans.push_back({deck.x.front(), deck.x.back()});
    bridge.end = deck.x.back();
    decks.push_back(deck);
  }
  for (const double x : report) bridge.nodes.push_back(reported(x, spans, decks));
  if (record == DeckRecord::everywhere) {
    bridge.deck_ends = bridge.spans;
    for (const auto add : {&add_displacements, &add_moments, &add_shear}) {
      for (std::size_t s = 0; s < spans.size(); ++s) add(spans[s], decks[s], bridge.deck);
    }
  }
  bridge.attach = [decks, spans](double x, double y, double z) -> std::optional<DeckAttachment> {
    for (std::size_t s = 0; s < decks.size(); ++s) {
      if (decks[s].x.front() <= x && x < decks[s].x.back()) return attachment(decks[s], spans[s], x, y, z);
    }
    return std::nullopt;
  };
  return bridge;
}

}  // namespace railtab
