#pragma once

#include <array>
#include <vector>

#include "railtab/tables/arc_tangent.hpp"
#include "railtab/tables/binade_polynomials.hpp"
#include "railtab/tables/creep_spline_jet.hpp"
#include "railtab/tables/creep_table.hpp"

namespace railtab {

/// The cubic B-spline of the smooth layout: coefficients of F_x/t, F_y/t, M_z/(t m) over squeezed a/b, t, α, β.
class CreepSpline {
 public:
  /// a/b of every table lies within these.
  static constexpr double least_ratio = 0x1p-10, ratio_end = 0x1p10;

  /// @param data of the smooth layout, checked
  explicit CreepSpline(const CreepTableData& data);

  [[nodiscard]] std::array<double, 3> force(double ratio, const std::array<double, 3>& creepage) const noexcept;
  [[nodiscard]] std::array<WheelLanes, 3> force(const WheelLanes& ratio,
                                                const std::array<WheelLanes, 3>& creepage) const noexcept;
  [[nodiscard]] CreepLookup lookup(double ratio, const std::array<double, 3>& creepage) const noexcept;
  /// With derivatives with respect to a/b.
  [[nodiscard]] CreepLookup jet(double ratio, const std::array<double, 3>& creepage) const noexcept;
  [[nodiscard]] CreepLookupOf<WheelLanes> jet(const WheelLanes& ratio,
                                              const std::array<WheelLanes, 3>& creepage) const noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return coefficient_.size() * sizeof(float); }

 private:
  template <class V>
  struct Direction;

  void set_coefficients(const CreepTableData& data);
  /// @param steps from the first nodes of the axes
  template <CreepWanted wanted>
  void evaluate(const std::array<double, 4>& steps, CreepSplineJet& jet) const noexcept;
  /// @pre the ratio lies in the table, squares of the creepages are finite
  template <CreepWanted wanted, class V>
  [[nodiscard]] CreepLookupOf<V> found(const V& ratio, const std::array<V, 3>& creepage) const noexcept;
  template <CreepWanted wanted>
  [[nodiscard]] CreepLookup found_if_inside(double ratio, const std::array<double, 3>& creepage) const noexcept;
  /// Creepages that are not finite, or so large that their squares would not be.
  [[nodiscard]] CreepLookup beyond(double ratio, const std::array<double, 3>& creepage) const noexcept;

  std::array<int, 4> last_cell_;
  std::array<double, 3> inverse_step_;  ///< of t, α, β
  std::array<std::size_t, 3> stride_;   ///< of a/b, t, α, in floats
  std::vector<float> coefficient_;
  double ratio_first_, ratio_last_, radius_unit_;
  /// Of a/b, without logarithm and roots: steps from the first node, and the numbers of CreepScale in their order.
  BinadePolynomials<8, 7, -10, 9> ratio_functions_;
  ArcTangent arc_tangent_;
};

}  // namespace railtab
