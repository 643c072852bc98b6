#include "railtab/runtime/contact/loaded_wheel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>

#include "railtab/runtime/base/dual.hpp"
#include "railtab/runtime/base/lane_transpose.hpp"
#include "railtab/runtime/contact/contact_pair.hpp"
#include "railtab/runtime/contact/loaded_contact_force.hpp"
#include "railtab/runtime/contact/reflection.hpp"
#include "railtab/runtime/contact/wheel_kinematics.hpp"

namespace railtab {

namespace {

using loaded_detail::constant;
using loaded_detail::Generalised;
using loaded_detail::LoadedContactForce;
using loaded_detail::MotionSlope;
using loaded_detail::Number;
using loaded_detail::number;
using loaded_detail::Pose;
using loaded_detail::pose_directions;
using loaded_detail::slope_along;
using loaded_detail::Wrench;

/// −1 of a left wheel, which is computed as a right one.
double mirror_of(WheelSide side) { return side == WheelSide::left ? -1.0 : 1.0; }

/// Of right wheels to the wheels as they are. @param mirror mirror_of() them
template <class V>
Generalised<V> in_track(Generalised<V> force, const V& mirror) {
  for (std::size_t i = 0; i < force.size(); ++i)
    if (changes_sign[i]) force[i] = mirror * force[i];
  return force;
}

/// Mean force over a step, of the right wheel: what depends on the end of the step, and the share of the creep forces
/// at its start.
template <class T>
struct MeanForce {
  Wrench<T> end;
  T of_start;
};

template <class T>
MeanForce<T> mean_over_step(const WheelRailPair& pair, const LoadedMemory& start, const LoadedContactForce<T>& end,
                            double weight) {
  const double radius = pair.nominal_radius();
  const Pose<double> metric{1.0, 1.0, radius * radius, radius * radius};
  const Pose<double> from{start.pose.y, start.pose.z, start.pose.roll, start.pose.yaw};
  std::array<T, 4> mean, path;
  T work = end.energy() - start.energy, length = constant<T>(0.0);
  for (std::size_t j = 0; j < 4; ++j) {
    const double before = start.force[static_cast<Eigen::Index>(j)];
    path[j] = end.pose()[j] - from[j];
    mean[j] = 0.5 * (start.weight * before + weight * end.elastic()[j]);
    work -= 0.5 * (before + end.elastic()[j]) * path[j];
    length += metric[j] * path[j] * path[j];
  }
  // The energy is that of the table alone: a step into its margin or out of it has no gradient.
  work = start.weight * weight * work;
  const T ends = mean[0] * mean[0] + mean[1] * mean[1];
  T share = constant<T>(1.0);
  if (number(length) > 0.0) {
    T along = constant<T>(0.0);
    const T correction = work / length;
    for (std::size_t j = 0; j < 4; ++j) {
      const T more = metric[j] * correction * path[j];
      if (j < 2) along += more * mean[j];
      mean[j] += more;
    }
    if (number(ends) > 0.0) share += along / ends;
  }
  MeanForce<T> result{end.wrench(mean), 0.5 * share};
  result.end.add(end.rest(), weight * result.of_start);
  return result;
}

/// Derivatives with respect to the nine displacements, which velocities follow.
template <class V>
class DisplacementSlopes {
 public:
  using Column = Generalised<V>;
  DisplacementSlopes(const WheelKinematics<V>& wheel, const StepRates& rates) : w_(wheel), rates_(rates) {}

  /// @param pose derivatives of the generalised forces with respect to the pose. @param motion with respect to the
  /// wheel's motion. @param turned of those that turn with the rail, their values
  [[nodiscard]] std::array<Column, 9> of(const std::array<Column, 4>& pose, const std::array<Column, 7>& motion,
                                         const Column& turned) const {
    const V &c = w_.rail_cos, &s = w_.rail_sin;
    const double rail = rates_.rail;
    const Vector6& rate = rates_.wheelset;
    const auto &axle = w_.axle, &velocity = w_.velocity, &swaying = w_.swaying;
    // rotations: the axle turns with roll and yaw
    const V roll_y = -(w_.turning * axle[2]), roll_z = w_.turning * axle[1];
    const V yaw_x = -(w_.turning * w_.cos_yaw), turned_yaw = -(w_.turning * w_.sin_yaw);
    const V yaw_y = turned_yaw * w_.cos_roll, yaw_z = turned_yaw * w_.sin_roll;
    std::array<Column, 9> t;
    for (std::size_t i = 0; i < 9; ++i) {
      const auto m = [&](std::size_t k) -> const V& { return motion[k][i]; };
      const auto p = [&](std::size_t k) -> const V& { return pose[k][i]; };
      // along the track's y and z
      const V pose_y = c * p(0) - s * p(1), pose_z = s * p(0) + c * p(1);
      const V motion_y = c * m(1) - s * m(2), motion_z = s * m(1) + c * m(2);
      t[0][i] = rate[0] * m(0);
      t[1][i] = pose_y + rate[1] * motion_y;
      t[2][i] = pose_z + rate[2] * motion_z;
      t[6][i] = -(pose_y + rail * motion_y);
      t[7][i] = -(pose_z + rail * motion_z);
      const V roll = p(2) + roll_y * m(4) + roll_z * m(5);
      t[3][i] = roll + rate[3] * m(3);
      t[4][i] = rate[4] * (axle[0] * m(3) + axle[1] * m(4) + axle[2] * m(5));
      t[5][i] = p(3) + yaw_x * m(3) + yaw_y * m(4) + yaw_z * m(5) + rate[5] * (s * m(4) + c * m(5));
      t[8][i] = w_.centre_z * p(0) - w_.centre_y * p(1) - roll + rail * (m(6) - m(3)) + velocity[2] * m(1) -
                velocity[1] * m(2) + swaying[2] * m(4) - swaying[1] * m(5) + turned[i];
    }
    return t;
  }

 private:
  const WheelKinematics<V>& w_;
  const StepRates& rates_;
};

/// Numbers of every wheel one after the other.
template <class V, std::size_t count>
struct Apart {
  std::array<std::array<double, count>, lanes_of<V>> of;

  explicit Apart(const std::array<V, count>& numbers) {
    std::array<double*, lanes_of<V>> to;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = of[i].data();
    set_apart(numbers.data(), count, to);
  }
};

/// Forces of wheels, each of which takes its own.
template <class T>
class WheelForces {
 public:
  using V = Number<T>;
  /// @param mirror mirror_of() the wheels
  WheelForces(const LoadedContactForce<T>& force, const V& mirror, const LoadedLookupOf<V>& lookup)
      : force_(force),
        total_(in_track(force.generalised(numbers(force.total())), mirror)),
        rest_(force.generalised(numbers(force.rest()))),
        others_({force.creep_power(), lookup.largest_pressure()}) {}

  /// @param pose, table of the same wheel
  void give(int place, const WheelsetPose& pose, const LoadedLookup& table, LoadedWheelForce& result) const {
    const auto at = static_cast<std::size_t>(place);
    const Vector9 total = Vector9::Map(total_.of[at].data());
    result.wheelset = total.head<6>();
    result.rail = total.tail<3>();
    result.rail_x = -result.wheelset[0];
    result.normal.fill(0.0);
    for (std::size_t p = 0; p < table.parts; ++p) result.normal[p] = lane(force_.part_normal()[p], place);
    result.outside_creep_table = force_.outside_creep_table(place);
    result.creep_power = others_.of[at][0];
    result.pressure = others_.of[at][1];
    result.memory = {.weight = table.table_share,
                     .pose = pose,
                     .energy = table.energy,
                     .force = table.force,
                     .rest = table.table_share * Vector9::Map(rest_.of[at].data()),
                     .total = table.table_share * total};
  }

 private:
  const LoadedContactForce<T>& force_;
  Apart<V, 9> total_, rest_;  ///< total: in track axes
  Apart<V, 2> others_;        ///< creep power, largest pressure
};

/// Of right wheels, by columns.
template <class T>
std::array<Generalised<Number<T>>, 9> tangent_of(const LoadedContactForce<T>& force,
                                                 const WheelKinematics<Number<T>>& wheel, const StepRates& rates,
                                                 const Generalised<T>& total, const Wrench<T>& turning,
                                                 const Number<T>& of_motion) {
  using V = Number<T>;
  const V &c = wheel.rail_cos, &s = wheel.rail_sin, zero{};
  const auto &f = turning.force, &m = turning.moment;
  const V fy = c * number(f[1]) - s * number(f[2]), fz = s * number(f[1]) + c * number(f[2]);
  const Generalised<V> turned{zero, -fz, fy, zero, zero, c * number(m[1]) - s * number(m[2]), fz, -fy, zero};
  std::array<Generalised<V>, 4> pose;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 9; ++i) pose[j][i] = slope_along(total[i], j);
  // As LoadedContactForce::generalised().
  std::array<Generalised<V>, 7> motion;
  const MotionSlope<V>& w = force.motion_slope();
  for (std::size_t k = 0; k < 7; ++k) {
    const auto of = [&](std::size_t row) { return of_motion * w[row][k]; };
    const V x = of(0), y = of(1), z = of(2), about_x = of(3), about_y = of(4), about_z = of(5);
    const V across = c * y - s * z, down = s * y + c * z;
    motion[k] = {x,
                 across,
                 down,
                 about_x,
                 wheel.axle[0] * about_x + wheel.axle[1] * about_y + wheel.axle[2] * about_z,
                 s * about_y + c * about_z,
                 -across,
                 -down,
                 -(about_x + wheel.centre_y * z - wheel.centre_z * y)};
  }
  return DisplacementSlopes<V>(wheel, rates).of(pose, motion, turned);
}

/// Tangents of wheels in track axes. @param of_right by columns, is overwritten @param to of each wheel, room for a
/// Matrix9
template <class V>
void set_tangents(std::array<Generalised<V>, 9>& of_right, const V& mirror,
                  const std::array<double*, lanes_of<V>>& to) {
  for (std::size_t j = 0; j < 9; ++j)
    for (std::size_t i = 0; i < 9; ++i)
      if (changes_sign[i] != changes_sign[j]) of_right[j][i] = mirror * of_right[j][i];
  set_apart(of_right[0].data(), 81, to);
}

template <class T>
LoadedWheelResponse response_of(const LoadedContactForce<T>& force, const WheelContactModel& model, WheelSide side,
                                const WheelKinematics<double>& wheel, const LoadedLookup& lookup,
                                const StepRates& rates, const LoadedMemory* start) {
  Wrench<T> sum = force.total();
  Generalised<T> total = force.generalised(sum);
  double of_motion = 1.0;
  if (start) {
    const MeanForce<T> mean = mean_over_step(model.geometry->pair(), *start, force, lookup.table_share);
    sum = mean.end;
    total = force.generalised(sum);
    for (std::size_t i = 0; i < 9; ++i) total[i] += start->rest[static_cast<Eigen::Index>(i)] * mean.of_start;
    of_motion = lookup.table_share * number(mean.of_start);
  }
  LoadedWheelResponse response;
  const double mirror = mirror_of(side);
  WheelForces<T>(force, mirror, lookup).give(0, wheel.pose(), lookup, response.force);
  std::array<Generalised<Number<T>>, 9> of_right = tangent_of(force, wheel, rates, total, sum, of_motion);
  set_tangents(of_right, mirror, {response.tangent.data()});
  return response;
}

}  // namespace

LoadedWheelForce loaded_wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                    const RailHeadMotion& rail, const LoadedLookup& lookup) noexcept {
  const WheelKinematics<double> wheel = right_wheel(model.geometry->pair(), side, wheelset, rail, model.speed);
  const LoadedContactForce<double> force(model, rail.friction, wheel, lookup, nullptr);
  LoadedWheelForce result;
  WheelForces<double>(force, mirror_of(side), lookup).give(0, wheel.pose(), lookup, result);
  return result;
}

ContactPatches loaded_patches(const WheelRailPair& pair, const WheelsetPose& pose,
                              const LoadedLookup& lookup) noexcept {
  ContactPatches patches;
  if (!(lookup.energy > 0.0)) return patches;
  const PoseTrigonometry trigonometry(pose);
  const double approach = 2.5 * lookup.energy / lookup.force.head<2>().norm();
  for (std::size_t p = 0; p < lookup.parts; ++p) {
    const LoadedPart& part = lookup.part[p];
    ContactPatch& patch = patches.patch[p];
    patch = patch_of_pair(pair, pose, trigonometry, {part.s_wheel, part.s_rail});
    patch.x = part.arm_x;
    patch.angle = part.angle;
    patch.penetration = approach;
    patch.source = PatchSource::table;
    ++patches.count;
  }
  return patches;
}

Vector9 loaded_mean_force(const WheelContactModel& model, WheelSide side, const LoadedMemory& start,
                          const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                          const LoadedLookup& lookup) noexcept {
  const WheelKinematics<double> wheel = right_wheel(model.geometry->pair(), side, wheelset, rail, model.speed);
  const LoadedContactForce<double> end(model, rail.friction, wheel, lookup, nullptr);
  const MeanForce<double> mean = mean_over_step(model.geometry->pair(), start, end, lookup.table_share);
  Generalised<double> force = end.generalised(mean.end);
  for (std::size_t i = 0; i < 9; ++i) force[i] += mean.of_start * start.rest[static_cast<Eigen::Index>(i)];
  return Vector9::Map(in_track(force, mirror_of(side)).data());
}

LoadedWheelResponse loaded_wheel_response(const WheelContactModel& model, WheelSide side,
                                          const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                          const LoadedLookup& lookup, const LoadedSlopes& slopes,
                                          const StepRates& rates, const LoadedMemory* start) noexcept {
  constexpr std::size_t normal_packs = (LoadedLookup::capacity + 3) / 4;
  const WheelKinematics<double> wheel = right_wheel(model.geometry->pair(), side, wheelset, rail, model.speed);
  const auto response = [&]<std::size_t packs>() {
    const LoadedContactForce<Dual<packs>> force(model, rail.friction, wheel, lookup, &slopes);
    return response_of(force, model, side, wheel, lookup, rates, start);
  };
  return model.damping != 0.0 ? response.operator()<1 + normal_packs>() : response.operator()<1>();
}

namespace {

WheelLanes mirror_of(std::span<const WheelState> wheels) {
  WheelLanes mirror = broadcast<WheelLanes>(1.0);
  for (std::size_t i = 0; i < wheels.size(); ++i) mirror[static_cast<int>(i)] = mirror_of(wheels[i].side);
  return mirror;
}

/// Wheels side by side at their loaded contacts.
template <bool slopes>
struct WheelsSideBySide {
  WheelMotion<WheelLanes> motion;
  std::optional<WheelKinematics<WheelLanes>> wheel;
  LoadedLookupOf<WheelLanes> lookup;
  LoadedSlopesOf<WheelLanes> derivatives;
  std::uint32_t answered = 0;  ///< bit by bit, by the table alone and with friction

  WheelsSideBySide(const WheelContactModel& model, std::span<const WheelState> wheels) {
    assert(computes_side_by_side(model));
    assert(!wheels.empty() && wheels.size() <= WheelLanes::count);
    for (std::size_t i = 0; i < WheelLanes::count; ++i) {
      const WheelState& of = wheels[std::min(i, wheels.size() - 1)];
      motion.set(static_cast<int>(i), on_right(of.side, of.wheelset), on_right(of.side, of.rail));
    }
    wheel.emplace(model.geometry->pair(), motion, model.speed);
    const LoadedPoseOf<WheelLanes> pose{wheel->y, wheel->z, wheel->roll, wheel->yaw};
    model.geometry->loaded()->find<slopes, WheelLanes>(pose, lookup, slopes ? &derivatives : nullptr);
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const auto at = static_cast<int>(i);
      const bool alone = lookup.table_share[at] == 1.0 && lookup.energy[at] > 0.0 && motion.friction[at] > 0.0;
      answered |= static_cast<std::uint32_t>(alone) << i;
    }
  }

  /// Poses, look-ups and forces of the wheels that are answered.
  template <class T>
  void give(const LoadedContactForce<T>& force, const WheelLanes& mirror, std::span<const LoadedAnswer> to) const {
    const WheelForces<T> forces(force, mirror, lookup);
    const auto& f = lookup.force;
    const Apart<WheelLanes, 10> numbers(
        {wheel->y, wheel->z, wheel->roll, wheel->yaw, lookup.table_share, lookup.energy, f[0], f[1], f[2], f[3]});
    visit_answered([&](std::size_t i) {
      const std::array<double, 10>& of = numbers.of[i];
      *to[i].pose = {of[0], of[1], of[2], of[3]};
      to[i].lookup->table_share = of[4];
      to[i].lookup->energy = of[5];
      to[i].lookup->force = {of[6], of[7], of[8], of[9]};
      to[i].lookup->parts = 0;
    });
    for (std::size_t p = 0; p < lookup.parts; ++p) {
      const Apart<WheelLanes, LoadedPart::quantities> part(lookup.part[p].values());
      visit_answered([&](std::size_t i) {
        LoadedLookup& result = *to[i].lookup;
        if (result.parts == p && part.of[i][0] > 0.0) result.part[result.parts++] = LoadedPart::of(part.of[i]);
      });
    }
    visit_answered([&](std::size_t i) { forces.give(static_cast<int>(i), *to[i].pose, *to[i].lookup, *to[i].force); });
  }

  void visit_answered(auto&& visit) const {
    for (std::uint32_t left = answered; left != 0; left &= left - 1) {
      visit(static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
};

}  // namespace

bool computes_side_by_side(const WheelContactModel& model) noexcept {
  return model.geometry->loaded() && model.damping == 0.0 && !model.friction_law.falls();
}

std::uint32_t loaded_wheel_forces(const WheelContactModel& model, std::span<const WheelState> wheels,
                                  std::span<const LoadedAnswer> to) noexcept {
  const WheelsSideBySide<false> side_by_side(model, wheels);
  if (side_by_side.answered == 0) return 0;
  const LoadedContactForce<WheelLanes> force(model, side_by_side.motion.friction, *side_by_side.wheel,
                                             side_by_side.lookup, nullptr);
  side_by_side.give(force, mirror_of(wheels), to);
  return side_by_side.answered;
}

std::uint32_t loaded_wheel_responses(const WheelContactModel& model, std::span<const WheelState> wheels,
                                     const StepRates& rates, std::span<const LoadedAnswer> to) noexcept {
  assert(!rates.start);
  const WheelsSideBySide<true> side_by_side(model, wheels);
  if (side_by_side.answered == 0) return 0;
  using T = DualLanes<pose_directions>;
  const WheelKinematics<WheelLanes>& wheel = *side_by_side.wheel;
  const LoadedContactForce<T> force(model, side_by_side.motion.friction, wheel, side_by_side.lookup,
                                    &side_by_side.derivatives);
  const Wrench<T> sum = force.total();
  const WheelLanes mirror = mirror_of(wheels);
  side_by_side.give(force, mirror, to);
  std::array<double, 81> unanswered;
  std::array<double*, WheelLanes::count> tangent;
  tangent.fill(unanswered.data());
  side_by_side.visit_answered([&](std::size_t i) { tangent[i] = to[i].tangent->data(); });
  std::array<Generalised<WheelLanes>, 9> of_right =
      tangent_of(force, wheel, rates, force.generalised(sum), sum, broadcast<WheelLanes>(1.0));
  set_tangents(of_right, mirror, tangent);
  return side_by_side.answered;
}

}  // namespace railtab
