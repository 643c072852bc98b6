#include "railtab/runtime/contact/loaded_wheel.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dual.hpp"
#include "railtab/runtime/contact/contact_pair.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/wheel_kinematics.hpp"

namespace railtab {

namespace {

template <class T>
using Vector = std::array<T, 3>;
template <class T>
using Generalised = std::array<T, 9>;

double number(double x) { return x; }
double number(const Dual& x) { return x.value; }

// A quantity of the table at a pose that moves: to first order from where it was looked up.
double moved(double value, const std::array<double, 4>&, const std::array<double, 4>&) { return value; }
Dual moved(double value, const std::array<double, 4>& slope, const std::array<Dual, 4>& pose) {
  Dual result(value);
  for (std::size_t i = 0; i < Dual::packs; ++i) {
    result.slope[i] = slope[0] * pose[0].slope[i] + slope[1] * pose[1].slope[i] + slope[2] * pose[2].slope[i] +
                      slope[3] * pose[3].slope[i];
  }
  return result;
}

std::array<double, 4> row(const Eigen::Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }

// Normalised creep force (F_x, F_y, M_z).
std::array<double, 3> creep(const CreepLaw& law, double ratio, const std::array<double, 3>& c) {
  const CreepForce f = creep_force(law, ratio, {c[0], c[1], c[2]});
  return {f.x, f.y, f.moment};
}
std::array<Dual, 3> creep(const CreepLaw& law, const Dual& ratio, const std::array<Dual, 3>& c) {
  const CreepForceJet jet = creep_force_jet(law, ratio.value, {c[0].value, c[1].value, c[2].value});
  std::array<Dual, 3> f{Dual(jet.force.x), Dual(jet.force.y), Dual(jet.force.moment)};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::array<double, 4>& d = jet.derivative[k];
    for (std::size_t i = 0; i < Dual::packs; ++i) {
      f[k].slope[i] = d[0] * ratio.slope[i] + d[1] * c[0].slope[i] + d[2] * c[1].slope[i] + d[3] * c[2].slope[i];
    }
  }
  return f;
}

/// On the wheel, moment about the wheelset centre, in rail-head axes.
template <class T>
struct Wrench {
  Vector<T> force, moment;
};

/// A part of the contact that bears load, or several as one.
template <class T>
struct Part {
  T normal = T(0.0);       ///< with damping [N]
  Vector<T> arm;           ///< [m]
  T cos_angle, sin_angle;  ///< of the contact angle
  T a, b, s;               ///< ellipse and place across the rail [m]
  T peak, saddle;          ///< LoadedPart
};

template <class T>
class LoadedContactForce {
 public:
  /// @param rail_friction RailHeadMotion::friction
  /// @param slopes of the look-up, where T has derivatives
  LoadedContactForce(const WheelContactModel& model, double rail_friction, const WheelKinematics<T>& wheel,
                     const LoadedLookup& lookup, const LoadedSlopes* slopes = nullptr)
      : model_(model),
        friction_(model.friction * rail_friction),
        wheel_(wheel),
        lookup_(lookup),
        slopes_(slopes),
        pose_{wheel.y, wheel.z, wheel.roll, wheel.yaw} {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const auto k = static_cast<std::size_t>(j);
      force_[k] = slopes ? moved(lookup.force[j], row(slopes->stiffness.col(j)), pose_) : T(lookup.force[j]);
    }
    energy_ = slopes ? moved(lookup.energy, row(lookup.force), pose_) : T(lookup.energy);
    if (lookup.energy > 0.0) add_parts();
  }

  /// Derivative of the energy (LoadedLookup::force) and the energy.
  [[nodiscard]] const std::array<T, 4>& elastic() const { return force_; }
  [[nodiscard]] const T& energy() const { return energy_; }
  [[nodiscard]] const std::array<T, 4>& pose() const { return pose_; }
  /// Creep and damping forces, generalised.
  [[nodiscard]] Generalised<T> rest() const { return wheel_.generalised(rest_.force, rest_.moment); }
  /// All forces at the pose, generalised.
  [[nodiscard]] Generalised<T> total() const {
    Wrench<T> sum = wrench(force_);
    for (std::size_t i = 0; i < 3; ++i) {
      sum.force[i] += rest_.force[i];
      sum.moment[i] += rest_.moment[i];
    }
    return wheel_.generalised(sum.force, sum.moment);
  }
  [[nodiscard]] const std::array<double, LoadedLookup::capacity>& part_normal() const { return part_normal_; }
  [[nodiscard]] int outside_creep_table() const { return outside_; }

  /// Elastic forces as generalised forces on wheelset and rail.
  [[nodiscard]] Generalised<T> generalised(const std::array<T, 4>& on_rail) const {
    const Wrench<T> w = wrench(on_rail);
    return wheel_.generalised(w.force, w.moment);
  }

 private:
  // On the wheel. The moment of the normal forces about the axle is zero.
  [[nodiscard]] Wrench<T> wrench(const std::array<T, 4>& on_rail) const {
    const T moment_x = -on_rail[2], moment_up = -on_rail[3], moment_y = wheel_.sin_yaw / wheel_.cos_yaw * moment_x;
    const T &c = wheel_.cos_roll, &s = wheel_.sin_roll;
    return {{T(0.0), -on_rail[0], -on_rail[1]}, {moment_x, c * moment_y - s * moment_up, s * moment_y + c * moment_up}};
  }

  void add_parts() {
    using std::cos, std::sin;
    std::array<Part<T>, LoadedLookup::capacity> parts;
    for (std::size_t p = 0; p < lookup_.parts; ++p) {
      Part<T>& part = parts[p];
      const auto quantity = [&](double LoadedPart::*member) {
        if (!slopes_) return T(lookup_.part[p].*member);
        const std::array<LoadedPart, 4>& d = slopes_->part[p];
        return moved(lookup_.part[p].*member, {d[0].*member, d[1].*member, d[2].*member, d[3].*member}, pose_);
      };
      const T angle = quantity(&LoadedPart::angle);
      part.cos_angle = cos(angle);
      part.sin_angle = sin(angle);
      part.arm = {quantity(&LoadedPart::arm_x), quantity(&LoadedPart::arm_y), quantity(&LoadedPart::arm_z)};
      part.a = quantity(&LoadedPart::a);
      part.b = quantity(&LoadedPart::b);
      part.s = quantity(&LoadedPart::s_rail);
      part.peak = quantity(&LoadedPart::peak);
      part.saddle = quantity(&LoadedPart::saddle);
      const T elastic = quantity(&LoadedPart::share) * force_[1] / part.cos_angle;
      part.normal = elastic;
      if (model_.damping != 0.0) add_damping(elastic, part);
      part_normal_[p] = number(part.normal);
    }
    if (friction_ > 0.0) add_groups(parts);
  }

  void add_damping(const T& elastic, Part<T>& part) {
    const Vector<T> slip = wheel_.slip_velocity(part.arm);
    const T approach = part.cos_angle * slip[2] - part.sin_angle * slip[1];
    part.normal = elastic * (1.0 + model_.damping * approach);
    if (number(part.normal) < 0.0) part.normal = T(0.0);
    const T more = part.normal - elastic;
    const Vector<T> force{T(0.0), more * part.sin_angle, -more * part.cos_angle};
    add(force, part.arm, Vector<T>{T(0.0), T(0.0), T(0.0)}, T(1.0));
  }

  // Every run of neighbouring parts, as one ellipse, weighted with how far its parts have merged with each other, and
  // not with those outside.
  void add_groups(const std::array<Part<T>, LoadedLookup::capacity>& parts) {
    const std::size_t n = lookup_.parts;
    std::array<T, LoadedLookup::capacity + 1> merged;  // between parts k − 1 and k
    for (std::size_t k = 0; k <= n; ++k) merged[k] = k == 0 || k == n ? T(0.0) : merging(parts, k);
    for (std::size_t first = 0; first < n; ++first) {
      T within = T(1.0);
      for (std::size_t last = first; last < n; ++last) {
        if (last > first) within = T(within * merged[last]);
        if (number(within) == 0.0) break;
        const T weight = within * (1.0 - merged[first]) * (1.0 - merged[last + 1]);
        if (number(weight) > 0.0) add_creep(together(parts, first, last), weight);
      }
    }
  }

  // The force per length at the saddle over the lesser of the largest on both sides, 0 to 1.
  T merging(const std::array<Part<T>, LoadedLookup::capacity>& parts, std::size_t k) const {
    std::size_t below = 0, above = k;
    for (std::size_t p = 1; p < k; ++p)
      if (number(parts[p].peak) > number(parts[below].peak)) below = p;
    for (std::size_t p = k + 1; p < lookup_.parts; ++p)
      if (number(parts[p].peak) > number(parts[above].peak)) above = p;
    const T& lesser = number(parts[below].peak) < number(parts[above].peak) ? parts[below].peak : parts[above].peak;
    const T ratio = parts[k - 1].saddle / lesser;
    return number(ratio) >= 1.0 ? T(1.0) : ratio;
  }

  static Part<T> together(const std::array<Part<T>, LoadedLookup::capacity>& parts, std::size_t first,
                          std::size_t last) {
    using std::sqrt;
    if (first == last) return parts[first];
    Part<T> sum;
    sum.arm.fill(T(0.0));
    T s = T(0.0), aa = T(0.0), bb = T(0.0), along = T(0.0), across = T(0.0);
    for (std::size_t p = first; p <= last; ++p) {
      const T& N = parts[p].normal;
      sum.normal += N;
      for (std::size_t i = 0; i < 3; ++i) sum.arm[i] += N * parts[p].arm[i];
      s += N * parts[p].s;
      aa += N * parts[p].a * parts[p].a;
      along += N * parts[p].cos_angle;
      across += N * parts[p].sin_angle;
    }
    sum.s = s / sum.normal;
    for (std::size_t p = first; p <= last; ++p) {
      const T distance = parts[p].s - sum.s;
      bb += parts[p].normal * (parts[p].b * parts[p].b + 5.0 * distance * distance);
    }
    for (std::size_t i = 0; i < 3; ++i) sum.arm[i] = sum.arm[i] / sum.normal;
    sum.a = sqrt(aa / sum.normal);
    sum.b = sqrt(bb / sum.normal);
    const T length = sqrt(along * along + across * across);
    sum.cos_angle = along / length;
    sum.sin_angle = across / length;
    return sum;
  }

  void add_creep(const Part<T>& part, const T& weight) {
    using std::sqrt;
    if (!(number(part.normal) > 0.0)) return;
    const Vector<T> slip = wheel_.slip_velocity(part.arm);
    const double speed = model_.creepage_speed() / model_.friction_law.initial_slope;
    const T slip_across = part.cos_angle * slip[1] + part.sin_angle * slip[2], root = sqrt(part.a * part.b);
    T bound = friction_ * part.normal;
    if (model_.friction_law.falls()) {
      constexpr double least = 1e-12;  // m²/s²: a root has no slope at zero
      bound = bound * model_.friction_law.share(sqrt(slip[0] * slip[0] + slip_across * slip_across + T(least)));
    }
    const T scale = model_.normal.material.shear_modulus() * part.a * part.b / (bound * speed);
    const std::array<T, 3> creepage{
        slip[0] * scale, slip_across * scale,
        (part.cos_angle * wheel_.rotation[2] - part.sin_angle * wheel_.rotation[1]) * scale * root};
    const T ratio = part.a / part.b;
    const std::array<T, 3> f = creep(model_.creep_law, ratio, creepage);
    const auto* table = std::get_if<TableCreep>(&model_.creep_law);
    if (table && table->share(number(ratio), {number(creepage[0]), number(creepage[1]), number(creepage[2])}) < 1.0) {
      ++outside_;
    }
    const T across = f[1] * bound, spin = f[2] * bound * root;
    const Vector<T> force{f[0] * bound, across * part.cos_angle, across * part.sin_angle};
    const Vector<T> moment{T(0.0), -spin * part.sin_angle, spin * part.cos_angle};
    add(force, part.arm, moment, weight);
  }

  // A force on the wheel at `arm`, and a moment.
  void add(const Vector<T>& force, const Vector<T>& arm, const Vector<T>& own, const T& weight) {
    const Vector<T> moment{own[0] + arm[1] * force[2] - arm[2] * force[1],
                           own[1] + arm[2] * force[0] - arm[0] * force[2],
                           own[2] + arm[0] * force[1] - arm[1] * force[0]};
    for (std::size_t i = 0; i < 3; ++i) {
      rest_.force[i] += weight * force[i];
      rest_.moment[i] += weight * moment[i];
    }
  }

  const WheelContactModel& model_;
  double friction_;  // without slip
  const WheelKinematics<T>& wheel_;
  const LoadedLookup& lookup_;
  const LoadedSlopes* slopes_;
  std::array<T, 4> pose_, force_;
  T energy_;
  Wrench<T> rest_{};
  std::array<double, LoadedLookup::capacity> part_normal_{};
  int outside_ = 0;
};

template <class T>
WheelMotions<T> on_right(WheelSide side, const WheelsetMotion& wheelset, const RailHeadMotion& rail) {
  WheelMotions<T> motions = WheelMotions<T>::of(wheelset, rail);
  if (side == WheelSide::left) motions.reflect();
  return motions;
}

Vector9 in_track(WheelSide side, Generalised<double> force) {
  if (side == WheelSide::left) reflect_force(force);
  return Eigen::Map<const Vector9>(force.data());
}

/// Mean over a step, of the right wheel.
template <class T>
Generalised<T> mean_over_step(const WheelRailPair& pair, const LoadedMemory& start, const LoadedContactForce<T>& end,
                              double weight) {
  const double radius = pair.nominal_radius();
  const std::array<double, 4> metric{1.0, 1.0, radius * radius, radius * radius};
  const std::array<double, 4> from{start.pose.y, start.pose.z, start.pose.roll, start.pose.yaw};
  std::array<T, 4> mean, path;
  T work = weight * end.energy() - start.weight * start.energy, length = T(0.0);
  for (std::size_t j = 0; j < 4; ++j) {
    path[j] = end.pose()[j] - from[j];
    mean[j] = 0.5 * (start.weight * start.force[static_cast<Eigen::Index>(j)] + weight * end.elastic()[j]);
    work -= mean[j] * path[j];
    length += metric[j] * path[j] * path[j];
  }
  const T ends = mean[0] * mean[0] + mean[1] * mean[1];
  T share = T(1.0);
  if (number(length) > 0.0) {
    T along = T(0.0);
    for (std::size_t j = 0; j < 4; ++j) {
      const T more = work / length * metric[j] * path[j];
      if (j < 2) along += more * mean[j];
      mean[j] += more;
    }
    if (number(ends) > 0.0) share += along / ends;
  }
  Generalised<T> result = end.generalised(mean);
  const Generalised<T> rest = end.rest();
  for (std::size_t i = 0; i < 9; ++i) {
    result[i] += 0.5 * share * (start.rest[static_cast<Eigen::Index>(i)] + weight * rest[i]);
  }
  return result;
}

}  // namespace

LoadedWheelForce loaded_wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                    const RailHeadMotion& rail, const LoadedLookup& lookup) noexcept {
  LoadedWheelForce result;
  const WheelKinematics<double> wheel(model.geometry->pair(), on_right<double>(side, wheelset, rail), model.speed);
  const LoadedContactForce<double> force(model, rail.friction, wheel, lookup);
  const Vector9 total = in_track(side, force.total());
  result.wheelset = total.head<6>();
  result.rail = total.tail<3>();
  result.rail_x = -result.wheelset[0];
  std::copy_n(force.part_normal().begin(), lookup.parts, result.normal.begin());
  result.outside_creep_table = force.outside_creep_table();
  const Generalised<double> rest = force.rest();
  result.memory = {.weight = lookup.table_share,
                   .pose = {wheel.y, wheel.z, wheel.roll, wheel.yaw},
                   .energy = lookup.energy,
                   .force = lookup.force,
                   .rest = lookup.table_share * Eigen::Map<const Vector9>(rest.data()),
                   .total = lookup.table_share * total};
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
  const WheelKinematics<double> wheel(model.geometry->pair(), on_right<double>(side, wheelset, rail), model.speed);
  const LoadedContactForce<double> end(model, rail.friction, wheel, lookup);
  return in_track(side, mean_over_step(model.geometry->pair(), start, end, lookup.table_share));
}

Matrix9 loaded_wheel_tangent(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                             const RailHeadMotion& rail, const StepRates& rates, const LoadedMemory* start) noexcept {
  // Along the nine displacements, which velocities follow.
  WheelMotions<Dual> motions = WheelMotions<Dual>::of(wheelset, rail);
  const auto seed = [](std::size_t direction, double rate, Dual& displacement, Dual& velocity) {
    displacement.slope[direction / 4][direction % 4] = 1.0;
    velocity.slope[direction / 4][direction % 4] = rate;
  };
  for (std::size_t i = 0; i < 6; ++i)
    seed(i, rates.wheelset[static_cast<Eigen::Index>(i)], motions.displacement[i], motions.velocity[i]);
  for (std::size_t i = 0; i < 3; ++i) seed(6 + i, rates.rail, motions.rail[i], motions.rail_velocity[i]);
  if (side == WheelSide::left) motions.reflect();
  const WheelKinematics<Dual> wheel(model.geometry->pair(), motions, model.speed);
  LoadedSlopes slopes;
  const LoadedLookup lookup =
      model.geometry->loaded()->lookup(wheel.y.value, wheel.z.value, wheel.roll.value, wheel.yaw.value, slopes);
  const bool touches = lookup.energy > 0.0;
  if (!touches && !start) return Matrix9::Zero();
  const LoadedContactForce<Dual> force(model, rail.friction, wheel, lookup, touches ? &slopes : nullptr);
  Generalised<Dual> total;
  if (start) {
    total = mean_over_step(model.geometry->pair(), *start, force, lookup.table_share);
  } else {
    total = force.total();
  }
  if (side == WheelSide::left) reflect_force(total);
  Matrix9 tangent;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      tangent(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = total[i].slope[j / 4][j % 4];
  return tangent;
}

}  // namespace railtab
