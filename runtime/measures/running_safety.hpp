#pragma once

namespace railtab {

/// Nadal's limit of Y/Q of the wheel that climbs, (tan δ − μ)/(1 + μ tan δ): flange angle δ [rad], friction μ.
[[nodiscard]] double nadal_limit(double flange_angle, double friction) noexcept;

/// Weinstock's criterion: |Y/Q| of both wheels of a wheelset together, against Nadal's limit + μ. Forces [N].
/// @pre Q_left, Q_right > 0
[[nodiscard]] double weinstock_ratio(double Y_left, double Q_left, double Y_right, double Q_right) noexcept;

/// Wheel unloading ΔQ/Q0 = (Q0 − Q)/Q0: the largest, and the longest time without a break above a limit, ends of it
/// between samples by the line through them.
class Unloading {
 public:
  /// @param limit of the duration [-]
  explicit Unloading(double limit) : limit_(limit) {}
  /// @param Q0 static load [N] @pre times rise
  void add(double time, double Q, double Q0) noexcept;
  [[nodiscard]] double largest() const noexcept { return largest_; }        ///< [-]
  [[nodiscard]] double time() const noexcept { return time_; }              ///< of the largest [s]
  [[nodiscard]] double longest_above() const noexcept { return longest_; }  ///< [s]
  [[nodiscard]] double longest_begin() const noexcept { return begin_; }    ///< when that began [s]; 0: never above

 private:
  double limit_, largest_ = -1e300, time_ = 0.0, longest_ = 0.0, begin_ = 0.0;
  double last_time_ = 0.0, last_ = 0.0, since_ = 0.0;
  bool any_ = false;
};

}  // namespace railtab
