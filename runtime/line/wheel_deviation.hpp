#pragma once

#include <filesystem>
#include <vector>

namespace railtab {

/// How much higher the centre of a wheel that is not round runs than that of a round one, z up, over the angle that the
/// wheel has turned by; with derivatives per radian.
struct WheelRise {
  double rise = 0.0, slope = 0.0, curvature = 0.0;  ///< [m], [m/rad], [m/rad²]
};

/// A flat on a wheel of radius R, by its length L along the tread. The centre of a wheel that rolls over it without
/// leaving the rail falls by
///     sharp:   R (1 − cos(φ − |θ|)),  φ = arcsin(L/2R):  it turns about the edges, with a kink in the middle
///     rounded: ½ d (1 + cos(πθ/φ)),   d = L²/(16 R):     edges worn away [NewtonClark1979]
/// within |θ| < φ of the flat's middle.
struct WheelFlat {
  enum class Edges { sharp, rounded } edges = Edges::sharp;
  double length = 0.0;  ///< [m], below the radius
  double angle = 0.0;   ///< of its middle: the wheel stands on it when it has turned by that angle [rad]
};

/// amplitude · cos(order (θ − phase)): order 1 is run-out, higher ones are polygons.
struct WheelHarmonic {
  int order = 1;           ///< >= 1
  double amplitude = 0.0;  ///< [m]
  double phase = 0.0;      ///< where the wheel is highest first [rad]
};

/// Deviation over angle, periodic: cubic Hermite polynomials with slopes by central differences.
struct WheelContour {
  std::vector<double> angle;  ///< strictly increasing, within one turn, at least 4 [rad]
  std::vector<double> rise;   ///< as many [m]
};

/// One wheel's deviation from the circle.
class WheelDeviation {
 public:
  WheelDeviation() = default;  ///< round
  /// @param radius nominal [m] @throws InputError naming what is out of range
  WheelDeviation(double radius, std::vector<WheelFlat> flats, std::vector<WheelHarmonic> harmonics,
                 WheelContour contour = {});

  [[nodiscard]] bool round() const noexcept { return flats_.empty() && harmonics_.empty() && contour_.angle.empty(); }
  /// @param angle by which the wheel has turned [rad]
  [[nodiscard]] WheelRise at(double angle) const noexcept;

 private:
  double radius_ = 0.46;
  std::vector<WheelFlat> flats_;
  std::vector<WheelHarmonic> harmonics_;
  WheelContour contour_;
};

/// Columns angle[rad] or angle[deg] and rise[m] or rise[mm] (docs/file_formats/histories.md).
/// @throws InputError with file and line
[[nodiscard]] WheelContour read_wheel_contour(const std::filesystem::path& file);

}  // namespace railtab
