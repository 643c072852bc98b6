#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// The loaded contact of a pair: the half-space solution over all poses of a wheelset against its right rail head.
///
/// Without friction the contact is conservative: the force on the rail is the derivative of its elastic energy U with
/// respect to the pose (y, z, roll, yaw). Stored is the height z of the wheelset at equal energy, over the level
/// w = U^(1/5) [J^(1/5)], the reduced lateral shift y0, the reduced roll r and yaw²:
///
///   U = w⁵,  z = Z(w, y0, r, yaw²),  y = Y(y0, r, yaw²),  r = roll + climb·y.
///
/// For a Hertzian contact z is a parabola of w whose vertex is the height of first touch. Z is bicubic in (w, y0) with
/// exact derivatives at the nodes, ∂z/∂w = 5 w⁴/F_z and ∂z/∂y = −(F_y − climb·M_roll)/F_z, cubic between nodes of roll,
/// and a polynomial in yaw². At y0 the contact jumps between the same places of the rail whatever roll and yaw
/// (docs/theory/contact_table.md).
struct LoadedTableData {
  std::vector<double> lateral;      ///< nodes of y0, increasing [m]
  std::vector<double> roll;         ///< nodes of r, two or more, increasing [rad]
  std::vector<double> yaw_squared;  ///< nodes, increasing [rad²]; the first may stand for 0
  int levels = 0;                   ///< nodes of w, equally spaced from 0
  double largest_level = 0.0;       ///< [J^(1/5)]
  double climb = 0.0;               ///< roll that a climbing wheelset loses per lateral shift, 0..2 [rad/m]
  /// y and ∂y/∂y0 at the nodes (lateral, roll, yaw²), quantity fastest [m, 1].
  std::vector<double> shift;
  /// Height of first touch at the nodes (lateral, roll, yaw²) [m].
  std::vector<double> touch;
  /// z less that of first touch, ∂z/∂w, ∂z/∂y0, ∂²z/∂w∂y0 at the nodes (lateral, level, roll, yaw²), quantity fastest.
  std::vector<float> height;
  /// The rail's surface in parts, divided where the contact jumps: arc lengths on the rail profile, increasing [m].
  std::vector<double> cut;
  /// At the nodes (lateral, level): the parts that press anywhere in roll and yaw, bit by bit from the first.
  std::vector<std::uint32_t> pressed;
  /// LoadedPart of these, in the order of its members, semi-axes and pressure over w, densities over w², arm_x over
  /// yaw; at the nodes (lateral, level, part, roll, yaw²), quantity fastest.
  std::vector<float> part;
  double contact_modulus = 0.0;  ///< E* of both bodies [Pa]
  /// Options and measured errors, name -> value; written as attributes.
  std::vector<std::pair<std::string, double>> statistics;

  /// 99th percentile of the relative error of the force above 5 kN, as the table's generation has measured it; 0 where
  /// it has not.
  [[nodiscard]] double certified_force_error() const noexcept;
  [[nodiscard]] std::size_t parts() const noexcept { return cut.size() + 1; }
  [[nodiscard]] std::size_t columns() const noexcept { return roll.size() * yaw_squared.size(); }
  [[nodiscard]] double roll_at(double reduced_roll, double y) const noexcept { return reduced_roll - climb * y; }
};

/// What presses on one part of the rail's surface: numbers, or their derivatives.
template <class T>
struct LoadedPartOf {
  T share;                ///< of the vertical force on the rail, without friction [-]
  T arm_x, arm_y, arm_z;  ///< mean of the wheel's points in contact, from the wheelset centre [m]
  T angle;                ///< contact angle: that of the part's force [rad]
  T a, b;                 ///< semi-axes of the ellipse that rolls as the part (EllipseOfPressure in tablegen) [m]
  T peak;                 ///< largest force per length across the rail [N/m]
  T saddle;               ///< force per length at the part's upper end [N/m]
  T s_rail, s_wheel;      ///< mean arc lengths on the profiles [m]
  T pressure;             ///< largest [Pa]

  static constexpr std::size_t quantities = 12;
  static constexpr std::size_t of_one = 7;  ///< of these, what the force of a part by itself follows from
  /// @pre quantity < quantities
  [[nodiscard]] T& operator[](std::size_t quantity) noexcept { return this->*member(quantity); }
  [[nodiscard]] const T& operator[](std::size_t quantity) const noexcept { return this->*member(quantity); }
  [[nodiscard]] std::array<T, quantities> values() const noexcept {
    std::array<T, quantities> v;
    for (std::size_t q = 0; q < quantities; ++q) v[q] = (*this)[q];
    return v;
  }
  [[nodiscard]] static LoadedPartOf of(const std::array<T, quantities>& v) noexcept {
    LoadedPartOf part;
    for (std::size_t q = 0; q < quantities; ++q) part[q] = v[q];
    return part;
  }

 private:
  static constexpr T LoadedPartOf::*member(std::size_t quantity) noexcept {
    constexpr std::array members{&LoadedPartOf::share,  &LoadedPartOf::arm_x,   &LoadedPartOf::arm_y,
                                 &LoadedPartOf::arm_z,  &LoadedPartOf::angle,   &LoadedPartOf::a,
                                 &LoadedPartOf::b,      &LoadedPartOf::peak,    &LoadedPartOf::saddle,
                                 &LoadedPartOf::s_rail, &LoadedPartOf::s_wheel, &LoadedPartOf::pressure};
    return members[quantity];
  }
};
using LoadedPart = LoadedPartOf<double>;

/// Containers of four numbers and of 4 × 4: Eigen's of single ones.
template <class V>
struct LoadedNumbers {
  using Vector = std::array<V, 4>;
  using Matrix = std::array<std::array<V, 4>, 4>;
};
template <>
struct LoadedNumbers<double> {
  using Vector = Eigen::Vector4d;
  using Matrix = Eigen::Matrix4d;
};

/// The contact at a pose, or at several side by side. Generalised forces on the rail, order y, z, roll, yaw: the
/// derivatives of the energy with respect to the wheelset's motions [N, N m].
template <class V>
struct LoadedLookupOf {
  static constexpr std::size_t capacity = 6;
  /// Share of the table in the answer: 1 inside, 0 outside, smooth between over a margin inside its border. Where 0,
  /// what follows is zero; side by side, parts hold where the energy is above zero.
  V table_share{};
  V energy{};  ///< U [J]; 0: no contact
  typename LoadedNumbers<V>::Vector force = [] {
    if constexpr (std::is_same_v<V, double>) {
      return Eigen::Vector4d(Eigen::Vector4d::Zero());
    } else {
      return typename LoadedNumbers<V>::Vector{};
    }
  }();
  std::size_t parts = 0;  ///< of the pose that has most
  /// The first `parts`, in increasing arc length on the rail, each with a share; the others are not initialised. A pose
  /// that has fewer has the share 0 in their place.
  std::array<LoadedPartOf<V>, capacity> part;

  [[nodiscard]] V largest_pressure() const noexcept {  ///< [Pa]
    V largest{};
    for (std::size_t p = 0; p < parts; ++p) {
      largest = select((part[p].share > V{}) & (part[p].pressure > largest), part[p].pressure, largest);
    }
    return largest;
  }
};
using LoadedLookup = LoadedLookupOf<double>;

/// Derivatives with respect to the pose.
template <class V>
struct LoadedSlopesOf {
  typename LoadedNumbers<V>::Matrix stiffness;  ///< of the forces; zero without contact
  /// Of the parts, as many as these, along y, z, roll, yaw. Where no pose has several parts the first
  /// LoadedPartOf::of_one quantities, else all.
  std::array<LoadedPartOf<std::array<V, 4>>, LoadedLookup::capacity> part;
};
using LoadedSlopes = LoadedSlopesOf<double>;

/// Height and lateral position of the wheelset centre [m] (WheelsetPose), roll and yaw [rad].
template <class V>
struct LoadedPoseOf {
  V y, z, roll, yaw;
};

/// A larger certified error is that of a pair whose jumps come and go with roll and yaw: forces are not read from such
/// a table unless asked for.
inline constexpr double largest_certified_force_error = 0.05;

/// [rad/m]. S1002 on two rails 60E1 rolls by some 1.7 rad/m from a shift of 7 mm to one of 10 mm.
inline constexpr double largest_climb = 2.0;

/// @throws InputError "source: name" where shapes disagree or nodes are out of order
void require_consistent(const LoadedTableData& table, const std::string& source);

/// Look-up: const, allocation-free, thread-safe. Energy and forces are continuous; stiffness and the parts' derivatives
/// jump at the borders of cells.
class LoadedTable {
 public:
  /// @throws InputError as require_consistent()
  explicit LoadedTable(LoadedTableData data);

  static constexpr std::size_t most_rolls = 20001, most_yaws = 9;  ///< nodes
  static constexpr std::size_t rolls_read = 4;                     ///< by one look-up, at most
  static constexpr double border = 0.05;  ///< width of the blend, share of the range of each axis

  /// @param y, z of the wheelset centre [m] (WheelsetPose) @param roll, yaw [rad]
  [[nodiscard]] LoadedLookup lookup(double y, double z, double roll, double yaw) const noexcept {
    LoadedLookup result;
    find<false, double>({y, z, roll, yaw}, result, nullptr);
    return result;
  }
  /// The same with derivatives; those of the parts are set where there is contact.
  [[nodiscard]] LoadedLookup lookup(double y, double z, double roll, double yaw, LoadedSlopes& slopes) const noexcept {
    LoadedLookup result;
    find<true, double>({y, z, roll, yaw}, result, &slopes);
    return result;
  }
  /// Of one pose, or of several side by side (V = WheelLanes). @param derivatives where `slopes`
  template <bool slopes, class V>
  void find(const LoadedPoseOf<V>& pose, LoadedLookupOf<V>& result, LoadedSlopesOf<V>* derivatives) const noexcept;

  /// Without the parts, which are kept in another form.
  [[nodiscard]] const LoadedTableData& data() const noexcept { return data_; }
  /// Memory that look-ups use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  static constexpr std::size_t buckets = 2048;  ///< of bucket_

  enum Direction : std::size_t;
  template <class V>
  struct Lagrange;
  template <class V>
  struct Weights;
  template <bool slopes>
  struct NodeSums;
  /// By Direction: y and ∂y/∂y0 at both ends of a lateral cell, then both heights of first touch; two idle.
  template <bool slopes>
  using CellEnds = std::array<Lanes, slopes ? 6 : 3>;
  template <bool slopes, class V>
  class LookUp;
  /// Cubic interpolation over roll between two nodes: value and slope are continuous at the nodes, where the slope is
  /// that of the parabola through the three nearest.
  struct RollCubic {
    RollCubic(const std::vector<double>& node, std::size_t low) noexcept;

    std::size_t first;      ///< of the nodes that are read, rolls_read or all
    double begin, inverse;  ///< the lower node [rad], one over the distance to the next
    /// Weights of these nodes: coefficients of powers of the place between the two nodes, node fastest.
    std::array<std::array<double, rolls_read>, 4> power;
  };
  struct Corners;
  struct PartPlace;
  struct PartSums;
  void weight_parts();
  template <class V>
  [[nodiscard]] V margin_share(const V& roll, const V& yaw) const noexcept;
  [[nodiscard]] const double* ends_of(std::size_t cell, std::size_t column) const noexcept {
    return &ends_[Lanes::count * (cell * data_.columns() + column)];
  }
  /// The lateral cell of a pose, or one near it.
  template <bool slopes>
  [[nodiscard]] std::size_t guess_cell(double y, const NodeSums<slopes>& sums) const noexcept;
  /// The lateral cell of a pose, from one near it, and what its ends have. False where y is outside.
  template <bool slopes>
  [[nodiscard]] bool find_cell(double y, const NodeSums<slopes>& sums, std::size_t& cell,
                               CellEnds<slopes>& ends) const noexcept;
  /// The level below a height above first touch, or one near it; 0 also below. @param t place in the lateral cell
  [[nodiscard]] int guess_level(double above, std::size_t node, double t) const noexcept;
  template <bool slopes>
  void add_corners(std::size_t node, int level, const NodeSums<slopes>& sums, const CellEnds<slopes>& ends,
                   Corners& corners) const noexcept;
  /// Ask the memory for what the next steps of a look-up will read: of the lateral cell, to guess the level, of the
  /// corners, of the parts.
  void fetch_ends(std::size_t cell, std::size_t first, std::size_t count) const noexcept;
  void fetch_rise(std::size_t node) const noexcept;
  void fetch_corners(std::size_t node, int level, std::size_t first, std::size_t count) const noexcept;
  void fetch_parts(const PartPlace& place) const noexcept;
  template <bool slopes>
  [[nodiscard]] bool sum_part(const PartPlace& place, std::size_t part, PartSums& sums) const noexcept;

  LoadedTableData data_;
  std::vector<double> ends_;  ///< of each lateral cell and column the eight numbers that CellEnds sums up
  /// As LoadedTableData::part, of each the share, the others weighted with it, and the square of the pressure. arm_y
  /// and arm_z less `reference_`, so that they are not rounded a second time.
  std::vector<float> weighted_part_;
  std::array<double, LoadedPart::quantities> reference_{};
  std::vector<double> displaced_;     ///< y − y0 of each lateral node and node of roll at the first node of yaw² [m]
  std::vector<float> rise_;           ///< of each (lateral, level), z − z_touch in the middle of roll at yaw 0
  std::vector<std::size_t> part_at_;  ///< of each (lateral, level), where its parts begin
  std::vector<std::uint32_t> bucket_;  ///< of equal stretches of y0, the node at or below their beginning
  std::vector<RollCubic> roll_cubic_;  ///< between nodes of roll
  std::vector<double> inverse_yaw_;    ///< inverse distances between nodes of yaw²
  double level_step_ = 0.0;
};

}  // namespace railtab
