#include <fmt/format.h>

#include "bridge.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/interval_search.hpp"

namespace railtab {
namespace {

/// The beam nodes of one span.
struct DeckLine {
  std::vector<double> x;
  std::vector<DofIndices> dof;
};

/// Numbers the free dofs of a span after those that the bridge has.
DeckLine deck_line(const BridgeParameters& span, double start, std::vector<double>& dof_x) {
  DeckLine deck;
  for (int i = 0; i <= span.elements; ++i) {
    const double x = start + span.length * i / span.elements;
    DofIndices dof;
    for (std::size_t k = 0; k < 6; ++k) {
      const bool at_first = i == 0 && k < 4, at_last = i == span.elements && k >= 1 && k < 4;
      dof[k] = held;
      if (at_first || at_last) continue;
      dof[k] = static_cast<int>(dof_x.size());
      dof_x.push_back(x);
    }
    deck.x.push_back(x);
    deck.dof.push_back(dof);
  }
  return deck;
}

BeamSection section_of(const BridgeParameters& span) {
  return {span.E, span.A, span.Iy, span.Iz, span.G * span.J, span.mass, span.rotary_inertia};
}

/// The beam axis at x, expressed by the nodes of its element, and a rigid arm from there to (y, z).
DeckAttachment attachment(const DeckLine& deck, const BridgeParameters& span, double x, double y, double z) {
  const size_t e = interval_at(deck.x, x);
  const std::array<int, 12> dof = joined(deck.dof[e], deck.dof[e + 1]);
  return {{dof.begin(), dof.end()},
          beam_shape(deck.x[e + 1] - deck.x[e], x - deck.x[e]),
          {0, span.track_offset + y, z - span.axis_depth}};
}

}  // namespace

Bridge beam_bridge(const std::vector<BridgeParameters>& spans) {
  Bridge bridge;
  std::vector<DeckLine> decks;
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const BridgeParameters& span = spans[s];
    span.validate();
    const DeckLine deck = deck_line(span, bridge.end, bridge.dof_x);
    const BeamSection section = section_of(span);
    const double omega_1 = simply_supported_frequency(section, span.length, 1);
    const double omega_2 = simply_supported_frequency(section, span.length, 2);
    add_beam(bridge.matrices, deck.x, deck.dof, section, rayleigh_damping(span.damping_ratio, omega_1, omega_2));
    const size_t middle = deck.x.size() / 2;
    bridge.nodes.push_back({fmt::format("deck-midspan-{}", s + 1), deck.x[middle], deck.dof[middle]});
    bridge.spans.push_back({deck.x.front(), deck.x.back()});
    bridge.end = deck.x.back();
    decks.push_back(deck);
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
