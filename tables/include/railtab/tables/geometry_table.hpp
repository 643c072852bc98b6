#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "railtab/tables/profile_knots.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

/// An axis of a table: strictly increasing nodes, or a single node for a quantity held fixed.
class GridAxis {
 public:
  /// @throws InputError naming the axis and the first node that breaks the order.
  GridAxis(std::string name, std::vector<double> nodes);

  struct Cell {
    int index;        ///< left node
    double fraction;  ///< position in the cell, 0..1
    double width;     ///< of the cell; 0 on an axis of one node
    bool inside;      ///< false outside the axis: leaving the table is a status, never a clamp
  };
  /// The cell that holds `value`; on an axis of one node, inside means within 1e-12 of it. NaN is outside.
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
/// "Smooth" as far as the profiles are: s_wheel and s_rail have slope jumps where the contact passes a joint of a
/// profile. Values at the nodes of the box [first, first+size) of the grid, y fastest; NaN where the branch does not
/// exist. A wheel that just touches the rail on this branch has its centre at z_touch and the pair at (s_wheel,
/// s_rail).
struct GeometryBranch {
  std::array<int, 3> first{};                    ///< first node along lateral, yaw, roll
  std::array<int, 3> size{};                     ///< nodes along lateral, yaw, roll
  std::vector<double> z_touch, s_wheel, s_rail;  ///< [m]
  std::vector<double> z_touch_dy, s_wheel_dy,
      s_rail_dy;  ///< derivative along the lateral axis, exact from the geometry
};

/// A stretch of the wheel profile that a cell leaves to the search: there a minimum is born, dies or folds in the cell.
struct SearchWindow {
  std::int64_t cell = 0;         ///< lateral fastest, then yaw², roll
  double s_low = 0, s_high = 0;  ///< arc length on the wheel profile [m]
};

/// Contact geometry of a pair over lateral shift, yaw and roll: branches, and the cells that cannot be trusted.
///
/// Axes: lateral = y - R0·roll [m] (roll about the wheelset centre shears the branches), yaw² [rad²] (the geometry is
/// exactly even in yaw, and nearly linear in its square), roll [rad].
struct GeometryTableData {
  ProfileKnots wheel, rail;
  double track_gauge = 0, gauge_height = 0, flange_back = 0, nominal_radius = 0;  ///< [m]
  std::vector<double> lateral, yaw_squared, roll;                                 ///< nodes of the axes
  std::vector<GeometryBranch> branches;
  /// Per cell (lateral fastest): if a query lowers the wheel this far [m] below first touch on the lowest branch that
  /// the table holds for the cell, the branches are not enough: there one begins, ends or folds. 0 where such a branch
  /// may lie lower than all that the table holds. Infinity where the branches always suffice.
  std::vector<double> trusted_lowering;
  /// In the order of their cells, apart from each other. Up to searched_lowering [m] below that first touch the
  /// branches of the cell and the minima inside its windows are all that can be in contact.
  std::vector<SearchWindow> windows;
  double searched_lowering = 0;
  double tolerance = 0;  ///< penetration error the table was made for [m]
  /// Measured error statistics and options, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;
  TableProvenance provenance;
};

/// A branch at one query: where a touching wheel stands and where it touches, with d/dy at constant yaw and roll.
struct BranchValue {
  double z_touch, z_touch_dy;  ///< [m], [-]
  double s_wheel, s_wheel_dy;  ///< [m], [-]
  double s_rail, s_rail_dy;    ///< [m], [-]
};

/// Look-up over the stored branches: const, allocation-free, thread-safe.
///
/// Invariant: every branch lies in the grid; a branch that exists at some corners of a cell but not at all of them has
/// a finite trusted_lowering there.
class GeometryTable {
 public:
  /// @throws InputError where shapes disagree, an axis is not increasing, a number is not finite where it must be, or a
  ///         cell with an incomplete branch is not flagged.
  explicit GeometryTable(GeometryTableData data);

  static constexpr int max_branches = 8;
  enum class Status : std::uint8_t { inside, outside };
  struct Lookup {
    std::array<BranchValue, max_branches> branch;
    int count = 0;
    /// Of the cell [m]: largest height of the wheel below first touch on the lowest of `branch` at which these are all
    /// that can be in contact. 0: not to be trusted at any height; so where the cell has more than max_branches.
    double trusted_lowering = 0;
    std::span<const SearchWindow> windows;  ///< of the cell; none where the whole profile has to be searched
    Status status = Status::outside;
  };

  /// All branches that exist in the whole cell of (y, yaw, roll), interpolated by cubic Hermite along the lateral axis
  /// and C1 across yaw² and roll (Hermite with finite-difference slopes inside the branch).
  /// @param y lateral shift of the wheelset centre [m]; @param yaw, roll [rad]. Outside the axes, or off the single
  /// node of one by more than 1e-12: status outside and no branch.
  [[nodiscard]] Lookup lookup(double y, double yaw, double roll) const noexcept;

  [[nodiscard]] const GeometryTableData& data() const noexcept { return data_; }
  /// Memory that look-ups use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  /// Where a cell finds its branches: packed_ offsets of the branch's first corner in cell_branch_[first, first+count).
  struct CellEntry {
    std::uint32_t first;
    std::uint32_t count;
    std::uint32_t first_window;
    std::uint16_t windows;
    bool overflow;  ///< more than max_branches
    double trusted_lowering;
  };
  /// A branch in one cell: offset of its first corner in packed_ and strides to the neighbours.
  struct BranchCell {
    std::size_t offset;
    std::uint32_t yaw_stride, roll_stride;
  };

  void pack_branches();
  void index_cells();
  void index_windows();

  GeometryTableData data_;
  GridAxis lateral_, yaw_squared_, roll_;
  int slopes_ = 1;              ///< derivative combinations per node: 1, 2 (yaw² or roll), 4 (both)
  std::vector<double> packed_;  ///< per branch and node: per combination z, z', s_w, s_w', s_r, s_r'
  std::vector<std::size_t> branch_offset_;
  std::vector<CellEntry> cell_;
  std::vector<BranchCell> cell_branch_;
};

}  // namespace railtab
