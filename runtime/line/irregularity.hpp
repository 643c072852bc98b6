#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "railtab/runtime/base/rail_side.hpp"

namespace railtab {

/// Deviation of one rail head from its nominal line, with slopes and curvatures along x.
struct RailDeviation {
  double y = 0, z = 0;              ///< [m]
  double dy_dx = 0, dz_dx = 0;      ///< [-]
  double ddy_dx2 = 0, ddz_dx2 = 0;  ///< [1/m]
};

/// Track irregularity of both rails over x: natural cubic splines (C2) through the measured points, [Press2007,
/// Sect. 3.3]. y > 0 moves the rail head to the right, z > 0 down. Outside the measured range the deviation is zero: a
/// record that does not begin and end at zero gives a step there.
class Irregularity {
 public:
  Irregularity() = default;  ///< a perfect track
  /// Columns of equal length >= 2 [m], finite, x strictly increasing. @throws InputError naming the point
  Irregularity(std::vector<double> x, std::vector<double> y_left, std::vector<double> z_left,
               std::vector<double> y_right, std::vector<double> z_right);

  /// Constant time on evenly spaced points, O(log n) else; allocation-free.
  [[nodiscard]] RailDeviation at(RailSide side, double x) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return x_.empty(); }
  /// First and last measured position [m]. @pre not empty
  [[nodiscard]] double begin() const noexcept { return x_.front(); }
  [[nodiscard]] double end() const noexcept { return x_.back(); }
  /// Largest deviation at the measured positions [m]; 0 without any.
  [[nodiscard]] double largest() const noexcept;
  /// Largest mean of z_left and z_right there [m]; 0 without any.
  [[nodiscard]] double largest_mean_height() const noexcept;

  /// An extreme of a column's spline between point `point` and the next.
  struct Extreme {
    std::size_t column = 0, point = 0;
    double x = 0.0, value = 0.0;  ///< [m]
    double beyond = 0.0;          ///< outside the range of the column's points, in sizes of that range
  };
  /// The one that is farthest outside; beyond = 0 where none is. Of evenly spaced points a spline leaves the range of
  /// values by less than half of it (its Lebesgue constant is below 2); unevenly spaced ones have no such bound.
  [[nodiscard]] Extreme farthest_out() const noexcept;

 private:
  /// Values and second derivatives of y_left, z_left, y_right, z_right at one point.
  struct Knot {
    std::array<double, 4> value, curvature;
  };
  std::vector<double> x_;
  std::vector<Knot> knots_;
};

/// Read a text file (docs/file_formats/irregularity.md): comment lines "#", one header row "x[m],y_left[mm],z_left[mm],
/// y_right[mm],z_right[mm]" with the unit of each column, m or mm, then one row per point.
/// @throws InputError with file and line: missing unit, wrong columns, a value that is not a finite number, x not
/// increasing, a spline that leaves the range of its points by more than the size of that range
[[nodiscard]] Irregularity read_irregularity(const std::filesystem::path& file);

}  // namespace railtab
