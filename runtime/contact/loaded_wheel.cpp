#include "railtab/runtime/contact/loaded_wheel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "railtab/runtime/base/dual.hpp"
#include "railtab/runtime/contact/contact_pair.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/reflection.hpp"
#include "railtab/runtime/contact/wheel_kinematics.hpp"

namespace railtab {

namespace {

template <class T>
using Vector = std::array<T, 3>;
template <class T>
using Generalised = std::array<T, 9>;
using Pose = std::array<double, 4>;  // y, z, roll, yaw

constexpr std::size_t pose_directions = 4;

// Of a quantity of the table with its slope along the pose, which are the first directions of dual numbers.
template <class T>
T quantity(double value, const Pose& slope) {
  T result(value);
  if constexpr (!std::is_same_v<T, double>) std::memcpy(&result.slope[0], slope.data(), sizeof slope);
  return result;
}

template <class T>
T coordinate(double value, std::size_t direction) {
  T result(value);
  if constexpr (!std::is_same_v<T, double>) result.slope[direction / 4][direction % 4] = 1.0;
  return result;
}

double number(double x) { return x; }
template <std::size_t packs>
double number(const Dual<packs>& x) {
  return x.value;
}

/// Creep force with its derivatives, if wanted.
struct Creep {
  CreepForceJet jet;

  template <class T>
  [[nodiscard]] std::array<T, 3> of(const T& ratio, const std::array<T, 3>& c) const {
    std::array<T, 3> f{T(jet.force.x), T(jet.force.y), T(jet.force.moment)};
    if constexpr (!std::is_same_v<T, double>) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<double, 4>& d = jet.derivative[k];
        for (std::size_t i = 0; i < std::size(ratio.slope); ++i) {
          f[k].slope[i] = d[0] * ratio.slope[i] + d[1] * c[0].slope[i] + d[2] * c[1].slope[i] + d[3] * c[2].slope[i];
        }
      }
    }
    return f;
  }
};

/// On the wheel, moment about the wheelset centre, in rail-head axes.
template <class T>
struct Wrench {
  Vector<T> force{}, moment{};

  void add(const Wrench& other, const T& factor) {
    for (std::size_t i = 0; i < 3; ++i) {
      force[i] += factor * other.force[i];
      moment[i] += factor * other.moment[i];
    }
  }
};

template <class T>
Wrench<double> numbers(const Wrench<T>& w) {
  Wrench<double> result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.force[i] = number(w.force[i]);
    result.moment[i] = number(w.moment[i]);
  }
  return result;
}

/// A part of the contact that bears load, or several as one.
template <class T>
struct Part {
  T normal;                ///< with damping [N]
  Vector<T> arm;           ///< [m]
  T cos_angle, sin_angle;  ///< of the contact angle
  T a, b, s;               ///< ellipse and place across the rail [m]
  T peak, saddle;          ///< LoadedPart
};

/// Derivatives of a wrench with respect to the wheel's motion: velocity (3), rotation (3), the rail's roll rate.
using MotionSlope = Eigen::Matrix<double, 6, 7>;
using MotionRow = Eigen::Matrix<double, 1, 7>;

/// Forces of numbers, or of dual numbers whose first directions are those of the pose and, where parts are damped,
/// whose others are the parts' normal forces; derivatives with respect to velocities are summed up apart
/// (motion_slope()), since every part answers to three components of slip only.
template <class T>
class LoadedContactForce {
 public:
  /// @param rail_friction RailHeadMotion::friction
  /// @param slopes of the look-up, where T has derivatives
  LoadedContactForce(const WheelContactModel& model, double rail_friction, const WheelKinematics& wheel,
                     const LoadedLookup& lookup, const LoadedSlopes* slopes)
      : model_(model), friction_(model.friction * rail_friction), wheel_(wheel), lookup_(lookup), slopes_(slopes) {
    const Pose pose{wheel.y, wheel.z, wheel.roll, wheel.yaw};
    for (std::size_t k = 0; k < pose_directions; ++k) pose_[k] = coordinate<T>(pose[k], k);
    centre_y_ = coordinate<T>(wheel.centre_y, 0);
    centre_z_ = coordinate<T>(wheel.centre_z, 1);
    const Pose of_cos_roll{0.0, 0.0, -wheel.sin_roll, 0.0}, of_sin_roll{0.0, 0.0, wheel.cos_roll, 0.0};
    cos_roll_ = quantity<T>(wheel.cos_roll, of_cos_roll);
    sin_roll_ = quantity<T>(wheel.sin_roll, of_sin_roll);
    const Pose of_cos_yaw{0.0, 0.0, 0.0, -wheel.sin_yaw}, of_sin_yaw{0.0, 0.0, 0.0, wheel.cos_yaw};
    cos_yaw_ = quantity<T>(wheel.cos_yaw, of_cos_yaw);
    sin_yaw_ = quantity<T>(wheel.sin_yaw, of_sin_yaw);
    Pose slope{};
    for (Eigen::Index j = 0; j < 4; ++j) {
      if constexpr (derivatives) std::memcpy(slope.data(), slopes_->stiffness.col(j).data(), sizeof slope);
      force_[static_cast<std::size_t>(j)] = quantity<T>(lookup.force[j], slope);
    }
    std::memcpy(slope.data(), lookup.force.data(), sizeof slope);
    energy_ = quantity<T>(lookup.energy, slope);
    if (lookup.energy > 0.0) add_parts();
  }

  /// Derivative of the energy (LoadedLookup::force) and the energy.
  [[nodiscard]] const std::array<T, 4>& elastic() const { return force_; }
  [[nodiscard]] const T& energy() const { return energy_; }
  [[nodiscard]] const std::array<T, 4>& pose() const { return pose_; }
  /// Creep and damping forces, and their derivatives with respect to velocities.
  [[nodiscard]] const Wrench<T>& rest() const { return rest_; }
  [[nodiscard]] const MotionSlope& motion_slope() const { return motion_slope_; }
  /// All forces at the pose.
  [[nodiscard]] Wrench<T> total() const {
    Wrench<T> sum = wrench(force_);
    sum.add(rest_, T(1.0));
    return sum;
  }
  [[nodiscard]] const std::array<double, LoadedLookup::capacity>& part_normal() const { return part_normal_; }
  [[nodiscard]] int outside_creep_table() const { return outside_; }
  [[nodiscard]] double creep_power() const { return creep_power_; }  ///< WheelForce::creep_power

  /// Elastic forces on the wheel. The moment of the normal forces about the axle is zero.
  [[nodiscard]] Wrench<T> wrench(const std::array<T, 4>& on_rail) const {
    const T moment_x = -on_rail[2], moment_up = -on_rail[3], moment_y = sin_yaw_ / cos_yaw_ * moment_x;
    const T &c = cos_roll_, &s = sin_roll_;
    return {{T(0.0), -on_rail[0], -on_rail[1]}, {moment_x, c * moment_y - s * moment_up, s * moment_y + c * moment_up}};
  }

  /// Generalised forces on wheelset (6) and rail head (3) in track axes: as WheelForce::patch, of the right wheel.
  /// @param w with derivatives, or numbers alone
  template <class U>
  [[nodiscard]] Generalised<U> generalised(const Wrench<U>& w) const {
    const auto of_pose = [](const T& x) {
      if constexpr (std::is_same_v<U, T>)
        return x;
      else
        return number(x);
    };
    const double c = wheel_.rail_cos, s = wheel_.rail_sin;
    const Vector<U>&f = w.force, &m = w.moment;
    const U fy = c * f[1] - s * f[2], fz = s * f[1] + c * f[2];
    const U about_axle =
        of_pose(cos_yaw_) * (of_pose(cos_roll_) * m[1] + of_pose(sin_roll_) * m[2]) - of_pose(sin_yaw_) * m[0];
    return {f[0], fy,         fz,
            m[0], about_axle, s * m[1] + c * m[2],
            -fy,  -fz,        -(m[0] + of_pose(centre_y_) * f[2] - of_pose(centre_z_) * f[1])};
  }

 private:
  static constexpr bool derivatives = !std::is_same_v<T, double>;

  /// Velocity of the wheel's particle at `arm` from the wheelset centre against the rail's particle there. The rail's
  /// own roll rate turns its surface about the rail-head origin; `rotation` counts it about the wheelset centre.
  [[nodiscard]] Vector<T> slip_velocity(const Vector<T>& arm) const {
    const auto &v = wheel_.velocity, &r = wheel_.rotation;
    return {v[0] + (r[1] * arm[2] - r[2] * arm[1]),
            v[1] + (r[2] * arm[0] - r[0] * arm[2] + wheel_.rail_rate * centre_z_),
            v[2] + (r[0] * arm[1] - r[1] * arm[0] - wheel_.rail_rate * centre_y_)};
  }

  void add_parts() {
    using std::cos, std::sin;
    std::array<Part<T>, LoadedLookup::capacity> parts;
    for (std::size_t p = 0; p < lookup_.parts; ++p) {
      Part<T>& part = parts[p];
      const auto of = [&](auto&& member) {
        if constexpr (derivatives) {
          return quantity<T>(member(lookup_.part[p]), member(slopes_->part[p]));
        } else {
          return member(lookup_.part[p]);
        }
      };
      const T angle = of([](const auto& q) { return q.angle; });
      part.cos_angle = cos(angle);
      part.sin_angle = sin(angle);
      part.arm = {of([](const auto& q) { return q.arm_x; }), of([](const auto& q) { return q.arm_y; }),
                  of([](const auto& q) { return q.arm_z; })};
      part.a = of([](const auto& q) { return q.a; });
      part.b = of([](const auto& q) { return q.b; });
      part.s = of([](const auto& q) { return q.s_rail; });
      part.peak = of([](const auto& q) { return q.peak; });
      part.saddle = of([](const auto& q) { return q.saddle; });
      const T elastic = of([](const auto& q) { return q.share; }) * force_[1] / part.cos_angle;
      part.normal = elastic;
      if (model_.damping != 0.0) add_damping(elastic, p, part);
      part_normal_[p] = number(part.normal);
    }
    if (friction_ > 0.0) add_groups(parts);
    if constexpr (derivatives) {
      if (model_.damping != 0.0) add_damped_normals();
    }
  }

  // Where T has derivatives, those of all that follows with respect to the part's normal force are carried along in a
  // direction of its own: the normal force depends on velocities, too.
  void add_damping(const T& elastic, std::size_t p, Part<T>& part) {
    const Vector<T> slip = slip_velocity(part.arm);
    const T approach = part.cos_angle * slip[2] - part.sin_angle * slip[1];
    part.normal = elastic * (1.0 + model_.damping * approach);
    const bool pulls = number(part.normal) < 0.0;
    if (pulls) part.normal = T(0.0);
    if constexpr (derivatives) {
      const double c = part.cos_angle.value, s = part.sin_angle.value;
      const double x = part.arm[0].value, y = part.arm[1].value, z = part.arm[2].value;
      MotionRow& row = damped_[p];
      row << 0.0, -s, c, y * c + z * s, -x * c, -x * s, -(s * wheel_.centre_z + c * wheel_.centre_y);
      row *= pulls ? 0.0 : elastic.value * model_.damping;
      const std::size_t direction = pose_directions + p;
      part.normal.slope[direction / 4][direction % 4] = 1.0;
    }
    const T more = part.normal - elastic;
    add(Vector<T>{T(0.0), more * part.sin_angle, -more * part.cos_angle}, part.arm, Vector<T>{T(0.0), T(0.0), T(0.0)},
        T(1.0));
  }

  void add_damped_normals() {
    for (std::size_t p = 0; p < lookup_.parts; ++p) {
      const std::size_t direction = pose_directions + p;
      Eigen::Matrix<double, 6, 1> along;
      for (Eigen::Index i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        along[i] = rest_.force[k].slope[direction / 4][direction % 4];
        along[3 + i] = rest_.moment[k].slope[direction / 4][direction % 4];
      }
      motion_slope_ += along * damped_[p];
    }
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
        if (!(number(weight) > 0.0)) continue;
        if (first == last) {
          add_creep(parts[first], weight);
        } else {
          add_creep(together(parts, first, last), weight);
        }
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
    Part<T> sum;
    sum.normal = T(0.0);
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
    const Vector<T> slip = slip_velocity(part.arm);
    const auto& rotation = wheel_.rotation;
    const double speed = model_.creepage_speed() / model_.friction_law.initial_slope;
    const T slip_across = part.cos_angle * slip[1] + part.sin_angle * slip[2];
    const Friction friction = this->friction(slip[0], slip_across);
    const T bound = friction.coefficient * part.normal, root = sqrt(part.a * part.b);
    const T scale = model_.normal.material.shear_modulus() / speed * (part.a * part.b) / bound;
    const std::array<T, 3> creepage{slip[0] * scale, slip_across * scale,
                                    (rotation[2] * part.cos_angle - rotation[1] * part.sin_angle) * scale * root};
    const T ratio = part.a / part.b;
    const Creepage at{number(creepage[0]), number(creepage[1]), number(creepage[2])};
    Creep creep;
    if constexpr (derivatives) {
      creep.jet = creep_force_jet(model_.creep_law, ratio.value, at);
      const CreepForceJet& jet = creep.jet;
      const std::array<double, 3> force{jet.force.x, jet.force.y, jet.force.moment}, c{at.x, at.y, at.spin};
      const std::array<double, 3> size{1.0, 1.0, root.value};
      Eigen::Matrix3d slope;  // of the local forces with respect to the slips
      for (std::size_t i = 0; i < 3; ++i) {
        const std::array<double, 4>& d = jet.derivative[i];
        const double by_bound = force[i] - d[1] * c[0] - d[2] * c[1] - d[3] * c[2];
        for (std::size_t k = 0; k < 3; ++k) {
          slope(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
              weight.value * size[i] *
              (bound.value * scale.value * size[k] * d[k + 1] + part.normal.value * friction.slope[k] * by_bound);
        }
      }
      add_motion_slope(part, slope);
    } else {
      creep.jet.force = creep_force(model_.creep_law, ratio, at);
    }
    const CreepForce& local = creep.jet.force;
    const auto* table = std::get_if<TableCreep>(&model_.creep_law);
    if (table && table->share(number(ratio), at) < 1.0) ++outside_;
    creep_power_ -=
        number(weight) * number(bound) / number(scale) * (local.x * at.x + local.y * at.y + local.moment * at.spin);
    const std::array<T, 3> f = creep.of(ratio, creepage);
    const T across = f[1] * bound, spin = f[2] * bound * root;
    const Vector<T> force{f[0] * bound, across * part.cos_angle, across * part.sin_angle};
    const Vector<T> moment{T(0.0), -spin * part.sin_angle, spin * part.cos_angle};
    add(force, part.arm, moment, weight);
  }

  /// Coefficient at a slip velocity, and its derivatives with respect to the slip along x, across and about the normal.
  struct Friction {
    T coefficient;
    std::array<double, 3> slope{};
  };
  [[nodiscard]] Friction friction(const T& along, const T& across) const {
    if (!model_.friction_law.falls()) return {T(friction_), {}};
    using std::sqrt;
    constexpr double least = 1e-12;  // m²/s²: a root has no slope at zero
    const T velocity = sqrt(along * along + across * across + T(least));
    const double w = number(velocity), slope = friction_ * model_.friction_law.slope(w);
    const double value = friction_ * model_.friction_law.share(w);
    Friction result{T(value), {slope * number(along) / w, slope * number(across) / w, 0.0}};
    if constexpr (derivatives) result.coefficient = chained(velocity, value, slope);
    return result;
  }

  // The slips of a part, along x, across and about its normal, are Eᵀ (velocity, rotation) of the wheel, and its creep
  // forces act on the wheel by E.
  void add_motion_slope(const Part<T>& part, const Eigen::Matrix3d& slope) {
    const double c = part.cos_angle.value, s = part.sin_angle.value;
    const double x = part.arm[0].value, y = part.arm[1].value, z = part.arm[2].value;
    Eigen::Matrix<double, 6, 3> E;
    E << 1.0, 0.0, 0.0,           //
        0.0, c, 0.0,              //
        0.0, s, 0.0,              //
        0.0, y * s - z * c, 0.0,  //
        z, -x * s, -s,            //
        -y, x * c, c;
    const Eigen::Matrix<double, 6, 3> answer = E * slope;
    motion_slope_.leftCols<6>() += answer * E.transpose();
    motion_slope_.col(6) += (c * wheel_.centre_z - s * wheel_.centre_y) * answer.col(1);
  }

  // A force on the wheel at `arm`, and a moment.
  void add(const Vector<T>& force, const Vector<T>& arm, const Vector<T>& own, const T& weight) {
    const Vector<T> moment{own[0] + arm[1] * force[2] - arm[2] * force[1],
                           own[1] + arm[2] * force[0] - arm[0] * force[2],
                           own[2] + arm[0] * force[1] - arm[1] * force[0]};
    rest_.add({force, moment}, weight);
  }

  const WheelContactModel& model_;
  double friction_;  ///< without slip
  const WheelKinematics& wheel_;
  const LoadedLookup& lookup_;
  const LoadedSlopes* slopes_;
  std::array<T, pose_directions> pose_, force_;
  T centre_y_, centre_z_, cos_roll_, sin_roll_, cos_yaw_, sin_yaw_;
  T energy_;
  Wrench<T> rest_;
  MotionSlope motion_slope_ = MotionSlope::Zero();
  std::array<MotionRow, LoadedLookup::capacity> damped_;  ///< of the parts' normal forces
  std::array<double, LoadedLookup::capacity> part_normal_{};
  int outside_ = 0;
  double creep_power_ = 0.0;
};

WheelKinematics right_wheel(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                            const RailHeadMotion& rail) {
  return {model.geometry->pair(), on_right(side, wheelset), on_right(side, rail), model.speed};
}

Vector9 in_track(WheelSide side, const Generalised<double>& of_right) {
  const Vector9 force = Eigen::Map<const Vector9>(of_right.data());
  return side == WheelSide::left ? reflected(force) : force;
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
  const Pose metric{1.0, 1.0, radius * radius, radius * radius};
  const Pose from{start.pose.y, start.pose.z, start.pose.roll, start.pose.yaw};
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
class DisplacementSlopes {
 public:
  DisplacementSlopes(const WheelKinematics& wheel, const StepRates& rates) : w_(wheel), rates_(rates) {}

  /// @param pose derivatives of the generalised forces with respect to the pose. @param motion with respect to the
  /// wheel's motion. @param turned of those that turn with the rail, their values
  [[nodiscard]] Matrix9 of(const Eigen::Matrix<double, 9, 4>& pose, const Eigen::Matrix<double, 9, 7>& motion,
                           const Vector9& turned) const {
    const double c = w_.rail_cos, s = w_.rail_sin, rail = rates_.rail;
    const Vector6& rate = rates_.wheelset;
    Matrix9 t;
    // along the track's y and z
    const Vector9 pose_y = c * pose.col(0) - s * pose.col(1), pose_z = s * pose.col(0) + c * pose.col(1);
    const Vector9 motion_y = c * motion.col(1) - s * motion.col(2), motion_z = s * motion.col(1) + c * motion.col(2);
    t.col(0) = rate[0] * motion.col(0);
    t.col(1) = pose_y + rate[1] * motion_y;
    t.col(2) = pose_z + rate[2] * motion_z;
    t.col(6) = -(pose_y + rail * motion_y);
    t.col(7) = -(pose_z + rail * motion_z);
    // rotations: the axle turns with roll and yaw
    const auto about = [&](double x, double y, double z) -> Vector9 {
      return w_.turning * (x * motion.col(3) + y * motion.col(4) + z * motion.col(5));
    };
    const Vector9 roll = pose.col(2) + about(0.0, -w_.axle[2], w_.axle[1]);
    t.col(3) = roll + rate[3] * motion.col(3);
    t.col(4) = rate[4] * (w_.axle[0] * motion.col(3) + w_.axle[1] * motion.col(4) + w_.axle[2] * motion.col(5));
    t.col(5) = pose.col(3) + about(-w_.cos_yaw, -w_.sin_yaw * w_.cos_roll, -w_.sin_yaw * w_.sin_roll) +
               rate[5] * (s * motion.col(4) + c * motion.col(5));
    t.col(8) = w_.centre_z * pose.col(0) - w_.centre_y * pose.col(1) - roll + rail * (motion.col(6) - motion.col(3)) +
               w_.velocity[2] * motion.col(1) - w_.velocity[1] * motion.col(2) + w_.swaying[2] * motion.col(4) -
               w_.swaying[1] * motion.col(5) + turned;
    return t;
  }

 private:
  const WheelKinematics& w_;
  const StepRates& rates_;
};

template <class T>
LoadedWheelForce force_of(const LoadedContactForce<T>& force, WheelSide side, const WheelKinematics& wheel,
                          const LoadedLookup& lookup) {
  LoadedWheelForce result;
  const Vector9 total = in_track(side, force.generalised(numbers(force.total())));
  result.wheelset = total.head<6>();
  result.rail = total.tail<3>();
  result.rail_x = -result.wheelset[0];
  std::copy_n(force.part_normal().begin(), lookup.parts, result.normal.begin());
  result.outside_creep_table = force.outside_creep_table();
  result.creep_power = force.creep_power();
  result.pressure = lookup.largest_pressure();
  const Generalised<double> rest = force.generalised(numbers(force.rest()));
  result.memory = {.weight = lookup.table_share,
                   .pose = {wheel.y, wheel.z, wheel.roll, wheel.yaw},
                   .energy = lookup.energy,
                   .force = lookup.force,
                   .rest = lookup.table_share * Eigen::Map<const Vector9>(rest.data()),
                   .total = lookup.table_share * total};
  return result;
}

/// Of the right wheel.
template <class T>
Matrix9 tangent_of(const LoadedContactForce<T>& force, const WheelContactModel& model, const WheelKinematics& wheel,
                   const LoadedLookup& lookup, const StepRates& rates, const LoadedMemory* start) {
  Generalised<T> total;
  double of_motion = 1.0;
  Vector9 turned = Vector9::Zero();
  const auto turn = [&](const Wrench<T>& w) {
    const double c = wheel.rail_cos, s = wheel.rail_sin;
    const double fy = c * number(w.force[1]) - s * number(w.force[2]);
    const double fz = s * number(w.force[1]) + c * number(w.force[2]);
    turned << 0.0, -fz, fy, 0.0, 0.0, c * number(w.moment[1]) - s * number(w.moment[2]), fz, -fy, 0.0;
  };
  if (start) {
    const MeanForce<T> mean = mean_over_step(model.geometry->pair(), *start, force, lookup.table_share);
    turn(mean.end);
    total = force.generalised(mean.end);
    for (std::size_t i = 0; i < 9; ++i) total[i] += start->rest[static_cast<Eigen::Index>(i)] * mean.of_start;
    of_motion = lookup.table_share * number(mean.of_start);
  } else {
    const Wrench<T> sum = force.total();
    turn(sum);
    total = force.generalised(sum);
  }
  Eigen::Matrix<double, 9, 4> pose;
  for (Eigen::Index i = 0; i < 9; ++i)
    for (Eigen::Index j = 0; j < 4; ++j) pose(i, j) = total[static_cast<std::size_t>(i)].slope[0][j];
  // As LoadedContactForce::generalised().
  const MotionSlope w = of_motion * force.motion_slope();
  const double c = wheel.rail_cos, s = wheel.rail_sin;
  Eigen::Matrix<double, 9, 7> motion;
  motion.row(0) = w.row(0);
  motion.row(1) = c * w.row(1) - s * w.row(2);
  motion.row(2) = s * w.row(1) + c * w.row(2);
  motion.row(3) = w.row(3);
  motion.row(4) = wheel.axle[0] * w.row(3) + wheel.axle[1] * w.row(4) + wheel.axle[2] * w.row(5);
  motion.row(5) = s * w.row(4) + c * w.row(5);
  motion.row(6) = -motion.row(1);
  motion.row(7) = -motion.row(2);
  motion.row(8) = -(w.row(3) + wheel.centre_y * w.row(2) - wheel.centre_z * w.row(1));
  return DisplacementSlopes(wheel, rates).of(pose, motion, turned);
}

template <class T>
LoadedWheelResponse response_of(const LoadedContactForce<T>& force, const WheelContactModel& model, WheelSide side,
                                const WheelKinematics& wheel, const LoadedLookup& lookup, const StepRates& rates,
                                const LoadedMemory* start) {
  LoadedWheelResponse result{force_of(force, side, wheel, lookup),
                             tangent_of(force, model, wheel, lookup, rates, start)};
  if (side == WheelSide::left) {
    const Vector9 sign = reflected(Vector9(Vector9::Ones()));
    result.tangent = sign.asDiagonal() * result.tangent * sign.asDiagonal();
  }
  return result;
}

}  // namespace

LoadedWheelForce loaded_wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                    const RailHeadMotion& rail, const LoadedLookup& lookup) noexcept {
  const WheelKinematics wheel = right_wheel(model, side, wheelset, rail);
  return force_of(LoadedContactForce<double>(model, rail.friction, wheel, lookup, nullptr), side, wheel, lookup);
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
  const WheelKinematics wheel = right_wheel(model, side, wheelset, rail);
  const LoadedContactForce<double> end(model, rail.friction, wheel, lookup, nullptr);
  const MeanForce<double> mean = mean_over_step(model.geometry->pair(), start, end, lookup.table_share);
  Generalised<double> force = end.generalised(mean.end);
  for (std::size_t i = 0; i < 9; ++i) force[i] += mean.of_start * start.rest[static_cast<Eigen::Index>(i)];
  return in_track(side, force);
}

LoadedWheelResponse loaded_wheel_response(const WheelContactModel& model, WheelSide side,
                                          const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                          const LoadedLookup& lookup, const LoadedSlopes& slopes,
                                          const StepRates& rates, const LoadedMemory* start) noexcept {
  constexpr std::size_t normal_packs = (LoadedLookup::capacity + 3) / 4;
  const WheelKinematics wheel = right_wheel(model, side, wheelset, rail);
  const auto response = [&]<std::size_t packs>() {
    const LoadedContactForce<Dual<packs>> force(model, rail.friction, wheel, lookup, &slopes);
    return response_of(force, model, side, wheel, lookup, rates, start);
  };
  return model.damping != 0.0 ? response.operator()<1 + normal_packs>() : response.operator()<1>();
}

}  // namespace railtab
