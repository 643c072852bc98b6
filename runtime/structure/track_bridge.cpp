#include "railtab/runtime/structure/track_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/torsion_element.hpp"

namespace railtab {
namespace {

/// A line of nodes along x: a rail, or the sleepers.
struct NodeLine {
  std::vector<double> x;
  std::vector<DofIndices> dof;
  std::vector<int> twist_rate{};  // of rails
  double y = 0.0, z = 0.0;        // right of the track's centre, below the rail-head tops [m]
};

struct TrackNodes {
  std::array<NodeLine, 2> rail;  // indexed by RailSide
  NodeLine sleeper;              // sleeper i stands at rail node i·elements_per_bay
};

/// Nodes of a track that reaches over a bridge up to `bridge_end`, their dofs not yet numbered.
TrackNodes place_nodes(const TrackParameters& track, double bridge_end, MotionPlane plane) {
  constexpr int to_number = 0;
  DofIndices free;
  for (size_t k = 0; k < 6; ++k) free[k] = has_dof(plane, k) ? to_number : held;
  const bool along_x = track.longitudinal == LongitudinalMotion::kept;
  const DofIndices free_sleeper = along_x ? free : DofIndices{held, free[1], free[2], free[3], held, held};
  if (!along_x) free[0] = held;
  TrackNodes nodes;
  // a length that is a whole number of bays but for rounding must not get one more
  constexpr double rounding = 1e-9;
  const int first = -static_cast<int>(std::ceil(track.length_before / track.sleeper_spacing - rounding));
  const int last = static_cast<int>(std::ceil((bridge_end + track.length_after) / track.sleeper_spacing - rounding));
  for (int i = first; i <= last; ++i) {
    nodes.sleeper.x.push_back(i * track.sleeper_spacing);
    nodes.sleeper.dof.push_back(free_sleeper);
  }
  NodeLine rail;
  for (int j = first * track.elements_per_bay; j <= last * track.elements_per_bay; ++j) {
    rail.x.push_back(j * track.sleeper_spacing / track.elements_per_bay);
    rail.dof.push_back(free);
  }
  rail.dof.front() = rail.dof.back() = {held, free[1], free[2], free[3], held, held};
  rail.twist_rate.assign(rail.x.size(), free[3]);
  rail.twist_rate.front() = rail.twist_rate.back() = held;
  rail.z = track.rail.head_height;
  nodes.rail = {rail, rail};
  nodes.rail[0].y = -track.half_rail_distance;
  nodes.rail[1].y = track.half_rail_distance;
  return nodes;
}

/// Numbers of the track's dofs, after those of the bridge. @param first_line StructureModel::dof_line of its x
void number_dofs(NodeLine& line, int first_line, Bridge& bridge) {
  for (size_t i = 0; i < line.x.size(); ++i) {
    const auto number = [&](int& index, size_t motion) {
      if (index == held) return;
      index = static_cast<int>(bridge.dof_x.size());
      bridge.dof_x.push_back(line.x[i]);
      bridge.dof_line.push_back(first_line + static_cast<int>(motion));
      bridge.dof_node.push_back(bridge.node_count);
    };
    for (size_t k = 0; k < 6; ++k) number(line.dof[i][k], k);
    if (!line.twist_rate.empty()) number(line.twist_rate[i], 6);
    bridge.end_node();
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

/// Bending of the beam, and torsion with warping.
void add_rail(MatrixAssembly& assembly, const NodeLine& line, const RailBeamParameters& rail) {
  const RayleighDamping damping{rail.mass_damping, rail.stiffness_damping};
  add_beam(assembly, line.x, line.dof, {.E = rail.E, .A = rail.A, .Iy = rail.Iy, .Iz = rail.Iz, .mass = rail.mass},
           damping);
  for (size_t e = 0; e + 1 < line.x.size(); ++e) {
    const TorsionElement element{rail.GJ, rail.warping_length, line.x[e + 1] - line.x[e]};
    constexpr size_t roll = 3;
    const std::array<int, 4> dofs{line.dof[e][roll], line.twist_rate[e], line.dof[e + 1][roll], line.twist_rate[e + 1]};
    add_element(assembly, dofs, torsion_mass(element, rail.rotary_inertia), torsion_stiffness(element), damping);
  }
}

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
                           const DofIndices& ground, double y) {
  const SpringDamper ballast(track.ballast_ground, 0, 0);
  const Eigen::Vector3d arm(0, y, 0.5 * track.sleeper.height);
  const Eigen::Vector3d at_ground = Eigen::Vector3d::Zero();
  const std::array<int, 12> dof = joined(sleeper, ground);
  add_element(assembly.stiffness, dof, spring_matrix(arm, at_ground, ballast.k, ballast.k_about));
  add_element(assembly.damping, dof, spring_matrix(arm, at_ground, ballast.c, ballast.c_about));
}

/// Ballast between a sleeper and the bridge.
void add_ballast_on_deck(MatrixAssembly& assembly, const TrackParameters& track, const DofIndices& sleeper, double y,
                         const DeckAttachment& deck) {
  const SpringDamper ballast(track.ballast_deck, 0, 0);
  const Eigen::Vector3d arm_sleeper(0, y, 0.5 * track.sleeper.height);
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(12, 6 + deck.rows.cols());
  T.topLeftCorner<6, 6>().setIdentity();
  T.bottomRightCorner(6, deck.rows.cols()) = deck.rows;
  const Eigen::MatrixXd K = T.transpose() * spring_matrix(arm_sleeper, deck.arm, ballast.k, ballast.k_about) * T;
  const Eigen::MatrixXd C = T.transpose() * spring_matrix(arm_sleeper, deck.arm, ballast.c, ballast.c_about) * T;
  std::vector<int> dof(sleeper.begin(), sleeper.end());
  dof.insert(dof.end(), deck.dof.begin(), deck.dof.end());
  add_element(assembly.stiffness, dof, K);
  add_element(assembly.damping, dof, C);
}

SleeperGround add_sleepers(MatrixAssembly& assembly, const TrackNodes& nodes, const TrackParameters& track,
                           const Bridge& bridge, std::vector<double>& support_x) {
  SleeperGround grounds(nodes.sleeper.x.size());
  const double bottom = track.rail.height + track.sleeper.height;  // below the rail-head top
  for (size_t i = 0; i < nodes.sleeper.x.size(); ++i) {
    const DofIndices& sleeper = nodes.sleeper.dof[i];
    add_sleeper_mass(assembly, sleeper, track.sleeper);
    std::optional<DofIndices>& ground = grounds[i];
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const double sign = side == RailSide::left ? -1.0 : 1.0;
      const NodeLine& rail = nodes.rail[static_cast<size_t>(side)];
      const DofIndices& rail_dof = rail.dof[i * static_cast<size_t>(track.elements_per_bay)];
      const double ballast_y = sign * track.half_ballast_distance;
      add_pad(assembly, track, sleeper, rail_dof, sign * track.half_rail_distance);
      if (const auto deck = bridge.attach(nodes.sleeper.x[i], ballast_y, bottom)) {
        add_ballast_on_deck(assembly, track, sleeper, ballast_y, *deck);
      } else {
        if (!ground) ground = supported_node(nodes.sleeper.x[i], support_x);
        add_ballast_on_ground(assembly, track, sleeper, *ground, ballast_y);
      }
    }
  }
  return grounds;
}

StructureNode nearest_node(std::string name, const NodeLine& line, double x) {
  size_t nearest = 0;
  for (size_t i = 1; i < line.x.size(); ++i) {
    if (std::abs(line.x[i] - x) < std::abs(line.x[nearest] - x)) nearest = i;
  }
  return {std::move(name), line.x[nearest], line.dof[nearest], line.y, line.z};
}

/// The bridge's nodes of interest, each with the rails above it; without a bridge the rails at the origin.
std::vector<StructureNode> named_nodes(const TrackNodes& nodes, const Bridge& bridge) {
  constexpr std::string_view deck = "deck-";
  std::vector<StructureNode> named;
  const auto& [left, right] = nodes.rail;
  for (const StructureNode& node : bridge.nodes) {
    named.push_back(node);
    if (!node.name.starts_with(deck)) continue;
    const std::string place = node.name.substr(deck.size());
    named.push_back(nearest_node("rail-left-" + place, left, node.x));
    named.push_back(nearest_node("rail-right-" + place, right, node.x));
  }
  if (bridge.nodes.empty()) {
    named.push_back(nearest_node("rail-left-origin", left, 0.0));
    named.push_back(nearest_node("rail-right-origin", right, 0.0));
  }
  return named;
}

/// Renumbers all degrees of freedom in the order of x, so that the matrices are banded as they stand.
class OrderAlongTrack {
 public:
  explicit OrderAlongTrack(const std::vector<double>& dof_x) : number_(dof_x.size()) {
    std::vector<int> order(dof_x.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&dof_x](int a, int b) { return dof_x[static_cast<size_t>(a)] < dof_x[static_cast<size_t>(b)]; });
    for (size_t i = 0; i < order.size(); ++i) number_[static_cast<size_t>(order[i])] = static_cast<int>(i);
  }
  void sort(std::vector<int>& of_dof) const {
    std::vector<int> sorted(of_dof.size());
    for (size_t i = 0; i < of_dof.size(); ++i) sorted[static_cast<size_t>(number_[i])] = of_dof[i];
    of_dof = std::move(sorted);
  }
  void renumber(std::span<int> dof) const {
    for (int& index : dof) {
      if (index >= 0) index = number_[static_cast<size_t>(index)];
    }
  }
  void renumber(DofSum& sum) const {
    for (auto& [dof, value] : sum) dof = number(dof);
  }
  void renumber(std::vector<Eigen::Triplet<double>>& entries) const {
    for (auto& e : entries) {
      e = {number(e.row()), number(e.col()), e.value()};
    }
  }

 private:
  // Supports keep theirs.
  [[nodiscard]] int number(int dof) const { return dof < 0 ? dof : number_[static_cast<size_t>(dof)]; }
  std::vector<int> number_;
};

/// Motions of the nodes of interest that are sums of dofs, and the channels of the deck.
void set_rows(Bridge& bridge, const OrderAlongTrack& order, StructureModel& model) {
  SumRows sums;
  for (Bridge::SummedMotion& motion : bridge.summed) {
    order.renumber(motion.sum);
    const std::string& name = bridge.nodes[motion.node].name;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      if (model.nodes[n].name == name) sums.set(static_cast<int>(6 * n + motion.motion), motion.sum);
    }
  }
  if (!bridge.summed.empty()) {
    const auto rows = static_cast<Eigen::Index>(6 * model.nodes.size());
    sums.build(rows, model, model.summed_nodes, model.supports.carried_nodes);
  }
  for (DeckRow& row : bridge.deck) order.renumber(row.sum);
  set_channels(bridge.deck, model);
}

/// The track with this and the number of rail elements decided. A sleeper has pads at its top and ballast at its
/// bottom, and pitches freely: at rest it bears no force along x, and neither holds the rail's foot nor the deck. Above
/// some 100 Hz its inertia does hold the foot, through the pad's damper.
TrackParameters with(LongitudinalMotion motion, TrackParameters track) {
  if (track.elements_per_bay == 0) track.elements_per_bay = 2;
  track.longitudinal = motion;
  if (motion == LongitudinalMotion::left_out) track.pad.kx = track.ballast_deck.kx = track.ballast_deck.cx = 0.0;
  return track;
}

std::string longitudinal_left_out(const TrackNodes& nodes, MotionPlane plane, double change) {
  const size_t of_sleeper = plane == MotionPlane::spatial ? 3 : 2;
  const size_t count = of_sleeper * nodes.sleeper.x.size() + 2 * (nodes.rail[0].x.size() - 2);
  return fmt::format(
      "{} degrees of freedom of the track along x ({} of sleepers, x of rails): nothing acts along them, and the "
      "static compliance of the rail heads under a wheelset changes by at most {:.2g} %",
      count, plane == MotionPlane::spatial ? "x, pitch and yaw" : "x and pitch", 100.0 * change);
}

}  // namespace

StructureModel lay_track(const TrackParameters& parameters, Bridge bridge, const TrackMotion& motion,
                         DeckRecord record) {
  parameters.validate();
  const auto& [plane, longitudinal] = motion;
  const TrackParameters track = with(longitudinal.motion, parameters);
  TrackNodes nodes = place_nodes(track, bridge.end, plane);
  bridge.dof_line.resize(bridge.dof_x.size(), -1);
  while (bridge.dof_node.size() < bridge.dof_x.size()) bridge.dof_node.push_back(bridge.node_count++);
  number_dofs(nodes.sleeper, 0, bridge);
  for (size_t side = 0; side < 2; ++side) {
    number_dofs(nodes.rail[side], lines_per_node * (1 + static_cast<int>(side)), bridge);
  }

  MatrixAssembly& assembly = bridge.matrices;
  const RailBeamParameters& rail = track.rail;
  for (const NodeLine& line : nodes.rail) add_rail(assembly, line, rail);
  const SleeperGround ground = add_sleepers(assembly, nodes, track, bridge, bridge.support_x);
  if (record == DeckRecord::everywhere) add_track_channels(track, nodes.sleeper.x, ground, plane, bridge);

  StructureModel model;
  model.supports.x = std::move(bridge.support_x);
  model.supports.beyond = std::move(bridge.beyond_supports);
  model.nodes = named_nodes(nodes, bridge);
  const OrderAlongTrack order(bridge.dof_x);
  for (auto* entries : {&assembly.mass, &assembly.damping, &assembly.stiffness}) order.renumber(*entries);
  for (StructureNode& node : model.nodes) order.renumber(node.dof);
  for (NodeLine& line : nodes.rail) {
    for (DofIndices& dof : line.dof) order.renumber(dof);
    order.renumber(line.twist_rate);
  }
  build_matrices(assembly, static_cast<int>(bridge.dof_x.size()), model);
  set_rows(bridge, order, model);
  std::sort(bridge.dof_x.begin(), bridge.dof_x.end());
  model.dof_x = std::move(bridge.dof_x);
  order.sort(bridge.dof_line);
  model.dof_line = std::move(bridge.dof_line);
  order.sort(bridge.dof_node);
  model.dof_node = std::move(bridge.dof_node);
  model.spans = std::move(bridge.spans);
  model.warnings = std::move(bridge.warnings);
  model.left_out = std::move(bridge.left_out);
  if (longitudinal.motion == LongitudinalMotion::left_out) {
    model.left_out.push_back(longitudinal_left_out(nodes, plane, longitudinal.change));
  }
  for (size_t side = 0; side < 2; ++side) {
    const NodeLine& line = nodes.rail[side];
    model.rail[side] = {line.x,
                        line.dof,
                        rail.head_height,
                        {rail.E * rail.Iy, rail.E * rail.Iz, rail.GJ, rail.warping_length},
                        line.twist_rate};
  }
  return model;
}

StructureModel build_track_bridge(const TrackParameters& track, const std::vector<BridgeParameters>& spans,
                                  MotionPlane plane, const std::vector<double>& report, DeckRecord record) {
  track.validate();
  return lay_track(track, beam_bridge(spans, plane, report, record), {plane, choose_longitudinal(track, spans, plane)},
                   record);
}

}  // namespace railtab
