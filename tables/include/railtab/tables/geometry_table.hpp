#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// An axis of a table: strictly increasing nodes, or a single node for a quantity held fixed.
class GridAxis {
 public:
  /// @throws InputError naming the axis and the first node that breaks the order.
  GridAxis(std::string name, std::vector<double> nodes);

  struct Cell {
    int index;         ///< left node
    double fraction;   ///< position in the cell, 0..1
    bool inside;       ///< false outside the axis: leaving the table is a status, never a clamp
  };
  [[nodiscard]] Cell locate(double value) const noexcept;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::vector<double>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] int size() const noexcept { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int cells() const noexcept { return size() > 1 ? size() - 1 : 1; }

 private:
  std::string name_;
  std::vector<double> nodes_;
  bool uniform_ = false;
  double inverse_step_ = 0.0;
};

/// One local minimum of the wheel-rail distance, followed as a smooth surface over the grid.
///
/// Values at the nodes of the box [first, first+size) of the grid, y fastest; NaN where the branch does not exist.
/// A wheel that just touches the rail on this branch has its centre at z_touch and the pair at (s_wheel, s_rail).
struct GeometryBranch {
  std::array<int, 3> first{};  ///< first node along lateral, yaw, roll
  std::array<int, 3> size{};   ///< nodes along lateral, yaw, roll
  std::vector<double> z_touch, s_wheel, s_rail;              ///< [m]
  std::vector<double> z_touch_dy, s_wheel_dy, s_rail_dy;     ///< derivative along the lateral axis, exact from the geometry
};

/// What the offline side stored beside the numbers.
struct TableProvenance {
  std::string program_version;
  std::string command_line;
  std::string created;  ///< ISO 8601, UTC
};

/// Contact geometry of a pair over lateral shift, yaw and roll: branches, and the cells that cannot be trusted.
///
/// Axes: lateral = y - R0·roll [m] (roll about the wheelset centre shears the branches), yaw² [rad²] (the geometry is
/// exactly even in yaw, and nearly linear in its square), roll [rad].
struct GeometryTableData {
  ProfileKnots wheel, rail;
  double track_gauge = 0, gauge_height = 0, flange_back = 0, nominal_radius = 0;  ///< [m]
  std::vector<double> lateral, yaw_squared, roll;  ///< nodes of the axes
  std::vector<GeometryBranch> branches;
  /// Per cell (lateral fastest): smallest height above first touch [m] of a branch that begins, ends or folds in the
  /// cell; a query that lowers the wheel that far must go to the online search. Infinity: the cell can be trusted.
  std::vector<double> trusted_lowering;
  double tolerance = 0;  ///< penetration error the table was made for [m]
  /// Measured error statistics and options, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;
  TableProvenance provenance;
};

/// A branch at one query: where a touching wheel stands and where it touches.
struct BranchValue {
  double z_touch, z_touch_dy;
  double s_wheel, s_rail;
};

/// Look-up over the stored branches: const, allocation-free, thread-safe.
class GeometryTable {
 public:
  /// @throws InputError where shapes disagree, an axis is not increasing or a number is not finite where it must be.
  explicit GeometryTable(GeometryTableData data);

  static constexpr int max_branches = 8;
  enum class Status : std::uint8_t { inside, outside };
  struct Lookup {
    std::array<BranchValue, max_branches> branch;
    int count = 0;
    double trusted_lowering = 0;  ///< of the cell [m]
    Status status = Status::outside;
  };

  /// All branches that exist in the cell of (y, yaw, roll), interpolated by cubic Hermite along the lateral axis and
  /// C1 across yaw² and roll.
  [[nodiscard]] Lookup lookup(double y, double yaw, double roll) const noexcept;

  [[nodiscard]] const GeometryTableData& data() const noexcept { return data_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  GeometryTableData data_;
  GridAxis lateral_, yaw_squared_, roll_;
};

}  // namespace railtab
