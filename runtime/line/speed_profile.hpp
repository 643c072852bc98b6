#pragma once

#include <filesystem>
#include <vector>

namespace railtab {

/// Speed of the train over time: straight lines between the points given, the first and the last speed beyond them.
/// The distance is its exact integral, so that position, speed and acceleration belong together; the acceleration is
/// constant between two points and jumps at them.
class SpeedProfile {
 public:
  /// @param time strictly increasing [s]; @param speed [m/s], 0 to 200, as many, at least 2
  /// @throws InputError naming the point
  SpeedProfile(std::vector<double> time, std::vector<double> speed);

  [[nodiscard]] const std::vector<double>& points() const noexcept { return time_; }  ///< [s]
  [[nodiscard]] double lowest() const noexcept;                                       ///< speed of all points [m/s]
  [[nodiscard]] double begin() const noexcept { return time_.front(); }               ///< first and last point [s]
  [[nodiscard]] double end() const noexcept { return time_.back(); }
  [[nodiscard]] double speed(double time) const noexcept;         ///< V [m/s]
  [[nodiscard]] double acceleration(double time) const noexcept;  ///< dV/dt, at a jump that after it [m/s²]
  [[nodiscard]] double distance(double time) const noexcept;      ///< run since t = 0, negative before [m]
  /// When the train has run `distance`, the last time at which it stands there: the inverse of distance() [s]; infinite
  /// where it never gets there.
  [[nodiscard]] double time_at(double distance) const noexcept;

 private:
  [[nodiscard]] double travel(double time) const noexcept;  // since the first point

  std::vector<double> time_, speed_;
  std::vector<double> travel_;  // at the points, since the first
  double origin_ = 0.0;         // travel at t = 0
};

/// Read a speed profile: columns t[s] and V in [m/s] or [km/h] (docs/file_formats/histories.md).
/// @throws InputError with file and line
[[nodiscard]] SpeedProfile read_speed_profile(const std::filesystem::path& file);

}  // namespace railtab
