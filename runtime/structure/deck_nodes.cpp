#include "railtab/runtime/structure/deck_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

bool is_surface(const FeStructure& structure, const std::vector<int>& deck) {
  constexpr double same_line = 1e-6;  // [m]
  double low = INFINITY, high = -INFINITY;
  for (const int number : deck) {
    low = std::min(low, structure.nodes.at(number).position[1]);
    high = std::max(high, structure.nodes.at(number).position[1]);
  }
  return high - low > same_line;
}

DeckExtent deck_extent(const FeStructure& structure, const std::vector<int>& deck) {
  DeckExtent extent{INFINITY, -INFINITY};
  for (const int number : deck) {
    extent.begin = std::min(extent.begin, structure.nodes.at(number).position[0]);
    extent.end = std::max(extent.end, structure.nodes.at(number).position[0]);
  }
  return extent;
}

DeckExtent plausible_deck_extent(const FeStructure& structure, const std::vector<int>& deck) {
  constexpr double shortest = 0.5, longest = 1e5, highest = -0.5, lowest = 60.0;  // [m]
  const DeckExtent extent = deck_extent(structure, deck);
  if (!(extent.end - extent.begin >= shortest && extent.end - extent.begin <= longest)) {
    throw input_error(
        "structure.deck",
        fmt::format("a deck from x = {:.4g} m to {:.4g} m", without_rounding(extent.begin), extent.end),
        fmt::format("{} m to {:.0f} km of it: see structure.units and structure.axes", shortest, 1e-3 * longest));
  }
  for (const int number : deck) {
    const double z = structure.nodes.at(number).position[2];
    if (z >= highest && z <= lowest) continue;
    throw input_error(fmt::format("structure.deck: node {}", number),
                      fmt::format("{:.4g} m {} the rail-head tops", std::abs(z), z < 0.0 ? "above" : "below"),
                      "a deck below the track: see structure.origin, structure.axes and structure.units");
  }
  return extent;
}

std::vector<std::string> deck_place_warnings(const DeckExtent& extent) {
  constexpr double farthest = 1000.0;  // [m]
  if (extent.end >= 0.0 && extent.begin <= farthest) return {};
  return {fmt::format(
      "the deck of [structure] is at x = {:.6g} to {:.6g} m, {}: structure.origin is the point of the model "
      "that is to be at x = 0",
      without_rounding(extent.begin), without_rounding(extent.end),
      extent.end < 0.0 ? "before x = 0, where the first wheelset starts unless train.start says otherwise"
                       : fmt::format("more than {:g} m of track before it", farthest))};
}

int nearest_deck_node(const FeStructure& structure, const std::vector<int>& deck, double x) {
  int best = no_node;
  double least = INFINITY;
  for (const int number : deck) {
    const FeNode& node = structure.nodes.at(number);
    const double distance = std::hypot(node.position[0] - x, node.position[1]);
    if (distance < least) {
      least = distance;
      best = number;
    }
  }
  return best;
}

std::vector<ReportedDeckNode> reported_deck_nodes(const FeStructure& structure, const std::vector<int>& deck,
                                                  const std::vector<double>& positions) {
  const DeckExtent extent = deck_extent(structure, deck);
  std::vector<ReportedDeckNode> nodes;
  for (const double x : positions) {
    if (x < extent.begin || x > extent.end) {
      throw input_error("structure.report", fmt::format("{} m", x),
                        fmt::format("{:.6g} to {:.6g} m, the deck", without_rounding(extent.begin), extent.end));
    }
    nodes.push_back({fmt::format("deck-{}", x), nearest_deck_node(structure, deck, x)});
  }
  if (positions.empty()) {
    nodes.push_back({"deck-midspan-1", nearest_deck_node(structure, deck, 0.5 * (extent.begin + extent.end))});
  }
  return nodes;
}

}  // namespace railtab
