#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "railtab/tables/creep_table.hpp"

namespace railtab {

/// The cubic B-spline of the smooth layout: coefficients of F_x/t, F_y/t, M_z/(t m) over squeezed a/b, t, α, β.
class CreepSpline {
 public:
  /// @param data of the smooth layout, checked
  explicit CreepSpline(const CreepTableData& data);

  [[nodiscard]] CreepLookup lookup(double ratio, const std::array<double, 3>& creepage) const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return coefficient_.size() * sizeof(float); }

 private:
  static constexpr int components = 4;  // F_x, F_y, M_z, and one to fill the vector

  /// Where a coordinate lies: cell and fraction.
  struct Place {
    int cell;
    double fraction;
  };
  struct Axis {
    double first, inverse_step;
    int cells;
    [[nodiscard]] Place locate(double x) const noexcept;
  };
  struct Point;
  struct Jet;

  [[nodiscard]] Point locate(const Eigen::Array3d& u) const noexcept;
  [[nodiscard]] Jet evaluate(const Place& ratio, const Point& point) const noexcept;

  std::array<Axis, 4> axis_;
  std::array<std::size_t, 3> stride_;  ///< of a/b, t, α, in floats
  std::vector<float> coefficient_;
  double ratio_first_, ratio_last_, inverse_stretch_, radius_unit_;
};

}  // namespace railtab
