#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {

/// A place [m] without the distance from zero that turning axes and units leaves.
[[nodiscard]] inline double without_rounding(double x) { return std::abs(x) < 1e-9 ? 0.0 : x; }

/// Whether a deck's nodes do not all stand on one line along x.
[[nodiscard]] bool is_surface(const FeStructure& structure, const std::vector<int>& deck);

/// Begin and end of a deck along the track [m].
struct DeckExtent {
  double begin = 0.0, end = 0.0;
};

/// A deck seen from above: the convex outline of its nodes, whose ends may be skew.
class DeckOutline {
 public:
  /// @param nodes x and y [m], at least one
  explicit DeckOutline(std::vector<Eigen::Vector2d> nodes);
  /// On the line at y; beside the outline from the first to the last node.
  [[nodiscard]] DeckExtent at(double y) const;
  /// Smallest and largest y [m].
  [[nodiscard]] std::array<double, 2> sides() const;

 private:
  std::vector<Eigen::Vector2d> corner_;  ///< of the outline, in turn
  DeckExtent whole_;
};

/// @param deck numbers of its nodes, at least one
[[nodiscard]] DeckOutline deck_outline(const FeStructure& structure, const std::vector<int>& deck);
/// On the track's centre line.
[[nodiscard]] DeckExtent deck_extent(const FeStructure& structure, const std::vector<int>& deck);
/// The same of the deck of a bridge under track. @throws InputError where no bridge is so long or so short, or the deck
/// lies above the track or far below it: wrong units, axes or origins
[[nodiscard]] DeckExtent plausible_deck_extent(const FeStructure& structure, const std::vector<int>& deck);

/// Warning of a deck far from x = 0, about which trains start: most likely the model has another origin.
[[nodiscard]] std::vector<std::string> deck_place_warnings(const DeckExtent& extent);

/// A deck's node that is reported, by name.
struct ReportedDeckNode {
  std::string name;
  int number = 0;
};
/// "deck-<x>": at each position the node nearest to the track's centre there; without a position "deck-midspan-1", in
/// the middle. @throws InputError where a position [m] lies beside the deck
[[nodiscard]] std::vector<ReportedDeckNode> reported_deck_nodes(const FeStructure& structure,
                                                                const std::vector<int>& deck,
                                                                const std::vector<double>& positions);
/// The deck node nearest to the track's centre at x [m].
[[nodiscard]] int nearest_deck_node(const FeStructure& structure, const std::vector<int>& deck, double x);

}  // namespace railtab
