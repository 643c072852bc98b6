#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>
#include <variant>

#include "railtab/runtime/base/dual.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/base/smooth_step.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/runtime/contact/wheel_kinematics.hpp"
#include "railtab/tables/creep_table.hpp"
#include "railtab/tables/loaded_table.hpp"

/// The force of a loaded contact, for the functions of loaded_wheel.hpp.
namespace railtab::loaded_detail {

// V: a number, or numbers side by side; T: the same, or dual numbers of these.
template <class T>
struct NumberOf {
  using type = T;
};
template <class V, class S, std::size_t count>
struct NumberOf<DualOf<V, S, count>> {
  using type = V;
};
template <class T>
using Number = typename NumberOf<T>::type;

template <class T>
const Number<T>& number(const T& x) {
  if constexpr (std::is_same_v<T, Number<T>>) {
    return x;
  } else {
    return x.value;
  }
}

template <class T>
using Vector = std::array<T, 3>;
template <class T>
using Generalised = std::array<T, 9>;
template <class V>
using Pose = std::array<V, 4>;  // y, z, roll, yaw

constexpr std::size_t pose_directions = 4;

template <class T>
T constant(double x) {
  if constexpr (std::is_same_v<T, Number<T>>) {
    return broadcast<T>(x);
  } else {
    return T(x);
  }
}

// The derivative of a dual number in one direction.
template <std::size_t packs>
double slope_along(const Dual<packs>& x, std::size_t direction) {
  return x.slope[direction / 4][direction % 4];
}
template <std::size_t directions>
const WheelLanes& slope_along(const DualLanes<directions>& x, std::size_t direction) {
  return x.slope[direction];
}
template <std::size_t packs>
void set_slope(Dual<packs>& x, std::size_t direction, double slope) {
  x.slope[direction / 4][direction % 4] = slope;
}

// A quantity with its slope along the pose, which are the first directions of dual numbers.
template <class T>
T quantity(const Number<T>& value, const Pose<Number<T>>& slope) {
  T result(value);
  if constexpr (!std::is_same_v<T, Number<T>>) std::memcpy(&result.slope[0], slope.data(), sizeof slope);
  return result;
}

template <class T>
T coordinate(const Number<T>& value, std::size_t direction) {
  Pose<Number<T>> slope{};
  slope[direction] = broadcast<Number<T>>(1.0);
  return quantity<T>(value, slope);
}

/// Normalised creep force with its derivatives (CreepForceJet).
template <class V>
struct Creep {
  std::array<V, 3> force{};
  std::array<std::array<V, 4>, 3> derivative{};

  void set(int place, const CreepForceJet& jet) {
    const std::array<double, 3> f{jet.force.x, jet.force.y, jet.force.moment};
    for (std::size_t k = 0; k < 3; ++k) {
      lane(force[k], place) = f[k];
      for (std::size_t i = 0; i < 4; ++i) lane(derivative[k][i], place) = jet.derivative[k][i];
    }
  }
  explicit Creep(const CreepLookupOf<V>& found) : force(found.force) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<V, 3>& d = found.derivative[k];
      derivative[k] = {found.by_ratio[k], d[0], d[1], d[2]};
    }
  }
  explicit Creep(const std::array<V, 3>& alone) : force(alone) {}
  Creep() = default;
  template <class T>
  [[nodiscard]] std::array<T, 3> of(const T& ratio, const std::array<T, 3>& c) const {
    std::array<T, 3> f{force[0], force[1], force[2]};
    if constexpr (!std::is_same_v<T, V>) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<V, 4>& d = derivative[k];
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
Wrench<Number<T>> numbers(const Wrench<T>& w) {
  Wrench<Number<T>> result;
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
  T area;                  ///< of the ellipse, over π: a b [m²]
  T a, b, s;               ///< of a part alone: ellipse and place across the rail [m]
  T peak, saddle;          ///< LoadedPart; as `s`, not set where the contact has one part
};

/// Derivatives of a wrench with respect to the wheel's motion: velocity (3), rotation (3), the rail's roll rate.
template <class V>
using MotionRow = std::array<V, 7>;
template <class V>
using MotionSlope = std::array<MotionRow<V>, 6>;

/// Forces of numbers, or of dual numbers whose first directions are those of the pose and, where parts are damped,
/// whose others are the parts' normal forces; derivatives with respect to velocities are summed up apart
/// (motion_slope()), since every part answers to three components of slip only. Numbers side by side are those of
/// wheels without damping and with friction that does not fall.
template <class T>
class LoadedContactForce {
 public:
  using V = Number<T>;
  static constexpr int places = lanes_of<V>;

  /// @param rail_friction RailHeadMotion::friction
  /// @param slopes of the look-up, where T has derivatives
  LoadedContactForce(const WheelContactModel& model, const V& rail_friction, const WheelKinematics<V>& wheel,
                     const LoadedLookupOf<V>& lookup, const LoadedSlopesOf<V>* slopes)
      : model_(model), friction_(model.friction * rail_friction), wheel_(wheel), lookup_(lookup), slopes_(slopes) {
    const V zero{};
    const Pose<V> pose{wheel.y, wheel.z, wheel.roll, wheel.yaw};
    for (std::size_t k = 0; k < pose_directions; ++k) pose_[k] = coordinate<T>(pose[k], k);
    centre_y_ = coordinate<T>(wheel.centre_y, 0);
    centre_z_ = coordinate<T>(wheel.centre_z, 1);
    cos_roll_ = quantity<T>(wheel.cos_roll, {zero, zero, -wheel.sin_roll, zero});
    sin_roll_ = quantity<T>(wheel.sin_roll, {zero, zero, wheel.cos_roll, zero});
    cos_yaw_ = quantity<T>(wheel.cos_yaw, {zero, zero, zero, -wheel.sin_yaw});
    sin_yaw_ = quantity<T>(wheel.sin_yaw, {zero, zero, zero, wheel.cos_yaw});
    Pose<V> force{}, slope{};
    for (std::size_t j = 0; j < 4; ++j) {
      force[j] = element(lookup.force, j);
      if constexpr (derivatives) {
        for (std::size_t k = 0; k < 4; ++k) slope[k] = element(slopes_->stiffness, k, j);
      }
      force_[j] = quantity<T>(force[j], slope);
    }
    energy_ = quantity<T>(lookup.energy, force);
    if (any(lookup.energy > zero)) add_parts();
  }

  /// Derivative of the energy (LoadedLookup::force) and the energy.
  [[nodiscard]] const std::array<T, 4>& elastic() const { return force_; }
  [[nodiscard]] const T& energy() const { return energy_; }
  [[nodiscard]] const std::array<T, 4>& pose() const { return pose_; }
  /// Creep and damping forces, and their derivatives with respect to velocities.
  [[nodiscard]] const Wrench<T>& rest() const { return rest_; }
  [[nodiscard]] const MotionSlope<V>& motion_slope() const { return motion_slope_; }
  /// All forces at the pose.
  [[nodiscard]] Wrench<T> total() const {
    Wrench<T> sum = wrench(force_);
    for (std::size_t i = 0; i < 3; ++i) {
      sum.force[i] += rest_.force[i];
      sum.moment[i] += rest_.moment[i];
    }
    return sum;
  }
  [[nodiscard]] const std::array<V, LoadedLookup::capacity>& part_normal() const { return part_normal_; }
  [[nodiscard]] int outside_creep_table(int place) const { return outside_[static_cast<std::size_t>(place)]; }
  [[nodiscard]] const V& creep_power() const { return creep_power_; }  ///< WheelForce::creep_power

  /// Elastic forces on the wheel. The moment of the normal forces about the axle is zero.
  [[nodiscard]] Wrench<T> wrench(const std::array<T, 4>& on_rail) const {
    const T moment_x = -on_rail[2], moment_up = -on_rail[3], moment_y = sin_yaw_ / cos_yaw_ * moment_x;
    const T &c = cos_roll_, &s = sin_roll_;
    return {{constant<T>(0.0), -on_rail[0], -on_rail[1]},
            {moment_x, c * moment_y - s * moment_up, s * moment_y + c * moment_up}};
  }

  /// Generalised forces on wheelset (6) and rail head (3) in track axes: as WheelForce::patch, of the right wheel.
  /// @param w with derivatives, or numbers alone
  template <class U>
  [[nodiscard]] Generalised<U> generalised(const Wrench<U>& w) const {
    const auto of_pose = [](const T& x) -> const U& {
      if constexpr (std::is_same_v<U, T>) {
        return x;
      } else {
        return number(x);
      }
    };
    const V &c = wheel_.rail_cos, &s = wheel_.rail_sin;
    const Vector<U>&f = w.force, &m = w.moment;
    const U fy = c * f[1] - s * f[2], fz = s * f[1] + c * f[2];
    const U about_axle =
        of_pose(cos_yaw_) * (of_pose(cos_roll_) * m[1] + of_pose(sin_roll_) * m[2]) - of_pose(sin_yaw_) * m[0];
    return {f[0], fy,         fz,
            m[0], about_axle, s * m[1] + c * m[2],
            -fy,  -fz,        -(m[0] + of_pose(centre_y_) * f[2] - of_pose(centre_z_) * f[1])};
  }

 private:
  static constexpr bool derivatives = !std::is_same_v<T, V>;
  static constexpr bool single = std::is_same_v<V, double>;
  /// Saddles up to which two parts count as two ellipses, and from which on as one; what either differs by from the
  /// half-space solution is in docs/validation/loaded_contact.md.
  static constexpr double apart_up_to = 0.25, merged_from = 0.35;
  static constexpr double largest_side_by_side = 1e60;  ///< creepage whose square is far from overflow
  using Parts = std::array<Part<T>, LoadedLookup::capacity>;

  static double element(const Eigen::Vector4d& of, std::size_t j) { return of[static_cast<Eigen::Index>(j)]; }
  static const WheelLanes& element(const std::array<WheelLanes, 4>& of, std::size_t j) { return of[j]; }
  static double element(const Eigen::Matrix4d& of, std::size_t i, std::size_t j) {
    return of(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  static const WheelLanes& element(const std::array<std::array<WheelLanes, 4>, 4>& of, std::size_t i, std::size_t j) {
    return of[i][j];
  }

  /// Velocity of the wheel's particle at `arm` from the wheelset centre against the rail's particle there. The rail's
  /// own roll rate turns its surface about the rail-head origin; `rotation` counts it about the wheelset centre.
  [[nodiscard]] Vector<T> slip_velocity(const Vector<T>& arm) const {
    const auto &v = wheel_.velocity, &r = wheel_.rotation;
    return {v[0] + (r[1] * arm[2] - r[2] * arm[1]),
            v[1] + (r[2] * arm[0] - r[0] * arm[2] + wheel_.rail_rate * centre_z_),
            v[2] + (r[0] * arm[1] - r[1] * arm[0] - wheel_.rail_rate * centre_y_)};
  }

  void add_parts() {
    Parts parts;
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
      const SineCosineOf<V> direction(number(angle));
      if constexpr (derivatives) {
        part.cos_angle = chained(angle, direction.cosine, -direction.sine);
        part.sin_angle = chained(angle, direction.sine, direction.cosine);
      } else {
        part.cos_angle = direction.cosine;
        part.sin_angle = direction.sine;
      }
      part.arm = {of([](const auto& q) { return q.arm_x; }), of([](const auto& q) { return q.arm_y; }),
                  of([](const auto& q) { return q.arm_z; })};
      part.a = of([](const auto& q) { return q.a; });
      part.b = of([](const auto& q) { return q.b; });
      part.area = part.a * part.b;
      if (lookup_.parts > 1) {
        part.s = of([](const auto& q) { return q.s_rail; });
        part.peak = of([](const auto& q) { return q.peak; });
        part.saddle = of([](const auto& q) { return q.saddle; });
      }
      const T elastic = of([](const auto& q) { return q.share; }) * force_[1] / part.cos_angle;
      part.normal = elastic;
      if constexpr (single) {
        if (model_.damping != 0.0) add_damping(elastic, p, part);
      }
      part_normal_[p] = number(part.normal);
    }
    if (any(friction_ > V{})) add_groups(parts);
    if constexpr (single && derivatives) {
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
    if (pulls) part.normal = constant<T>(0.0);
    if constexpr (derivatives) {
      const double c = part.cos_angle.value, s = part.sin_angle.value;
      const double x = part.arm[0].value, y = part.arm[1].value, z = part.arm[2].value;
      damped_[p] = {0.0, -s, c, y * c + z * s, -x * c, -x * s, -(s * wheel_.centre_z + c * wheel_.centre_y)};
      for (double& slope : damped_[p]) slope *= pulls ? 0.0 : elastic.value * model_.damping;
      set_slope(part.normal, pose_directions + p, 1.0);
    }
    const T more = part.normal - elastic;
    add(Vector<T>{constant<T>(0.0), more * part.sin_angle, -more * part.cos_angle}, part.arm,
        Vector<T>{constant<T>(0.0), constant<T>(0.0), constant<T>(0.0)}, constant<T>(1.0));
  }

  void add_damped_normals() {
    for (std::size_t p = 0; p < lookup_.parts; ++p) {
      for (std::size_t i = 0; i < 6; ++i) {
        const double along = slope_along(i < 3 ? rest_.force[i] : rest_.moment[i - 3], pose_directions + p);
        for (std::size_t k = 0; k < 7; ++k) motion_slope_[i][k] += along * damped_[p][k];
      }
    }
  }

  // Every run of neighbouring parts, as one ellipse, weighted with how far its parts have merged with each other, and
  // not with those outside.
  void add_groups(const Parts& parts) {
    const std::size_t n = lookup_.parts;
    std::array<T, LoadedLookup::capacity + 1> merged;  // between parts k − 1 and k
    for (std::size_t k = 0; k <= n; ++k) merged[k] = k == 0 || k == n ? constant<T>(0.0) : merging(parts, k);
    for (std::size_t first = 0; first < n; ++first) {
      T within = constant<T>(1.0);
      for (std::size_t last = first; last < n; ++last) {
        if (last > first) within = within * merged[last];
        if (!any(number(within) > V{})) break;
        const T weight = within * (1.0 - merged[first]) * (1.0 - merged[last + 1]);
        if (!any(number(weight) > V{})) continue;
        if (first == last) {
          add_creep(parts[first], parts[first].a / parts[first].b, weight);
        } else {
          const auto [part, ratio] = together(parts, first, last);
          add_creep(part, ratio, weight);
        }
      }
    }
  }

  // How far the parts on both sides of the cut before part k count as one ellipse, 0 to 1: by the force per length at
  // the saddle between them over the lesser of the largest on both sides.
  T merging(const Parts& parts, std::size_t k) const {
    const auto is_part = [&](std::size_t p) { return lookup_.part[p].share > V{}; };
    T below = parts[0].peak, above = parts[k].peak;
    for (std::size_t p = 1; p < k; ++p) {
      below = select(number(parts[p].peak) > number(below), parts[p].peak, below);
    }
    for (std::size_t p = k + 1; p < lookup_.parts; ++p) {
      above = select(is_part(p) & (number(parts[p].peak) > number(above)), parts[p].peak, above);
    }
    const T ratio = parts[k - 1].saddle / select(number(below) < number(above), below, above);
    constexpr double width = merged_from - apart_up_to;
    const V t = (number(ratio) - apart_up_to) * (1.0 / width), share = smooth_step(t);
    const T none = constant<T>(0.0);
    if constexpr (derivatives) {
      return select(is_part(k), chained(ratio, share, (1.0 / width) * smooth_step_slope(t)), none);
    } else {
      return select(is_part(k), share, none);
    }
  }

  // Several parts as one, and the ratio of its semi-axes. Its ellipse is that of one pressure (EllipseOfPressure in
  // tablegen): second moments and mean pressure are those of the parts, each taken as Hertzian on its own ellipse. The
  // place of its slip is a weighted mean. Where all of the contact slides, a part counts by its force; where all of it
  // sticks, by a² b; the weight is the geometric mean of both.
  static std::pair<Part<T>, T> together(const Parts& parts, std::size_t first, std::size_t last) {
    using std::sqrt;
    const T none = constant<T>(0.0), one = constant<T>(1.0);
    Part<T> sum;
    sum.normal = none;
    sum.arm.fill(none);
    T s = none, aa = none, bb = none, pressure = none, weights = none, along = none, across = none;
    for (std::size_t p = first; p <= last; ++p) {
      const T& N = parts[p].normal;
      // Where a wheel beside has this part, and this one has not, any number serves that is no zero.
      const auto bears = number(N) > V{};
      const T weight = select(bears, parts[p].a * sqrt(select(bears, N * parts[p].b, one)), none);
      for (std::size_t i = 0; i < 3; ++i) sum.arm[i] += weight * parts[p].arm[i];
      weights += weight;
      pressure += N * N / select(bears, parts[p].area, one);
      sum.normal += N;
      s += N * parts[p].s;
      aa += N * parts[p].a * parts[p].a;
      along += N * parts[p].cos_angle;
      across += N * parts[p].sin_angle;
    }
    const auto bears = number(sum.normal) > V{};
    const T N = select(bears, sum.normal, one), middle = s / N;
    for (std::size_t p = first; p <= last; ++p) {
      const T distance = parts[p].s - middle;
      bb += parts[p].normal * (parts[p].b * parts[p].b + 5.0 * distance * distance);
    }
    const T of_weight = 1.0 / select(bears, weights, one);
    for (std::size_t i = 0; i < 3; ++i) sum.arm[i] = sum.arm[i] * of_weight;
    const T by_moments = sqrt(select(bears, aa * bb, one));  // N a b
    sum.area = sqrt(by_moments * N / select(bears, pressure, one));
    const T ratio = select(bears, aa, one) / by_moments;
    along = select(bears, along, one);
    const T length = sqrt(along * along + across * across);
    sum.cos_angle = along / length;
    sum.sin_angle = across / length;
    return {sum, ratio};
  }

  void add_creep(const Part<T>& part, const T& ratio, const T& share) {
    using std::sqrt;
    const auto bears = number(part.normal) > V{};
    if (!any(bears)) return;
    const T normal = single ? part.normal : select(bears, part.normal, constant<T>(1.0));
    const T weight = single ? share : select(bears, share, constant<T>(0.0));
    const Vector<T> slip = slip_velocity(part.arm);
    const auto& rotation = wheel_.rotation;
    const double speed = model_.creepage_speed() / model_.friction_law.initial_slope;
    const T slip_across = part.cos_angle * slip[1] + part.sin_angle * slip[2];
    T bound = friction_ * normal;
    std::array<V, 3> friction_slope{};
    if constexpr (single) {
      if (model_.friction_law.falls()) bound = falling_friction(slip[0], slip_across, friction_slope) * normal;
    }
    const T root = sqrt(part.area);
    const T scale = model_.normal.material.shear_modulus() / speed * part.area / bound;
    const std::array<T, 3> creepage{slip[0] * scale, slip_across * scale,
                                    (rotation[2] * part.cos_angle - rotation[1] * part.sin_angle) * scale * root};
    const Creep<V> creep =
        creep_of(number(ratio), {number(creepage[0]), number(creepage[1]), number(creepage[2])}, number(weight), bears);
    if constexpr (derivatives) add_motion_slope(part, creep, creepage, number(weight), scale, bound, friction_slope);
    V power{};
    for (std::size_t k = 0; k < 3; ++k) power = power + creep.force[k] * number(creepage[k]);
    creep_power_ = creep_power_ - number(weight) * number(bound) / number(scale) * power;
    const std::array<T, 3> f = creep.of(ratio, creepage);
    const T across = f[1] * bound, spin = f[2] * bound * root;
    const Vector<T> force{f[0] * bound, across * part.cos_angle, across * part.sin_angle};
    const Vector<T> moment{constant<T>(0.0), -spin * part.sin_angle, spin * part.cos_angle};
    add(force, part.arm, moment, weight);
  }

  // The law's creep force, and what it leaves of the table to another law is counted.
  Creep<V> creep_of(const V& ratio, const std::array<V, 3>& creepage, const V& weight, const auto& bears) {
    const auto* table = std::get_if<TableCreep>(&model_.creep_law);
    std::array<double, places> share;
    double least = 1.0;
    const auto at = [&](int i) { return Creepage{lane(creepage[0], i), lane(creepage[1], i), lane(creepage[2], i)}; };
    for (int i = 0; i < places && table; ++i) {
      double& of = share[static_cast<std::size_t>(i)] = table->share(lane(ratio, i), at(i));
      const bool finite = std::abs(at(i).x) + std::abs(at(i).y) + std::abs(at(i).spin) < largest_side_by_side;
      if (of < 1.0 && lane(bears, i) && lane(weight, i) > 0.0) ++outside_[static_cast<std::size_t>(i)];
      least = std::min(least, finite ? of : 0.0);
    }
    if constexpr (!single) {
      if (table && least == 1.0) {
        if constexpr (derivatives) {
          return Creep<V>(table->table->jet(ratio, creepage));
        } else {
          return Creep<V>(table->table->force(ratio, creepage));
        }
      }
    }
    Creep<V> creep;
    for (int i = 0; i < places; ++i) {
      if (!lane(bears, i)) continue;
      if constexpr (derivatives) {
        creep.set(i, creep_force_jet(model_.creep_law, lane(ratio, i), at(i)));
      } else {
        creep.set(i, {creep_force(model_.creep_law, lane(ratio, i), at(i)), {}});
      }
    }
    return creep;
  }

  /// Coefficient at a slip velocity, and its derivatives with respect to the slip along x, across and about the normal.
  [[nodiscard]] T falling_friction(const T& along, const T& across, std::array<V, 3>& slopes) const {
    using std::sqrt;
    constexpr double least = 1e-12;  // m²/s²: a root has no slope at zero
    const T velocity = sqrt(along * along + across * across + constant<T>(least));
    const double w = number(velocity), slope = friction_ * model_.friction_law.slope(w);
    const double value = friction_ * model_.friction_law.share(w);
    slopes = {slope * number(along) / w, slope * number(across) / w, 0.0};
    if constexpr (derivatives) {
      return chained(velocity, value, slope);
    } else {
      return value;
    }
  }

  // The slips of a part, along x, across and about its normal, are Eᵀ (velocity, rotation) of the wheel, and its creep
  // forces act on the wheel by E.
  void add_motion_slope(const Part<T>& part, const Creep<V>& creep, const std::array<T, 3>& creepage, const V& weight,
                        const T& scale, const T& bound, const std::array<V, 3>& friction_slope) {
    const V one = broadcast<V>(1.0), zero{};
    using std::sqrt;
    const std::array<V, 3> size{one, one, sqrt(number(part.area))};
    std::array<std::array<V, 3>, 3> slope;  // of the local forces with respect to the slips
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<V, 4>& d = creep.derivative[i];
      V by_bound = creep.force[i];
      for (std::size_t k = 0; k < 3; ++k) by_bound = by_bound - d[k + 1] * number(creepage[k]);
      for (std::size_t k = 0; k < 3; ++k) {
        V along = number(bound) * number(scale) * size[k] * d[k + 1];
        if constexpr (single) along += number(part.normal) * friction_slope[k] * by_bound;
        slope[i][k] = weight * size[i] * along;
      }
    }
    const V &c = number(part.cos_angle), &s = number(part.sin_angle);
    const V &x = number(part.arm[0]), &y = number(part.arm[1]), &z = number(part.arm[2]);
    const std::array<std::array<V, 3>, 6> E{{{one, zero, zero},
                                             {zero, c, zero},
                                             {zero, s, zero},
                                             {zero, y * s - z * c, zero},
                                             {z, -x * s, -s},
                                             {-y, x * c, c}}};
    // Rows of E whose first and last entries are not zero.
    constexpr auto has = [](std::size_t row, std::size_t k) {
      return k == 1 ? row > 0 : row > 3 || (row == 0 && k == 0);
    };
    std::array<std::array<V, 3>, 6> answer{};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (has(i, j))
          for (std::size_t k = 0; k < 3; ++k) answer[i][k] += E[i][j] * slope[j][k];
    const V rail = c * wheel_.centre_z - s * wheel_.centre_y;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t m = 0; m < 6; ++m)
        for (std::size_t k = 0; k < 3; ++k)
          if (has(m, k)) motion_slope_[i][m] += answer[i][k] * E[m][k];
      motion_slope_[i][6] += rail * answer[i][1];
    }
  }

  // A force on the wheel at `arm`, and a moment.
  void add(const Vector<T>& force, const Vector<T>& arm, const Vector<T>& own, const T& weight) {
    const Vector<T> moment{own[0] + arm[1] * force[2] - arm[2] * force[1],
                           own[1] + arm[2] * force[0] - arm[0] * force[2],
                           own[2] + arm[0] * force[1] - arm[1] * force[0]};
    rest_.add({force, moment}, weight);
  }

  const WheelContactModel& model_;
  V friction_;  ///< without slip
  const WheelKinematics<V>& wheel_;
  const LoadedLookupOf<V>& lookup_;
  const LoadedSlopesOf<V>* slopes_;
  std::array<T, pose_directions> pose_, force_;
  T centre_y_, centre_z_, cos_roll_, sin_roll_, cos_yaw_, sin_yaw_;
  T energy_;
  Wrench<T> rest_;
  MotionSlope<V> motion_slope_{};
  std::array<MotionRow<V>, LoadedLookup::capacity> damped_;  ///< of the parts' normal forces
  std::array<V, LoadedLookup::capacity> part_normal_{};
  std::array<int, places> outside_{};
  V creep_power_{};
};

}  // namespace railtab::loaded_detail
