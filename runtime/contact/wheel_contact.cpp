#include "railtab/runtime/contact/wheel_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/mean_force.hpp"
#include "railtab/runtime/contact/reflection.hpp"
#include "railtab/runtime/contact/wheel_kinematics.hpp"

namespace railtab {

namespace {

Vector3 vector(const std::array<double, 3>& v) { return Vector3::Map(v.data()); }

struct PatchForce {
  Vector3 force, moment;     // on the wheel, in rail-head axes, moment about the wheelset centre
  double normal;             // [N]
  double creep_power = 0.0;  // [W]
  double pressure = 0.0;     // [Pa]
  bool outside_creep_table = false;
};

// How a wheelset moves against the rail, in rail-head axes, and the coefficient of friction without slip.
struct PatchMotion {
  Vector3 velocity, rotation;
  double friction;
};

// arm: from the wheelset centre to the contact point.
PatchForce patch_force(const WheelContactModel& model, const PatchLoad& load, const ContactAxes& axes,
                       const Vector3& arm, const PatchMotion& motion) {
  const auto& [velocity, rotation, friction] = motion;
  const double approach = (velocity + rotation.cross(arm)).dot(axes.normal);
  const double N = std::max(0.0, load.elastic_force * (1.0 + model.damping * approach));
  if (N <= 0.0) return {Vector3::Zero(), Vector3::Zero(), 0.0};

  Vector3 force = -N * axes.normal;
  if (model.gravitational_stiffness == GravitationalStiffness::neglected) force[1] = 0.0;
  PatchForce result{force, Vector3::Zero(), N};
  const auto [a, b] =
      model.constant_ellipse.value_or(PatchEllipse{load.hertz.a1 * std::cbrt(N), load.hertz.b1 * std::cbrt(N)});
  result.pressure = 1.5 * N / (std::numbers::pi * a * b);
  if (friction * N > 0.0) {
    PatchCreepage slip = patch_creepage({velocity, rotation}, arm, axes, model.creepage_speed());
    const PatchCreepage rigid = slip;
    double bound = friction * N;
    if (model.friction_law.falls()) {
      bound *= model.friction_law.share(std::hypot(slip.x, slip.y) * model.creepage_speed());
    }
    const double slope = model.friction_law.initial_slope;
    slip = {slope * slip.x, slope * slip.y, slope * slip.spin};
    const Creepage creepage = normalised_creepage(slip, a, b, model.normal.material.shear_modulus(), bound);
    const PatchCreepForce creep = dimensional_creep_force(creep_force(model.creep_law, a / b, creepage), a, b, bound);
    result.force += creep.x * Vector3::UnitX() + creep.y * axes.tangent;
    result.moment = creep.moment * axes.normal;
    result.creep_power = -model.creepage_speed() * (creep.x * rigid.x + creep.y * rigid.y + creep.moment * rigid.spin);
    const auto* table = std::get_if<TableCreep>(&model.creep_law);
    result.outside_creep_table = table && table->share(a / b, creepage) < 1.0;
  }
  result.moment += arm.cross(result.force);
  return result;
}

}  // namespace

WheelsetPose relative_pose(const WheelRailPair& pair, WheelSide side, const WheelsetMotion& wheelset,
                           const RailHeadMotion& rail) noexcept {
  constexpr double any_speed = 0.0;
  return right_wheel(pair, side, wheelset, rail, any_speed).pose();
}

WheelForce wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                       const RailHeadMotion& rail, const PatchLoads& loads) noexcept {
  WheelForce result;
  if (loads.size() == 0) return result;
  const WheelKinematics<double> wheel = right_wheel(model.geometry->pair(), side, wheelset, rail, model.speed);
  const Vector3 velocity = vector(wheel.velocity), axle = vector(wheel.axle), rotation = vector(wheel.rotation);

  for (std::size_t i = 0; i < loads.size(); ++i) {
    const ContactPatch& patch = loads[i].contact;
    const ContactAxes axes(patch.angle);
    // To the wheel's own undeformed surface, the penetration below the rail's: rolling radii are those of the wheel.
    const Vector3 arm = Vector3(patch.x, patch.y_rail - wheel.centre_y, patch.z_rail - wheel.centre_z) +
                        patch.penetration * axes.normal;
    // The rail's own roll rate moves its surface at the contact point.
    const Vector3 surface_velocity = wheel.rail_rate * Vector3(0.0, -patch.z_rail, patch.y_rail);
    // rotation × arm already counts the relative roll rate about the wheelset centre; the rail rolls about its head.
    const Vector3 centre_shift = wheel.rail_rate * Vector3(0.0, -arm[2], arm[1]);
    const PatchForce p =
        patch_force(model, loads[i], axes, arm,
                    {velocity + centre_shift - surface_velocity, rotation, model.friction * rail.friction});
    result.normal[i] = p.normal;
    result.creep_power += p.creep_power;
    result.pressure = std::max(result.pressure, p.pressure);
    result.outside_creep_table += p.outside_creep_table;
    const Vector3 spin_moment = p.moment - arm.cross(p.force);
    const double rail_moment = patch.y_rail * p.force[2] - patch.z_rail * p.force[1] + spin_moment[0];
    const Vector3 force = vector(wheel.to_track(p.force[0], p.force[1], p.force[2]));
    const Vector3 moment = vector(wheel.to_track(p.moment[0], p.moment[1], p.moment[2]));
    Vector9& share = result.patch[i];
    share << force, moment[0], p.moment.dot(axle), moment[2], -force[1], -force[2], -rail_moment;
    if (side == WheelSide::left) share = reflected(share);
    result.wheelset += share.head<6>();
    result.rail += share.tail<3>();
  }
  result.rail_x = -result.wheelset[0];
  return result;
}

WheelForce wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                       const RailHeadMotion& rail, const ContactPatches& patches) noexcept {
  const WheelsetPose pose = relative_pose(model.geometry->pair(), side, wheelset, rail);
  return wheel_force(model, side, wheelset, rail, patch_loads(model.normal, *model.geometry, pose, patches));
}

ContactPatches moved_patches(const ContactGeometry& geometry, const ContactPatches& patches, const WheelsetPose& from,
                             const WheelsetPose& to) noexcept {
  ContactPatches moved = patches;
  const WheelRailPair& pair = geometry.pair();
  const PoseTrigonometry trig(to);
  for (int i = 0; i < patches.count; ++i) {
    const ContactPatch& p = patches.patch[static_cast<std::size_t>(i)];
    ContactPatch& q = moved.patch[static_cast<std::size_t>(i)];
    if (!geometry.is_paper() || p.source == PatchSource::online_convex) {
      const RefinedPair refined = refine_pair(pair, to, trig, {p.s_wheel, p.s_rail}, {.iterations = 4});
      if (refined.status == PairStatus::converged) {
        q = refined.patch;
        continue;
      }
    }
    q.penetration += PenetrationGradient(pair, p, from).change(from, to);  // the pair frozen
  }
  return moved;
}

namespace {

// A step of a difference, so small that the creepage changes by far less than the creepage of sliding. At walking pace
// this bound lies below that of the geometry.
double difference_step(double step, double velocity_rate, double speed) {
  constexpr double creepage = 4e-6;
  return step * velocity_rate > creepage * speed ? creepage * speed / velocity_rate : step;
}

// A pose near by with its patches and loads.
struct Neighbour {
  WheelsetPose pose;
  ContactPatches patches;
  PatchLoads loads;
};

// What wheel_force() reads of a load, moved on by a share of its change towards another.
void add_change(const PatchLoad& from, const PatchLoad& to, double share, PatchLoad& load) {
  const auto move = [&](auto member) { load.*member += share * (to.*member - from.*member); };
  const auto move_contact = [&](auto member) {
    load.contact.*member += share * (to.contact.*member - from.contact.*member);
  };
  move(&PatchLoad::elastic_force);
  load.hertz.a1 += share * (to.hertz.a1 - from.hertz.a1);
  load.hertz.b1 += share * (to.hertz.b1 - from.hertz.b1);
  move_contact(&ContactPatch::x);
  move_contact(&ContactPatch::y_rail);
  move_contact(&ContactPatch::z_rail);
  move_contact(&ContactPatch::angle);
  move_contact(&ContactPatch::penetration);
}

// Loads at a pose near by, to first order from those at poses moved in y, z and roll: only relative motion counts, so a
// rail that rolls needs no overlap of its own. None where an ellipse changes beyond first order: at the edge of an
// overlap.
std::optional<PatchLoads> combined_loads(const PatchLoads& here, const WheelsetPose& from, const Neighbour& y,
                                         const Neighbour& z, const Neighbour& roll, const WheelsetPose& to) {
  const Eigen::Vector2d by_y(y.pose.y - from.y, y.pose.z - from.z);
  const Eigen::Vector2d by_z(z.pose.y - from.y, z.pose.z - from.z);
  const Eigen::Vector2d wanted(to.y - from.y, to.z - from.z);
  const double determinant = by_y[0] * by_z[1] - by_y[1] * by_z[0];
  const double share_y = (wanted[0] * by_z[1] - wanted[1] * by_z[0]) / determinant;
  const double share_z = (by_y[0] * wanted[1] - by_y[1] * wanted[0]) / determinant;
  const double share_roll = (to.roll - from.roll) / (roll.pose.roll - from.roll);
  PatchLoads loads = here;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    add_change(here[i], y.loads[i], share_y, loads[i]);
    add_change(here[i], z.loads[i], share_z, loads[i]);
    add_change(here[i], roll.loads[i], share_roll, loads[i]);
    const auto little = [](double was, double is) { return std::abs(is - was) <= 0.1 * was; };
    if (!little(here[i].hertz.a1, loads[i].hertz.a1) || !little(here[i].hertz.b1, loads[i].hertz.b1)) return {};
  }
  return loads;
}

}  // namespace

Matrix9 wheel_force_tangent(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                            const RailHeadMotion& rail, const ContactPatches& patches, const StepRates& rates,
                            double share) noexcept {
  Matrix9 tangent = Matrix9::Zero();
  if (patches.count == 0 && (!rates.start || rates.start->count == 0)) return tangent;
  const WheelRailPair& pair = model.geometry->pair();
  const WheelsetPose pose = relative_pose(pair, side, wheelset, rail);
  const auto total = [&](const WheelsetPose& at, const ContactPatches& p, const WheelForce& f) -> Vector9 {
    if (rates.start) {  // whose patches have their share already
      WheelForce end = f;
      for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) end.patch[i] *= share;
      return mean_force(pair, *rates.start, at, p, end);
    }
    Vector9 sum;
    sum << f.wheelset, f.rail;
    return share * sum;
  };
  const PatchLoads loads = patch_loads(model.normal, *model.geometry, pose, patches);
  const Vector9 here = total(pose, patches, wheel_force(model, side, wheelset, rail, loads));
  const auto difference = [&](const WheelsetMotion& w, const RailHeadMotion& r, const WheelsetPose& at,
                              const ContactPatches& p, const PatchLoads& l, double step) {
    return Vector9((total(at, p, wheel_force(model, side, w, r, l)) - here) / step);
  };
  // Steps well above the Newton tolerance of the pair and well below the penetration [m, rad].
  constexpr std::array<double, 6> steps{1e-7, 1e-8, 1e-8, 2e-8, 1e-7, 1e-7};
  std::array<Neighbour, 6> neighbour;
  for (std::size_t j = 0; j < 6; ++j) {
    const auto dof = static_cast<Eigen::Index>(j);
    const double step = difference_step(steps[j], rates.wheelset[dof], std::max(model.speed, model.speed_floor));
    WheelsetMotion perturbed = wheelset;
    perturbed.displacement[dof] += step;
    perturbed.velocity[dof] += rates.wheelset[dof] * step;
    if (j == 0 || j == 4) {  // x and pitch leave the profiles where they are
      tangent.col(dof) = difference(perturbed, rail, pose, patches, loads, step);
      continue;
    }
    Neighbour& n = neighbour[j];
    n.pose = relative_pose(pair, side, perturbed, rail);
    n.patches = moved_patches(*model.geometry, patches, pose, n.pose);
    n.loads = patch_loads(model.normal, *model.geometry, n.pose, n.patches);
    tangent.col(dof) = difference(perturbed, rail, n.pose, n.patches, n.loads, step);
  }
  // Moving the rail is moving the wheelset the other way; rolling it is a motion of its own about the rail head.
  tangent.col(6) = -tangent.col(1);
  tangent.col(7) = -tangent.col(2);
  const double roll_step = difference_step(1e-7, rates.rail, std::max(model.speed, model.speed_floor));
  RailHeadMotion rolled = rail;
  rolled.displacement[2] += roll_step;
  rolled.velocity[2] += rates.rail * roll_step;
  const WheelsetPose to = relative_pose(pair, side, wheelset, rolled);
  const ContactPatches moved = moved_patches(*model.geometry, patches, pose, to);
  const std::optional<PatchLoads> combined = combined_loads(loads, pose, neighbour[1], neighbour[2], neighbour[3], to);
  tangent.col(8) = difference(wheelset, rolled, to, moved,
                              combined ? *combined : patch_loads(model.normal, *model.geometry, to, moved), roll_step);
  return tangent;
}

}  // namespace railtab
