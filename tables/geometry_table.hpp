#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "railtab/tables/geometry_leaf.hpp"
#include "railtab/tables/loaded_table.hpp"
#include "railtab/tables/profile_knots.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

inline constexpr int most_axis_cells = 1'000'000;  ///< of one axis: the cells of three can be counted

/// An axis of a table's root grid: `cells` of equal width between low and high; one cell and low = high where the
/// quantity is held fixed.
struct TableAxis {
  double low = 0.0;
  double high = 0.0;
  int cells = 1;

  [[nodiscard]] bool fixed() const noexcept { return low == high; }
  bool operator==(const TableAxis&) const = default;
};

/// A node of the tree over one root cell, in 32 bits: the last two are the axis along which the cell is halved (0
/// lateral, 1 yaw², 2 roll), the others the index of the lower half's node, the upper half's is the next; or the last
/// two are 3 and the others the index of the leaf.
struct CellNode {
  static constexpr std::uint32_t leaf_mark = 3;
  static constexpr std::uint32_t most = (1U << 30) - 1;  ///< largest index

  [[nodiscard]] static constexpr std::uint32_t halved(std::uint32_t axis, std::uint32_t lower) noexcept {
    return lower << 2 | axis;
  }
  [[nodiscard]] static constexpr std::uint32_t leaf(std::uint32_t index) noexcept { return index << 2 | leaf_mark; }
  [[nodiscard]] static constexpr bool is_leaf(std::uint32_t node) noexcept { return (node & 3U) == leaf_mark; }
  [[nodiscard]] static constexpr std::uint32_t axis(std::uint32_t node) noexcept { return node & 3U; }
  [[nodiscard]] static constexpr std::uint32_t index(std::uint32_t node) noexcept { return node >> 2; }
};

/// Contact geometry of a pair over lateral shift, yaw and roll: a grid of root cells, each halved where it had to be.
///
/// Axes: lateral = y - R0·roll [m] (roll about the wheelset centre shears the contact), yaw² [rad²] (the geometry is
/// exactly even in yaw, and nearly linear in its square), roll [rad]. Root cells are counted lateral fastest, then
/// yaw², then roll.
///
/// A leaf lists the branches, the local minima of the wheel-rail distance, that a wheel can touch on there. A branch is
/// four polynomials of the leaf's local coordinates (branch_terms()), of a wheel that just touches on this branch:
/// z_touch [m], s_wheel [m], s_rail [m] and n_y n_z [-], the product of the lateral and the vertical component of the
/// contact normal (into the rail).
struct GeometryTableData {
  ProfileKnots wheel, rail;
  double track_gauge = 0, gauge_height = 0, flange_back = 0, nominal_radius = 0;  ///< [m]
  TableAxis lateral, yaw_squared, roll;
  TableShard shard;  ///< of the root cells, root_range() of it is here
  /// The root cells' nodes first, in their order; then the nodes below, each root cell's together.
  std::vector<std::uint32_t> node;
  std::vector<std::uint32_t> leaf_branch;  ///< number of branches of each leaf
  /// Per leaf: if a query lowers the wheel further [m] below first touch than this, the leaf's branches may not be all
  /// that touch. 0: not to be trusted at any height.
  std::vector<float> trusted_lowering;
  std::vector<float> coefficient;  ///< per branch, in the order of the leaves: branch_terms() times four quantities
  double tolerance = 0;            ///< penetration error the table was made for [m]
  std::optional<LoadedTableData> loaded;  ///< the loaded contact of the pair, where the file holds it
  /// Measured error statistics and options, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;
  TableProvenance provenance;
};

/// First root cell of a shard and the first one behind it, of `roots` in all.
[[nodiscard]] std::pair<std::int64_t, std::int64_t> root_range(const TableShard& shard, std::int64_t roots) noexcept;
[[nodiscard]] std::int64_t root_cells(const GeometryTableData& data) noexcept;

/// The terms at a point, the first branch_terms() of them, in the order of the stored coefficients.
[[nodiscard]] std::array<double, most_branch_terms> branch_monomials(bool yaw_axis, bool roll_axis, double a, double b,
                                                                     double c) noexcept;

/// Look-up over the stored cells: const, allocation-free, thread-safe.
class GeometryTable {
 public:
  /// @throws InputError where shapes disagree, a tree is not one, a number is not finite, or the data are a part only.
  explicit GeometryTable(GeometryTableData data);

  static constexpr int max_branches = 8;
  enum class Status : std::uint8_t { inside, outside };
  struct Lookup {
    std::array<BranchStart, max_branches> branch;
    int count = 0;
    /// Largest height of the wheel below first touch on the lowest of `branch` at which these are all that can be in
    /// contact [m]. 0: not to be trusted at any height.
    double trusted_lowering = 0;
    double first_touch = 0;  ///< least z_touch of the branches [m]
    Status status = Status::outside;
  };

  /// The leaf of (y, yaw, roll). Outside the axes, or off a fixed one by more than 1e-12: without branches, not inside.
  /// Most leaves are whole root cells: the way to them has no loop.
  /// @param y of the wheelset centre [m]; @param yaw, roll [rad]
  [[nodiscard]] GeometryLeaf leaf(double y, double yaw, double roll) const noexcept;

  /// The branches of the leaf of (y, yaw, roll), with their starts for a wheel whose centre is at height z [m].
  [[nodiscard]] Lookup lookup(double y, double z, double yaw, double roll) const noexcept;

  /// Without `coefficient`, which coefficients() has.
  [[nodiscard]] const GeometryTableData& data() const noexcept { return data_; }
  /// GeometryTableData::coefficient.
  [[nodiscard]] std::span<const float> coefficients() const noexcept;
  /// Memory that look-ups use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// The same of the table that these data, with or without coefficients, would make.
  [[nodiscard]] static std::size_t bytes_of(const GeometryTableData& data) noexcept;

 private:
  // As in the data, but a leaf's node holds the number of its branches in four bits and the first of them in 26.
  struct Node {
    std::uint32_t code;
    float trusted_lowering;
  };
  struct alignas(64) Line {
    std::array<float, 16> value;
  };
  struct Axis {
    double low = 0, inverse_width = 0;
    std::int32_t cells = 1;
    bool fixed = true;
    [[nodiscard]] double place(double at) const noexcept { return (at - low) * inverse_width; }
    [[nodiscard]] bool holds(double place) const noexcept { return place >= 0 && place <= cells; }
    [[nodiscard]] std::int32_t cell(double place) const noexcept {
      return std::min(static_cast<std::int32_t>(place), cells - 1);
    }
  };

  struct Place {  // a leaf's node and a point in it
    Node node;
    LocalPoint point;
    float per_metre;
  };

  void pack();
  [[nodiscard]] Place descend(Node root, double lateral, double squared, double rolled) const noexcept;

  GeometryTableData data_;
  std::array<Axis, 3> axis_{};
  double fixed_yaw_ = 0;  // where that axis is fixed
  int terms_ = 0;
  std::vector<Node> node_;
  std::vector<Line> line_;
};

inline GeometryLeaf GeometryTable::leaf(double y, double yaw, double roll) const noexcept {
  GeometryLeaf leaf;
  const auto& [across, along, about] = axis_;
  const double lateral = across.place(y - data_.nominal_radius * roll);
  const double squared = along.place(yaw * yaw);
  const double rolled = about.place(roll);
  // On a fixed axis it is the yaw, not its square, that has to agree. NaN is outside.
  leaf.inside = across.holds(lateral) &&
                (along.fixed ? std::abs(std::abs(yaw) - fixed_yaw_) <= 1e-12 : along.holds(squared)) &&
                (about.fixed ? std::abs(roll - about.low) <= 1e-12 : about.holds(rolled));
  if (!leaf.inside) return leaf;
  const std::int32_t cell_0 = across.cell(lateral);
  const std::int32_t cell_1 = along.fixed ? 0 : along.cell(squared);
  const std::int32_t cell_2 = about.fixed ? 0 : about.cell(rolled);
  const std::int64_t root = (static_cast<std::int64_t>(cell_2) * along.cells + cell_1) * across.cells + cell_0;
  const double part_0 = lateral - cell_0;
  const double part_1 = squared - cell_1;
  const double part_2 = rolled - cell_2;
  const auto local = [](double part) { return static_cast<float>(2.0 * part - 1.0); };
  Place place{node_[static_cast<std::size_t>(root)],
              {local(part_0), local(part_1), local(part_2)},
              static_cast<float>(2.0 * across.inverse_width)};
  if (!CellNode::is_leaf(place.node.code)) place = descend(place.node, part_0, part_1, part_2);
  leaf.point = place.point;
  if (along.fixed) leaf.point.b = leaf.point.c;
  leaf.per_metre = place.per_metre;
  leaf.trusted_lowering = place.node.trusted_lowering;
  const std::uint32_t packed = CellNode::index(place.node.code);
  leaf.count = static_cast<int>(packed & 15U);
  leaf.terms = terms_;
  leaf.coefficient = line_.data()->value.data() + static_cast<std::ptrdiff_t>(packed >> 4) * terms_ * branch_quantities;
  return leaf;
}

}  // namespace railtab
