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

// By monotone chains: from the first node to the last and back, at corners that turn to one side alone.
DeckOutline::DeckOutline(std::vector<Eigen::Vector2d> nodes) {
  std::sort(nodes.begin(), nodes.end(),
            [](const auto& a, const auto& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  whole_ = {nodes.front().x(), nodes.back().x()};
  const auto turns_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - b.y()) > (b.y() - a.y()) * (c.x() - b.x());
  };
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t begin = corner_.size();
    for (const Eigen::Vector2d& node : nodes) {
      while (corner_.size() >= begin + 2 && !turns_left(corner_.end()[-2], corner_.back(), node)) corner_.pop_back();
      corner_.push_back(node);
    }
    std::reverse(nodes.begin(), nodes.end());
  }
}

DeckExtent DeckOutline::at(double y) const {
  DeckExtent extent{INFINITY, -INFINITY};
  for (std::size_t i = 0; i < corner_.size(); ++i) {
    const Eigen::Vector2d &a = corner_[i], &b = corner_[(i + 1) % corner_.size()];
    if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) continue;
    const double part = a.y() == b.y() ? 0.0 : (y - a.y()) / (b.y() - a.y());
    const double x = a.x() + part * (b.x() - a.x());
    extent.begin = std::min(extent.begin, x);
    extent.end = std::max(extent.end, x);
  }
  return extent.end > extent.begin ? extent : whole_;
}

std::array<double, 2> DeckOutline::sides() const {
  const auto [left, right] =
      std::minmax_element(corner_.begin(), corner_.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  return {left->y(), right->y()};
}

DeckOutline deck_outline(const FeStructure& structure, const std::vector<int>& deck) {
  std::vector<Eigen::Vector2d> nodes;
  for (const int number : deck) nodes.emplace_back(structure.nodes.at(number).position.head<2>());
  return DeckOutline(std::move(nodes));
}

DeckExtent deck_extent(const FeStructure& structure, const std::vector<int>& deck) {
  return deck_outline(structure, deck).at(0.0);
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
