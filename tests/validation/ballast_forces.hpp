#pragma once

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// Forces of the ballast on a deck: what pads exert on a sleeper less its inertia. The side forces under a sleeper's
/// two halves have one line of action: only their sum is known, and is shared equally.
class BallastForces {
 public:
  struct Force {
    double aside = 0.0, down = 0.0;  // to the right [N]
  };
  BallastForces(const StructureModel& structure, TrackParameters track);

  /// Under the left and the right half of the sleeper at i·spacing.
  [[nodiscard]] std::array<Force, 2> under(int i, const LinearMotion& motion) const;

 private:
  struct Motion {
    double y, z, roll;
    friend Motion operator-(const Motion& a, const Motion& b) { return {a.y - b.y, a.z - b.z, a.roll - b.roll}; }
  };
  static Motion pick(const std::array<int, 3>& dof, const Eigen::VectorXd& from) {
    return {from[dof[0]], from[dof[1]], from[dof[2]]};
  }
  /// At (y, z) from the axis of a body that rolls.
  static Motion at(double y, double z, const Motion& body) {
    return {body.y - z * body.roll, body.z + y * body.roll, body.roll};
  }

  TrackParameters track_;
  std::map<int, std::array<int, 3>> sleeper_;              // dofs y, z, roll
  std::array<std::map<int, std::array<int, 3>>, 2> rail_;  // above the sleepers
};

inline BallastForces::BallastForces(const StructureModel& structure, TrackParameters track) : track_(std::move(track)) {
  const auto place = [&](double x) { return static_cast<int>(std::lround(x / track_.sleeper_spacing)); };
  for (std::size_t dof = 0; dof < structure.dof_x.size(); ++dof) {
    const int line = structure.dof_line[dof];  // the sleepers' have the numbers of their motions
    if (line < 1 || line > 3) continue;
    sleeper_[place(structure.dof_x[dof])][static_cast<std::size_t>(line) - 1] = static_cast<int>(dof);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const RailLine& rail = structure.rail[side];
    for (std::size_t n = 0; n < rail.x.size(); ++n) {
      const int i = place(rail.x[n]);
      if (std::abs(rail.x[n] - i * track_.sleeper_spacing) > 1e-6) continue;
      rail_[side][i] = {rail.dof[n][1], rail.dof[n][2], rail.dof[n][3]};
    }
  }
}

inline std::array<BallastForces::Force, 2> BallastForces::under(int i, const LinearMotion& motion) const {
  const double half = 0.5 * track_.sleeper.height, foot = track_.rail.height - track_.rail.head_height;
  double aside = 0.0, down = 0.0, moment = 0.0;  // on the sleeper, about its centre
  for (std::size_t side = 0; side < 2; ++side) {
    const double y = side == 0 ? -track_.half_rail_distance : track_.half_rail_distance;
    const auto between = [&](const Eigen::VectorXd& of) {
      return at(0.0, foot, pick(rail_[side].at(i), of)) - at(y, -half, pick(sleeper_.at(i), of));
    };
    const Motion e = between(motion.displacement), rate = between(motion.velocity);
    const double side_force = track_.pad.ky * e.y + track_.pad.cy * rate.y;
    const double force = track_.pad.kz * e.z + track_.pad.cz * rate.z;
    aside += side_force;
    down += force;
    moment += y * force + half * side_force + track_.pad_roll_stiffness * e.roll + track_.pad_roll_damping * rate.roll;
  }
  const Motion acceleration = pick(sleeper_.at(i), motion.acceleration);
  aside -= track_.sleeper.mass * acceleration.y;
  down -= track_.sleeper.mass * acceleration.z;
  moment += half * aside - track_.sleeper.Jx * acceleration.roll;  // the ballast's side force stands `half` below
  const double difference = moment / track_.half_ballast_distance;
  return {Force{0.5 * aside, 0.5 * (down - difference)}, Force{0.5 * aside, 0.5 * (down + difference)}};
}

}  // namespace railtab
