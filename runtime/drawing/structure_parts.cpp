#include <algorithm>
#include <cmath>
#include <memory>

#include "railtab/runtime/drawing/drawn_line.hpp"
#include "railtab/runtime/drawing/drawn_points.hpp"
#include "railtab/runtime/drawing/run_parts.hpp"

namespace railtab::drawing {
namespace {

constexpr double drawn_spacing = 1.0;  // of points between recorded nodes [m]
constexpr double on_span = 1e-3;       // [m]

/// A piece of a deck or rail, and the recorded nodes that its weights are of.
struct LinePiece {
  DrawnLine line;
  std::vector<std::size_t> nodes;  // indices in StepRecord::nodes
  double y = 0.0, z = 0.0;         // at rest [m]
};

Motion motion_at(const LinePiece& piece, std::size_t point, const StepRecord& step) {
  const std::optional<int>& own = piece.line.of[point];
  if (own) return Motion(step.nodes[piece.nodes[static_cast<std::size_t>(*own)]]);
  Motion motion;
  for (std::size_t k = 0; k < piece.nodes.size(); ++k) {
    const double weight = piece.line.weights(static_cast<Eigen::Index>(point), static_cast<Eigen::Index>(k));
    if (weight != 0.0) motion += Motion(step.nodes[piece.nodes[k]]).times(weight);
  }
  return motion;
}

/// Mean place of some nodes across the track; `standard` where results do not say.
double mean_of(const std::vector<double>& places, const std::vector<std::size_t>& nodes, double standard) {
  if (places.empty() || nodes.empty()) return standard;
  double sum = 0.0;
  for (const std::size_t node : nodes) sum += places[node];
  return sum / static_cast<double>(nodes.size());
}

std::vector<std::size_t> nodes_with(const ResultHeader& header, bool (*named)(std::string_view) noexcept) {
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < header.node_names.size(); ++i) {
    if (named(header.node_names[i])) nodes.push_back(i);
  }
  return nodes;
}

LinePiece piece_of(const ResultHeader& header, std::vector<std::size_t> nodes, const std::vector<double>& rests,
                   const std::array<double, 2>& standard_place) {
  std::vector<double> x;
  for (const std::size_t node : nodes) x.push_back(header.node_x[node]);
  const double y = mean_of(header.node_y, nodes, standard_place[0]);
  const double z = mean_of(header.node_z, nodes, standard_place[1]);
  return {drawn_line(x, rests, drawn_spacing), std::move(nodes), y, z};
}

/// A line over each span, at rest at both ends, and without spans one through the nodes alone.
std::vector<LinePiece> pieces_over_spans(const ResultHeader& header, const std::vector<std::size_t>& nodes,
                                         const std::array<double, 2>& standard_place) {
  std::vector<LinePiece> pieces;
  for (std::size_t s = 0; s < header.span_from.size(); ++s) {
    const double from = header.span_from[s], to = header.span_to[s];
    std::vector<std::size_t> of_span;
    for (const std::size_t node : nodes) {
      if (header.node_x[node] >= from - on_span && header.node_x[node] <= to + on_span) of_span.push_back(node);
    }
    pieces.push_back(piece_of(header, std::move(of_span), {from, to}, standard_place));
  }
  if (pieces.empty() && nodes.size() > 1) pieces.push_back(piece_of(header, nodes, {}, standard_place));
  return pieces;
}

void add_deck(Grid& grid, DrawnPoints& points, const LinePiece& piece, const StepRecord& step) {
  constexpr double half_width = 2.5, top = 0.5, least_depth = 0.8;  // drawn [m]
  const double upper = std::min(top, piece.z) - piece.z, lower = std::max(-upper, least_depth + upper);
  std::vector<std::int64_t> axis;
  std::array<std::int64_t, 4> before{};
  for (std::size_t p = 0; p < piece.line.x.size(); ++p) {
    const Motion motion = motion_at(piece, p, step);
    const Eigen::Vector3d rest(piece.line.x[p], piece.y, piece.z);
    axis.push_back(points.add(rest, motion, piece.line.of[p].has_value()));
    std::array<std::int64_t, 4> corners{};
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Eigen::Vector3d arm(0.0, c == 1 || c == 2 ? half_width : -half_width, c >= 2 ? lower : upper);
      corners[c] = points.add(rest + arm, motion.at(arm), false);
    }
    if (p > 0) {
      const std::array<std::int64_t, 8> box{before[0],  before[1],  before[2],  before[3],
                                            corners[0], corners[1], corners[2], corners[3]};
      grid.add_cell(Cell::hexahedron, box);
    }
    before = corners;
  }
  grid.add_cell(Cell::poly_line, axis);
}

/// The track that the train has passed or will pass, at rest beside the bridge: nothing is recorded of it.
std::array<double, 2> track_range(const ResultHeader& header, std::span<const StepRecord> records) {
  constexpr double margin = 5.0;  // [m]
  double low = INFINITY, high = -INFINITY;
  double rear = 0.0;
  for (const auto* offsets : {&header.wheel_x, &header.body_x}) {
    for (const double x : *offsets) rear = std::min(rear, x);
  }
  for (const StepRecord& step : records) {
    low = std::min(low, step.position + rear);
    high = std::max(high, step.position);
  }
  for (const auto* places : {&header.span_from, &header.span_to, &header.node_x}) {
    for (const double x : *places) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return {low - margin, high + margin};
}

/// The pieces in order, straight lines at rest between and beside them.
void add_rail(Grid& grid, DrawnPoints& points, const std::vector<LinePiece>& pieces, std::array<double, 2> range,
              const Eigen::Vector2d& place, const StepRecord& step) {
  std::vector<std::int64_t> line{points.add({range[0], place[0], place[1]}, {}, false)};
  for (const LinePiece& piece : pieces) {
    for (std::size_t p = 0; p < piece.line.x.size(); ++p) {
      line.push_back(
          points.add({piece.line.x[p], place[0], place[1]}, motion_at(piece, p, step), piece.line.of[p].has_value()));
    }
  }
  line.push_back(points.add({range[1], place[0], place[1]}, {}, false));
  grid.add_cell(Cell::poly_line, line);
}

Part bridge_part(const ResultHeader& header) {
  constexpr std::array<double, 2> standard_place{0.0, 1.9};
  auto pieces = std::make_shared<const std::vector<LinePiece>>(
      pieces_over_spans(header, nodes_with(header, &is_deck), standard_place));
  return {"bridge", [pieces](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            for (const LinePiece& piece : *pieces) add_deck(grid, points, piece, step);
            points.write();
            return grid;
          }};
}

Part rails_part(const ResultHeader& header, std::span<const StepRecord> records) {
  struct Rail {
    std::vector<LinePiece> pieces;
    Eigen::Vector2d place;
  };
  auto rails = std::make_shared<std::vector<Rail>>();
  constexpr double axis = 0.0911;  // of the standard rail, below its head's top [m]
  const double half = half_rail_distance(header);
  for (const bool left : {true, false}) {
    const std::array<double, 2> standard_place{left ? -half : half, axis};
    const std::vector<std::size_t> nodes = nodes_with(header, left ? &is_left_rail : &is_right_rail);
    rails->push_back({pieces_over_spans(header, nodes, standard_place),
                      {mean_of(header.node_y, nodes, standard_place[0]), mean_of(header.node_z, nodes, axis)}});
  }
  return {"rails", [rails, range = track_range(header, records)](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            for (const Rail& rail : *rails) add_rail(grid, points, rail.pieces, range, rail.place, step);
            points.write();
            return grid;
          }};
}

/// Every recorded node, as it is in the results.
Part nodes_part(const ResultHeader& header) {
  return {"nodes", [&header](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            std::vector<std::int32_t> index;
            for (std::size_t i = 0; i < step.nodes.size(); ++i) {
              const double y = header.node_y.empty() ? 0.0 : header.node_y[i];
              const double z = header.node_z.empty() ? 0.0 : header.node_z[i];
              const std::int64_t point = points.add({header.node_x[i], y, z}, Motion(step.nodes[i]), true);
              grid.add_cell(Cell::vertex, {{point}});
              index.push_back(static_cast<std::int32_t>(i));
            }
            points.write();
            grid.point_data.push_back({"node", 1, std::move(index)});
            grid.texts.emplace_back("node_names", header.node_names);
            return grid;
          }};
}

}  // namespace

double half_rail_distance(const ResultHeader& header) {
  constexpr double standard = 0.75;  // [m]
  const std::vector<std::size_t> right = nodes_with(header, &is_right_rail);
  return std::abs(mean_of(header.node_y, right, standard));
}

bool is_left_rail(std::string_view node_name) noexcept { return node_name.starts_with("rail-left"); }
bool is_right_rail(std::string_view node_name) noexcept { return node_name.starts_with("rail-right"); }

std::vector<Part> structure_parts(const ResultHeader& header, std::span<const StepRecord> records) {
  std::vector<Part> parts;
  if (!header.span_from.empty() || nodes_with(header, &is_deck).size() > 1) parts.push_back(bridge_part(header));
  if (!records.empty()) parts.push_back(rails_part(header, records));
  if (!header.node_names.empty()) parts.push_back(nodes_part(header));
  return parts;
}

}  // namespace railtab::drawing
