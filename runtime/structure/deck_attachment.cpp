#include "railtab/runtime/structure/deck_attachment.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/structure/deck_interpolation.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"
#include "railtab/runtime/structure/matrix_assembly.hpp"

namespace railtab {

namespace {

constexpr double same_place = 1e-6;  // [m], by which nodes of one line may differ

struct DeckNode {
  int number = 0;
  FeNode node;
};

std::string named(int number) { return fmt::format("structure.deck: node {}", number); }

std::size_t most_rows(const FeNode& node) {
  return std::max({node.rows[0].size(), node.rows[1].size(), node.rows[2].size()});
}

/// The mean of an expanded node's rows is its motion where all of them are there. CalculiX takes a row away for what is
/// held. Of a beam there are four rows or eight in each direction, and a direction with fewer is held: its mean is
/// zero. Of a shell, with two or three, it cannot be told how many there were.
void settle_expanded(std::vector<DeckNode>& nodes) {
  constexpr std::size_t corners = 4, with_midsides = 8;
  const bool beams =
      std::any_of(nodes.begin(), nodes.end(), [](const DeckNode& n) { return most_rows(n.node) >= corners; });
  for (DeckNode& n : nodes) {
    if (!n.node.expanded()) continue;
    auto& rows = n.node.rows;
    const std::size_t whole = most_rows(n.node) <= corners ? corners : with_midsides;
    for (std::size_t k = 0; k < 3 && beams; ++k) {
      if (rows[k].size() != whole) rows[k].clear();
    }
    if (beams || (rows[0].size() == rows[1].size() && rows[1].size() == rows[2].size())) continue;
    throw input_error(named(n.number),
                      fmt::format("{}, {} and {} rows of x, y and z: a shell node that is partly held", rows[0].size(),
                                  rows[1].size(), rows[2].size()),
                      "deck nodes that are free; supports at other nodes");
  }
}

/// Adds `value` times motion `k` of a node to row `to`; what is held moves with its support, if there is one.
void add_motion(DeckAttachment& deck, int to, const FeNode& node, std::size_t k, double value) {
  if (value == 0.0) return;
  for (const auto& [row, share] : node_motion(node, k)) {
    auto at = std::find(deck.dof.begin(), deck.dof.end(), row);
    const auto column = at - deck.dof.begin();
    if (at == deck.dof.end()) {
      deck.dof.push_back(row);
      deck.rows.conservativeResize(6, column + 1);
      deck.rows.col(column).setZero();
    }
    deck.rows(to, column) += value * share;
  }
}

/// Motions of the straight line between two nodes, at the share t of their distance L; no roll.
void add_straight(DeckAttachment& deck, const FeNode& a, const FeNode& b, double t, double L) {
  for (int k = 0; k < 3; ++k) {
    add_motion(deck, k, a, static_cast<std::size_t>(k), 1.0 - t);
    add_motion(deck, k, b, static_cast<std::size_t>(k), t);
  }
  for (const auto& [node, sign] : {std::pair{&a, -1.0}, std::pair{&b, 1.0}}) {
    add_motion(deck, 4, *node, 2, -sign / L);  // pitch = -dz/dx
    add_motion(deck, 5, *node, 1, sign / L);   // yaw = dy/dx
  }
}

void add_beam_shapes(DeckAttachment& deck, const FeNode& a, const FeNode& b, double s, double L) {
  const BeamShape N = beam_shape(L, s);
  for (int i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      add_motion(deck, i, a, k, N(i, static_cast<Eigen::Index>(k)));
      add_motion(deck, i, b, k, N(i, static_cast<Eigen::Index>(k) + 6));
    }
  }
}

DeckFunction beam_deck(std::vector<DeckNode> nodes) {
  std::vector<double> x;
  for (const DeckNode& n : nodes) {
    if (!x.empty() && n.node.position[0] - x.back() <= same_place) {
      throw input_error(named(n.number), fmt::format("a second deck node at x = {} m", n.node.position[0]),
                        "one of each position along a beam");
    }
    x.push_back(n.node.position[0]);
  }
  const bool rotations = std::any_of(nodes.begin(), nodes.end(), [](const DeckNode& n) {
    return n.node.rows[4].size() == 1 || n.node.rows[5].size() == 1;
  });
  return [x, rotations, nodes = std::move(nodes)](double at, double y, double z) -> std::optional<DeckAttachment> {
    if (at < x.front() - same_place || at >= x.back() - same_place) return std::nullopt;
    const double inside = std::clamp(at, x.front(), x.back());
    const std::size_t e = interval_at(x, inside);
    const FeNode &a = nodes[e].node, &b = nodes[e + 1].node;
    const double L = x[e + 1] - x[e], t = (inside - x[e]) / L;
    DeckAttachment deck;
    if (rotations) {
      add_beam_shapes(deck, a, b, t * L, L);
    } else {
      add_straight(deck, a, b, t, L);
    }
    const Eigen::Vector3d axis = (1.0 - t) * a.position + t * b.position;
    deck.arm = {0.0, y - axis[1], z - axis[2]};
    return deck;
  };
}

/// Nodes of a deck's surface, sorted by x.
class DeckSurface {
 public:
  explicit DeckSurface(std::vector<DeckNode> nodes) : nodes_(std::move(nodes)), outline_(places(nodes_)) {}

  [[nodiscard]] std::optional<DeckAttachment> operator()(double x, double y, double z) const {
    const DeckExtent extent = outline_.at(y);
    if (x < extent.begin - same_place || x >= extent.end - same_place) return std::nullopt;
    double radius = first_radius(x, y);
    for (int attempt = 0; attempt < 6; ++attempt, radius *= 1.3) {
      if (const auto deck = fit(x, y, z, radius)) return deck;
    }
    throw input_error(place(x, y), "deck nodes too few, or on one line", "a surface of nodes under the ballast");
  }

 private:
  [[nodiscard]] static std::vector<Eigen::Vector2d> places(const std::vector<DeckNode>& nodes) {
    std::vector<Eigen::Vector2d> result;
    for (const DeckNode& n : nodes) result.emplace_back(n.node.position.head<2>());
    return result;
  }
  [[nodiscard]] std::string place(double x, double y) const {
    return fmt::format("structure.deck: at x = {:.3f} m, y = {:.3f} m", x, y);
  }
  [[nodiscard]] static double distance(const DeckNode& n, double x, double y) {
    return std::hypot(n.node.position[0] - x, n.node.position[1] - y);
  }

  /// A half of a sleeper spreads its load through the ballast over about half a metre around its middle; coarser meshes
  /// need more for six nodes.
  [[nodiscard]] double first_radius(double x, double y) const {
    constexpr double spread = 0.5;  // [m]
    constexpr std::size_t enough = 6;
    std::vector<double> distances;
    for (const DeckNode& n : nodes_) distances.push_back(distance(n, x, y));
    const std::size_t k = std::min(enough, distances.size()) - 1;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(k), distances.end());
    return std::max(spread, 1.2 * distances[k]);
  }

  /// Empty where the nodes within the radius do not determine a plane.
  [[nodiscard]] std::optional<DeckAttachment> fit(double x, double y, double z, double radius) const {
    constexpr double least = 1e-3;                         // smallest eigenvalue of the moments against the largest
    constexpr double one_layer = 0.2;                      // [m] off the fitted plane
    constexpr double inside = 0.6;                         // of the radius, between the position and its nodes' centre
    std::vector<std::pair<const DeckNode*, double>> near;  // and its weight
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Eigen::Vector3d depth = Eigen::Vector3d::Zero();
    for (const DeckNode& n : nodes_) {
      const double share = distance(n, x, y) / radius;
      if (share >= 1.0) continue;
      const double weight = (1.0 - share * share) * (1.0 - share * share);
      const Eigen::Vector3d p = base(n, x, y, radius);
      near.emplace_back(&n, weight);
      moments += weight * p * p.transpose();
      depth += weight * p * n.node.position[2];
    }
    if (near.size() < 4) return std::nullopt;
    const Eigen::VectorXd spectrum = symmetric_spectrum(moments).values;
    if (spectrum[0] < least * spectrum[2]) return std::nullopt;
    if (std::hypot(moments(0, 1), moments(0, 2)) > inside * moments(0, 0)) {
      throw input_error(
          place(x, y), "deck nodes on one side only: the track lies beyond their edge",
          "a deck under both halves of the sleepers: see structure.origin, structure.axes and structure.deck");
    }
    const Eigen::Matrix3d solve = moments.inverse();
    const Eigen::Vector3d plane = solve * depth;
    DeckAttachment deck;
    for (const auto& [n, weight] : near) {
      const Eigen::Vector3d p = base(*n, x, y, radius);
      if (std::abs(p.dot(plane) - n->node.position[2]) > one_layer) {
        throw input_error(
            place(x, y),
            fmt::format("node {} {:.3f} m off the others' plane", n->number, n->node.position[2] - p.dot(plane)),
            "one layer of nodes");
      }
      const Eigen::Vector3d shape = weight * (solve * p);  // value, radius·d/dx, radius·d/dy
      add_fit(deck, n->node, shape[0], shape[1] / radius, shape[2] / radius);
    }
    deck.arm = {0.0, 0.0, z - plane[0]};
    return deck;
  }

  [[nodiscard]] static Eigen::Vector3d base(const DeckNode& n, double x, double y, double radius) {
    return {1.0, (n.node.position[0] - x) / radius, (n.node.position[1] - y) / radius};
  }

  static void add_fit(DeckAttachment& deck, const FeNode& node, double value, double d_dx, double d_dy) {
    for (int k = 0; k < 3; ++k) add_motion(deck, k, node, static_cast<std::size_t>(k), value);
    add_motion(deck, 3, node, 2, d_dy);        // roll = dz/dy
    add_motion(deck, 4, node, 2, -d_dx);       // pitch = -dz/dx
    add_motion(deck, 5, node, 1, 0.5 * d_dx);  // yaw = (dy/dx - dx/dy)/2
    add_motion(deck, 5, node, 0, -0.5 * d_dy);
  }

  std::vector<DeckNode> nodes_;
  DeckOutline outline_;
};

}  // namespace

DeckFunction deck_function(const FeStructure& structure, const std::vector<int>& numbers) {
  std::vector<DeckNode> nodes;
  for (int number : numbers) nodes.push_back({number, structure.nodes.at(number)});
  settle_expanded(nodes);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const DeckNode& a, const DeckNode& b) { return a.node.position[0] < b.node.position[0]; });
  if (nodes.size() < 2 || nodes.back().node.position[0] - nodes.front().node.position[0] <= same_place) {
    throw input_error("structure.deck",
                      nodes.size() == 1 ? fmt::format("node {} alone", nodes.front().number)
                                        : fmt::format("{} nodes at one place along the track", nodes.size()),
                      "nodes along the track, on which it lies");
  }
  if (!is_surface(structure, numbers)) return beam_deck(std::move(nodes));
  return DeckSurface(std::move(nodes));
}

}  // namespace railtab
