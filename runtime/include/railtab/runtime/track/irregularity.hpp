#pragma once

#include <filesystem>
#include <vector>

#include "railtab/runtime/structure/structure_model.hpp"  // RailSide

namespace railtab {

/// Deviation of one rail head from its nominal line, with slopes and curvatures along x.
struct RailDeviation {
  double y = 0, z = 0;              ///< [m]
  double dy_dx = 0, dz_dx = 0;      ///< [-]
  double ddy_dx2 = 0, ddz_dx2 = 0;  ///< [1/m]
};

/// Track irregularity of both rails over x: C2 cubic splines through measured points; zero outside them.
class Irregularity {
 public:
  Irregularity() = default;  ///< a perfect track
  /// Columns of equal length, x strictly increasing. @throws InputError
  Irregularity(std::vector<double> x, std::vector<double> y_left, std::vector<double> z_left,
               std::vector<double> y_right, std::vector<double> z_right);

  [[nodiscard]] RailDeviation at(RailSide side, double x) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return x_.empty(); }

 private:
  std::vector<double> x_;
  // implementer: spline coefficients of the four columns
};

/// Read "x,y_left,z_left,y_right,z_right" with a header row that names the unit of each column ("x[m],y_left[mm],...").
/// @throws InputError with file and line
[[nodiscard]] Irregularity read_irregularity(const std::filesystem::path& file);

}  // namespace railtab
