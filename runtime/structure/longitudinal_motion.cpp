#include "railtab/runtime/structure/longitudinal_motion.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {
namespace {

/// Compliance of both rail heads at x (y, z, roll of the left, then of the right one).
Eigen::MatrixXd head_compliance(const StructureModel& model, const SparseLdlt& factor, double x, MotionPlane plane) {
  const Eigen::Index per_head = plane == MotionPlane::spatial ? 3 : 1;
  Eigen::MatrixXd heads = Eigen::MatrixXd::Zero(model.dofs(), 2 * per_head);
  for (Eigen::Index side = 0; side < 2; ++side) {
    const RailInterpolation rows = rail_interpolation(model.rail[static_cast<std::size_t>(side)], x);
    for (std::size_t k = 0; k < 12; ++k) {
      if (rows.dof[k] == held) continue;
      auto of_dof = heads.row(rows.dof[k]).segment(per_head * side, per_head);
      if (plane == MotionPlane::spatial) {
        of_dof << rows.y[k], rows.z[k], rows.roll[k];
      } else {
        of_dof << rows.z[k];
      }
    }
  }
  Eigen::MatrixXd moved(heads.rows(), heads.cols());
  for (Eigen::Index j = 0; j < heads.cols(); ++j) moved.col(j) = factor.solve(heads.col(j));
  return heads.transpose() * moved;
}

double change_on_piece(TrackParameters piece, const std::vector<BridgeParameters>& spans,
                       const std::vector<double>& places, MotionPlane plane) {
  constexpr int bays_beyond = 20;
  piece.length_before = piece.length_after = bays_beyond * piece.sleeper_spacing;
  std::vector<Eigen::MatrixXd> kept;
  double change = 0.0;
  for (const LongitudinalMotion motion : {LongitudinalMotion::kept, LongitudinalMotion::left_out}) {
    const StructureModel model = lay_track(piece, beam_bridge(spans, plane), {plane, {motion}});
    const SparseLdlt factor = stiffness_factor(model.stiffness);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::MatrixXd C = head_compliance(model, factor, places[i], plane);
      if (motion == LongitudinalMotion::kept) {
        kept.push_back(C);
        continue;
      }
      change = std::max(change, (generalised_eigenvalues(C, kept[i]).array() - 1.0).abs().maxCoeff());
    }
  }
  return change;
}

bool alike(const BridgeParameters& a, const BridgeParameters& b) {
  return a.length == b.length && a.E == b.E && a.G == b.G && a.A == b.A && a.Iy == b.Iy && a.Iz == b.Iz && a.J == b.J &&
         a.elements == b.elements && a.axis_depth == b.axis_depth && a.track_offset == b.track_offset;
}

}  // namespace

double longitudinal_change(const TrackParameters& track, const std::vector<BridgeParameters>& spans,
                           MotionPlane plane) {
  const double bay = track.sleeper_spacing;
  double change = change_on_piece(track, {}, {0.0, 0.5 * bay}, plane);
  TrackParameters on_held_deck = track;
  on_held_deck.ballast_ground = track.ballast_deck;
  change = std::max(change, change_on_piece(on_held_deck, {}, {0.0, 0.5 * bay}, plane));
  std::vector<BridgeParameters> kinds;
  for (const BridgeParameters& span : spans) {
    if (std::any_of(kinds.begin(), kinds.end(), [&](const BridgeParameters& kind) { return alike(kind, span); })) {
      continue;
    }
    kinds.push_back(span);
    std::vector<double> places;
    for (const double part : {0.0, 0.25, 0.5}) {
      const double sleeper = bay * std::floor(part * span.length / bay);
      places.push_back(sleeper);
      places.push_back(sleeper + 0.5 * bay);
    }
    change = std::max(change, change_on_piece(track, {span}, places, plane));
  }
  return change;
}

LongitudinalChoice choose_longitudinal(const TrackParameters& track, const std::vector<BridgeParameters>& spans,
                                       MotionPlane plane) {
  if (track.longitudinal == LongitudinalMotion::kept) return {};
  const double change = longitudinal_change(track, spans, plane);
  const bool within = change <= longitudinal_tolerance;
  if (track.longitudinal == LongitudinalMotion::automatic && !within) return {LongitudinalMotion::kept, change};
  return {LongitudinalMotion::left_out, change};
}

}  // namespace railtab
