#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "railtab/tables/profile_knots.hpp"
#include "railtab/tables/provenance.hpp"
#include "railtab/tables/table_shard.hpp"

namespace railtab {

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
  /// Measured error statistics and options, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;
  TableProvenance provenance;
};

/// First root cell of a shard and the first one behind it, of `roots` in all.
[[nodiscard]] std::pair<std::int64_t, std::int64_t> root_range(const TableShard& shard, std::int64_t roots) noexcept;
[[nodiscard]] std::int64_t root_cells(const GeometryTableData& data) noexcept;

/// Local coordinates in a leaf, -1..1 on each axis, 0 on a fixed one: a lateral, b yaw², c roll.
struct LocalPoint {
  float a, b, c;
};

constexpr int branch_quantities = 4;
constexpr int most_branch_terms = 12;
/// Terms of a branch's polynomials, by the axes that are not fixed: 1 a a² a³, and with yaw² b b² ab a²b, and with
/// roll c c² ac bc. A single one of the two counts as b.
[[nodiscard]] constexpr int branch_terms(bool yaw_axis, bool roll_axis) noexcept {
  return 4 * (1 + static_cast<int>(yaw_axis) + static_cast<int>(roll_axis));
}
/// The terms at a point, the first branch_terms() of them, in the order of the stored coefficients.
[[nodiscard]] std::array<double, most_branch_terms> branch_monomials(bool yaw_axis, bool roll_axis, double a, double b,
                                                                     double c) noexcept;

/// Where Newton is to start for a wheel on one branch.
struct BranchStart {
  double z_touch;          ///< centre height of a wheel that just touches on this branch [m]
  double s_wheel, s_rail;  ///< the deepest pair, about [m]
};

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

  /// The branches of the cell of (y, yaw, roll), with starts for a wheel whose centre is at height z.
  /// A wheel at (y, z) with penetration d along n touches, moved back by d n, at the same pair: the start is the
  /// touching pair at y* = y - d n_y, where d = (z - z_touch) n_z.
  /// @param y, z of the wheelset centre [m]; @param yaw, roll [rad]. Outside the axes, or off a fixed one by more than
  /// 1e-12: status outside and no branch.
  [[nodiscard]] Lookup lookup(double y, double z, double yaw, double roll) const noexcept;

  /// What lookup() makes of the branches of one leaf.
  /// @param coefficient `count` branches of branch_terms(yaw_axis, roll_axis) x 4 floats, 16-byte aligned
  /// @param inverse_half_width of the leaf along the lateral axis [1/m]
  static void evaluate(const float* coefficient, int count, bool yaw_axis, bool roll_axis, const LocalPoint& point,
                       double inverse_half_width, double z, Lookup& result) noexcept;

  [[nodiscard]] const GeometryTableData& data() const noexcept { return data_; }
  /// Memory that look-ups use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;

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
    double low, inverse_width, cells;
  };
  struct Leaf {
    Node node;
    LocalPoint point;
    double inverse_half_width;  // [1/m]
  };

  void pack();
  [[nodiscard]] Leaf descend(Node node, const std::array<double, 3>& fraction) const noexcept;
  template <bool yaw_axis, bool roll_axis>
  void lookup(double y, double z, double yaw, double roll, Lookup& result) const noexcept;

  GeometryTableData data_;
  std::array<Axis, 3> axis_{};
  int terms_ = 0;
  std::vector<Node> node_;
  std::vector<Line> line_;
};

}  // namespace railtab
