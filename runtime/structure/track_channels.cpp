#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/interval_search.hpp"
#include "railtab/runtime/structure/bridge.hpp"

namespace railtab {
namespace {

constexpr double gauge = 1.435;     // [m] over which a cross level counts [EN1990A2, Figure A2.1]
constexpr double twist_base = 3.0;  // [m]

/// What the two sides of the ballast under a line of sleepers do.
class BallastBed {
 public:
  BallastBed(const TrackParameters& track, const std::vector<double>& sleeper_x, const Bridge& bridge)
      : x_(sleeper_x), cross_level_(sleeper_x.size()), on_deck_(sleeper_x.size(), false) {
    const double bottom = track.rail.height + track.sleeper.height, half = track.half_ballast_distance;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const auto left = bridge.attach(x_[i], -half, bottom), right = bridge.attach(x_[i], half, bottom);
      if (!left || !right) continue;  // the ground has no cross level
      on_deck_[i] = true;
      const auto down = [&](double y, const DeckAttachment& spring) {
        const std::optional<DofSum> of_nodes = bridge.surface ? bridge.surface(x_[i], y) : std::nullopt;
        return of_nodes.value_or(spring.motion(2));
      };
      add_sum(down(half, *right), gauge / (2.0 * half), cross_level_[i]);
      add_sum(down(-half, *left), -gauge / (2.0 * half), cross_level_[i]);
    }
  }

  void add_roll(std::vector<DeckRow>& rows) const {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (!on_deck_[i]) continue;
      DeckRow& row = rows.emplace_back(DeckRow{{DeckQuantity::roll, x_[i], 0.0}, {}});
      add_sum(cross_level_[i], 1.0 / gauge, row.sum);
    }
  }
  /// A piecewise linear difference is largest where one of its ends has a kink.
  void add_twist(std::vector<DeckRow>& rows) const {
    for (const double x : x_) add_twist_from(x, rows);
    const double bays = twist_base / (x_[1] - x_[0]);
    constexpr double rounding = 1e-9;
    if (std::abs(bays - std::round(bays)) < rounding) return;
    for (const double x : x_) add_twist_from(x - twist_base, rows);
  }

 private:
  void add_twist_from(double x, std::vector<DeckRow>& rows) const {
    constexpr double rounding = 1e-9;  // [m]
    if (x < x_.front() || x + twist_base > x_.back() + rounding) return;
    DeckRow row{{DeckQuantity::twist, x, 0.0}, {}};
    const bool from = add_cross_level(x, -1.0, row.sum), to = add_cross_level(x + twist_base, 1.0, row.sum);
    if (from || to) rows.push_back(std::move(row));
  }
  /// By the straight line between sleepers. @return whether one of the two stands on a deck
  bool add_cross_level(double x, double factor, DofSum& sum) const {
    const std::size_t e = interval_at(x_, std::clamp(x, x_.front(), x_.back()));
    const double t = (x - x_[e]) / (x_[e + 1] - x_[e]);
    bool any = false;
    for (const auto& [i, share] : {std::pair{e, 1.0 - t}, std::pair{e + 1, t}}) {
      constexpr double rounding = 1e-9;
      if (std::abs(share) < rounding) continue;
      add_sum(cross_level_[i], factor * share, sum);
      any = any || on_deck_[i];
    }
    return any;
  }

  std::vector<double> x_;
  std::vector<DofSum> cross_level_;
  std::vector<bool> on_deck_;
};

/// The end of a deck on the track's axis, at the underside of the sleepers.
struct DeckEnd {
  double x = 0.0;
  DeckAttachment at;
};

/// None where the deck's nodes do not determine its motion there, which the plan then says.
std::optional<DeckEnd> deck_end(const TrackParameters& track, double x, double inside, Bridge& bridge) {
  try {
    auto at = bridge.attach(inside, 0.0, track.rail.height + track.sleeper.height);
    if (at) return DeckEnd{x, *std::move(at)};
  } catch (const InputError& wrong) {
    bridge.left_out.push_back(
        fmt::format("rotation and offset of the deck's end at x = {:.6g} m: {}", x, wrong.what()));
  }
  return std::nullopt;
}

/// Vertical and longitudinal motion of the ground under the sleeper nearest to x, that stands on it.
DofSum ground_at(double x, const SleeperGround& ground, const std::vector<double>& sleeper_x) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    if (ground[i] && (!nearest || std::abs(sleeper_x[i] - x) < std::abs(sleeper_x[*nearest] - x))) nearest = i;
  }
  if (!nearest) return {};
  return {{(*ground[*nearest])[2], 1.0}};
}

class DeckEnds {
 public:
  DeckEnds(const TrackParameters& track, Bridge& bridge) {
    constexpr double inside = 1e-5;  // [m]: the end of a deck no longer belongs to it
    for (const auto& [from, to] : bridge.deck_ends) {
      ends_.push_back({deck_end(track, from, from, bridge), deck_end(track, to, to - inside, bridge)});
    }
  }

  void add_rotations(DeckQuantity quantity, Eigen::Index motion, std::vector<DeckRow>& rows) const {
    for (const auto& deck : ends_) {
      for (const auto& end : deck) {
        if (end) rows.push_back({{quantity, end->x, 0.0}, end->at.motion(motion)});
      }
    }
  }
  /// Of every end against the deck or the ground behind or before it.
  void add_offsets(DeckQuantity quantity, Eigen::Index motion, const std::function<DofSum(double)>& ground,
                   std::vector<DeckRow>& rows) const {
    for (std::size_t d = 0; d < ends_.size(); ++d) {
      const auto& [begin, end] = ends_[d];
      const bool after_another = d > 0 && begin && ends_[d - 1][1] && meet(*ends_[d - 1][1], *begin);
      const bool before_another = d + 1 < ends_.size() && end && ends_[d + 1][0] && meet(*end, *ends_[d + 1][0]);
      if (begin && !after_another) {
        rows.push_back({{quantity, begin->x, 0.0}, begin->at.motion(motion)});
        add_sum(ground(begin->x), -1.0, rows.back().sum);
      }
      if (!end) continue;
      DeckRow& row = rows.emplace_back(DeckRow{{quantity, end->x, 0.0}, {}});
      add_sum(end->at.motion(motion), -1.0, row.sum);
      add_sum(before_another ? ends_[d + 1][0]->at.motion(motion) : ground(end->x), 1.0, row.sum);
    }
  }

 private:
  [[nodiscard]] static bool meet(const DeckEnd& a, const DeckEnd& b) {
    constexpr double widest = 0.5;  // [m] of a joint
    return std::abs(a.x - b.x) <= widest;
  }
  std::vector<std::array<std::optional<DeckEnd>, 2>> ends_;
};

}  // namespace

DofSum DeckAttachment::motion(Eigen::Index k) const {
  DofSum sum;
  for (std::size_t j = 0; j < dof.size(); ++j) {
    const Eigen::Matrix<double, 6, 1> column = rows.col(static_cast<Eigen::Index>(j));
    const Eigen::Vector3d turned = Eigen::Vector3d(column.tail<3>()).cross(arm);
    const double value = column[k] + (k < 3 ? turned[k] : 0.0);
    if (value != 0.0 && dof[j] != held) sum.emplace_back(dof[j], value);
  }
  return sum;
}

void add_track_channels(const TrackParameters& track, const std::vector<double>& sleeper_x, const SleeperGround& ground,
                        MotionPlane plane, Bridge& bridge) {
  if (bridge.deck_ends.empty()) return;
  const DeckEnds ends(track, bridge);
  if (plane == MotionPlane::spatial) {
    const BallastBed bed(track, sleeper_x, bridge);
    bed.add_roll(bridge.deck);
    bed.add_twist(bridge.deck);
    ends.add_rotations(DeckQuantity::horizontal_rotation, 5, bridge.deck);
  }
  ends.add_rotations(DeckQuantity::end_rotation, 4, bridge.deck);
  ends.add_offsets(
      DeckQuantity::joint_step, 2, [&](double x) { return ground_at(x, ground, sleeper_x); }, bridge.deck);
  ends.add_offsets(
      DeckQuantity::joint_gap, 0, [](double) { return DofSum{}; }, bridge.deck);
}

}  // namespace railtab
