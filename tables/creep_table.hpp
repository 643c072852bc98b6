#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

/// How a creep table is laid out and interpolated.
///
/// `smooth`: cubic B-splines over the coordinates of creep_coordinates.hpp, in which all creepages from zero to
/// infinity lie in a bounded box and the exact symmetries are end conditions. Command line: "default".
/// `paper`: linear interpolation over a/b and the three normalised creepages [MontenegroCalcada2023, Sec. 3.4.2].
/// "paper".
enum class CreepTableLayout { smooth, paper };

[[nodiscard]] std::string_view creep_table_layout_name(CreepTableLayout layout) noexcept;
/// "default" or "paper". @throws InputError
[[nodiscard]] CreepTableLayout creep_table_layout(std::string_view name);

/// Everything that a creep table file holds: normalised creep forces (G = μF_n = √(ab) = 1) at the nodes of a grid of
/// four axes.
struct CreepTableData {
  CreepTableLayout layout = CreepTableLayout::smooth;
  double poisson = 0.28;
  int elements = 40;  ///< of the exact solution along each axis of the ellipse
  /// smooth: a/b, radius t, polar angle α, azimuth β (CreepPoint). paper: a/b, υx, υy (both >= 0), φ (both signs).
  std::array<std::vector<double>, 4> nodes;
  double ratio_stretch = 0.0;  ///< smooth only: of squeezed_ratio(), in which the axis of a/b is uniform
  double radius_unit = 0.0;    ///< smooth only: t = ρ/(ρ + radius_unit)
  /// F_x, F_y, M_z at all nodes, axes in the order above, the last one fastest, component fastest of all.
  /// smooth: divided by t, the moment also by CreepScale::moment. paper: as they are.
  std::vector<double> values;
  /// Options and measured errors, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;
  TableProvenance provenance;
};

/// Force and its derivatives at one query, or at several side by side, normalised; order F_x, F_y, M_z and υx, υy, φ.
template <class V>
struct CreepLookupOf {
  std::array<V, 3> force{};
  std::array<std::array<V, 3>, 3> derivative{};  ///< [i][j] = d force_i / d creepage_j, at constant a/b
  std::array<V, 3> by_ratio{};                   ///< d force_i / d(a/b), at constant creepage; of jet() only
  bool inside = false;                           ///< false outside the table: force and derivative are zero
};
using CreepLookup = CreepLookupOf<double>;

class CreepSpline;
class GridAxis;

/// Look-up: const, allocation-free, thread-safe.
class CreepTable {
 public:
  /// @throws InputError where nodes are out of order or shapes disagree.
  explicit CreepTable(CreepTableData data);
  ~CreepTable();
  CreepTable(CreepTable&&) noexcept;
  CreepTable& operator=(CreepTable&&) noexcept;

  /// smooth: inside for a/b within the axis and every finite creepage; C2 except at zero creepage, where it is C1.
  /// paper: inside for a/b and all creepages within the axes; continuous, the derivatives are those of the cell.
  [[nodiscard]] CreepLookup lookup(double ratio, const std::array<double, 3>& creepage) const noexcept;
  /// lookup() with the derivatives with respect to a/b.
  [[nodiscard]] CreepLookup jet(double ratio, const std::array<double, 3>& creepage) const noexcept;

  /// The force of lookup() alone.
  [[nodiscard]] std::array<double, 3> force(double ratio, const std::array<double, 3>& creepage) const noexcept;
  /// force() and jet() of queries side by side. @pre inside
  [[nodiscard]] std::array<WheelLanes, 3> force(const WheelLanes& ratio,
                                                const std::array<WheelLanes, 3>& creepage) const noexcept;
  [[nodiscard]] CreepLookupOf<WheelLanes> jet(const WheelLanes& ratio,
                                              const std::array<WheelLanes, 3>& creepage) const noexcept;

  /// Of the smooth layout without `values`, in whose place look-ups use the spline's coefficients.
  [[nodiscard]] const CreepTableData& data() const noexcept { return data_; }
  /// Memory that look-ups use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  CreepTableData data_;
  std::unique_ptr<const CreepSpline> spline_;  ///< smooth layout
  std::vector<GridAxis> axes_;                 ///< paper's layout
};

}  // namespace railtab
