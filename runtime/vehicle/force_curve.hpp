#pragma once

#include <array>
#include <vector>

namespace railtab {

/// Odd, piecewise-linear characteristic y(x) of a force element through 0 and given points; beyond the last point it
/// goes on with the last slope. A bump stop: elongation [m] to force [N]; a damper: rate [m/s] to force [N].
class ForceCurve {
 public:
  ForceCurve() = default;
  /// @param points x, y; x > 0 strictly increasing, y >= 0 not decreasing
  explicit ForceCurve(std::vector<std::array<double, 2>> points);

  /// A force and its derivative by x, or by the end of a path.
  struct Value {
    double force = 0.0, slope = 0.0;
  };
  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  [[nodiscard]] Value at(double x) const noexcept;
  /// ∫ y dx from 0 to x; >= 0.
  [[nodiscard]] double integral(double x) const noexcept;
  /// Mean of y over the path from x0 to x1 at constant rate: (integral(x1) − integral(x0))/(x1 − x0), the discrete
  /// gradient of the integral [Gonzalez1996]; its derivative by x1.
  [[nodiscard]] Value mean(double x0, double x1) const noexcept;
  /// Where the first force begins: the free travel of a stop.
  [[nodiscard]] double free_travel() const noexcept;
  /// Without the origin.
  [[nodiscard]] const std::vector<std::array<double, 2>>& points() const noexcept { return points_; }

 private:
  [[nodiscard]] std::size_t segment(double magnitude) const noexcept;

  std::vector<std::array<double, 2>> points_;
  std::vector<double> slope_, area_;  // of the segment that ends at a point; ∫ up to where it begins
};

/// One step of a dry-friction element along a path of constant rate (docs/theory/vehicle.md).
struct FrictionStep {
  double end = 0.0, mean = 0.0;                        ///< force at the end, and over the path [N]
  double end_by_stretch = 0.0, mean_by_stretch = 0.0;  ///< derivatives by `stretch`
  double end_by_limit = 0.0, mean_by_limit = 0.0;      ///< and by `limit1`
};
/// A slider in series with a stiffness k: the force follows its stretch until it reaches ± the limit, and slides there.
/// The work mean·Δe is what the stiffness takes up, (end² − force²)/2k, and what sliding dissipates, which is >= 0.
/// @param force at the start, |force| <= limit0  @param stretch k times the elongation of the step [N]
/// @param limit0, limit1 friction limit at start and end, >= 0, linear in between [N]
[[nodiscard]] FrictionStep slide(double force, double stretch, double limit0, double limit1) noexcept;

}  // namespace railtab
