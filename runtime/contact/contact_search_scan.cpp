#include "railtab/runtime/contact/contact_search_scan.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

constexpr double rail_spacing = 0.05e-3;  // [m]
constexpr int group_size = 16;            // rail samples per group
constexpr double nowhere = -1e3;          // radius of a scan point that cannot touch: far above every rail [m]

}  // namespace

ContactScan::ContactScan(const WheelRailPair& pair, double spacing) {
  if (!(spacing > 0.0 && spacing <= 1e-2)) {
    throw input_error("spacing of the contact search", fmt::format("{} m", spacing), "a length in (0, 0.01] m");
  }
  const double length = pair.wheel().s_end() - pair.wheel().s_begin();
  if (length / spacing > most_blocks * block_size) {
    throw input_error("spacing of the contact search", fmt::format("{} m", spacing),
                      fmt::format("at least {} m for this wheel", length / (most_blocks * block_size)));
  }
  intervals_ = std::max(1, static_cast<int>(std::ceil(length / spacing)));
  spacing_ = length / intervals_;
  s_begin_ = pair.wheel().s_begin();
  sample_wheel(pair);
  sample_rail(pair.rail());
}

void ContactScan::sample_wheel(const WheelRailPair& pair) {
  const int blocks = (intervals_ + block_size - 1) / block_size;
  const auto size = static_cast<std::size_t>(blocks * block_size + 4);
  axial_.assign(size, 0.0);
  radius_.assign(size, nowhere);
  slope_.assign(size, 0.0);
  for (int k = 0; k <= intervals_; ++k) {
    const CurvePoint p = pair.wheel().at(std::min(s_wheel(k), pair.wheel().s_end()));
    if (!(p.dy > 0.0)) continue;  // the normal does not point down
    const auto i = static_cast<std::size_t>(k + 1);
    axial_[i] = pair.tape_circle_offset() + p.y;
    radius_[i] = pair.nominal_radius() + p.z;
    slope_[i] = p.dz / p.dy;
  }
  for (int b = 0; b < blocks; ++b) {
    Box box{infinity, -infinity, nowhere, infinity, -infinity};
    for (int j = 0; j < block_size + 4; ++j) {
      const auto i = static_cast<std::size_t>(b * block_size + j);
      if (radius_[i] == nowhere) continue;
      box.axial_least = std::min(box.axial_least, axial_[i]);
      box.axial_most = std::max(box.axial_most, axial_[i]);
      box.radius_most = std::max(box.radius_most, radius_[i]);
      box.lean_least = std::min(box.lean_least, radius_[i] * slope_[i]);
      box.lean_most = std::max(box.lean_most, radius_[i] * slope_[i]);
    }
    box_.push_back(box);
  }
}

void ContactScan::sample_rail(const ProfileCurve& rail) {
  // A polyline five times finer than the samples; at each sample's y the highest crossing (least z) is the envelope.
  const double length = rail.s_end() - rail.s_begin();
  const int pieces = static_cast<int>(std::ceil(length / (0.2 * rail_spacing)));
  std::vector<CurvePoint> line;
  line.reserve(static_cast<std::size_t>(pieces + 1));
  for (int i = 0; i <= pieces; ++i) line.push_back(rail.at(rail.s_begin() + length * i / pieces));
  const auto [left, right] =
      std::minmax_element(line.begin(), line.end(), [](const CurvePoint& p, const CurvePoint& q) { return p.y < q.y; });
  if (!(right->y - left->y > 4 * rail_spacing)) {
    throw input_error(fmt::format("profile {}", rail.knots().name), fmt::format("{} m wide", right->y - left->y),
                      fmt::format("a rail wider than {} m", 4 * rail_spacing));
  }
  rail_y_ = left->y;
  const auto size = static_cast<std::size_t>(std::floor((right->y - left->y) / rail_spacing)) + 1;
  rail_z_.assign(size, infinity);
  rail_s_.assign(size, rail.s_begin());
  for (int i = 0; i < pieces; ++i) {
    const CurvePoint& p = line[static_cast<std::size_t>(i)];
    const CurvePoint& q = line[static_cast<std::size_t>(i + 1)];
    const double low = (std::min(p.y, q.y) - rail_y_) / rail_spacing;
    const double high = (std::max(p.y, q.y) - rail_y_) / rail_spacing;
    for (auto k = static_cast<std::size_t>(std::ceil(std::max(low, 0.0))); k < size && static_cast<double>(k) <= high;
         ++k) {
      const double y = rail_y_ + rail_spacing * static_cast<double>(k);
      const double t = q.y == p.y ? 0.0 : (y - p.y) / (q.y - p.y);
      const double z = p.z + t * (q.z - p.z);
      if (z >= rail_z_[k]) continue;
      rail_z_[k] = z;
      rail_s_[k] = rail.s_begin() + length * (i + t) / pieces;
    }
  }
  for (std::size_t k = 0; k + 1 < size; k += group_size) {
    const std::size_t last = std::min(k + group_size, size - 1);
    rail_group_z_.push_back(*std::min_element(rail_z_.begin() + static_cast<std::ptrdiff_t>(k),
                                              rail_z_.begin() + static_cast<std::ptrdiff_t>(last) + 1));
  }
}

double ContactScan::s_rail_at(double y) const noexcept {
  const double q = (y - rail_y_) * (1.0 / rail_spacing);
  const auto last = static_cast<double>(rail_s_.size() - 1);
  return rail_s_[static_cast<std::size_t>(q > 0.0 ? (q < last ? q + 0.5 : last) : 0.0)];
}

double ContactScan::lowest_rail_z(double y_from, double y_to) const noexcept {
  constexpr double inverse_width = 1.0 / (rail_spacing * group_size);
  const auto count = static_cast<double>(rail_group_z_.size());
  const double from = (y_from - rail_y_) * inverse_width;
  const double to = (y_to - rail_y_) * inverse_width;
  if (!(to >= 0.0 && from <= count)) return infinity;
  const auto first = static_cast<std::size_t>(std::max(from, 0.0));
  const auto last = static_cast<std::size_t>(std::min(to, count - 1.0));
  double z = infinity;
  for (std::size_t i = std::min(first, last); i <= last; ++i) z = std::min(z, rail_group_z_[i]);
  return z;
}

double ContactScan::gap_bound(int block, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                              double dilation) const noexcept {
  const Box& box = box_[static_cast<std::size_t>(block)];
  if (box.radius_most == nowhere) return infinity;
  const double lean = trig.sin_yaw * trig.tan_yaw;
  const double y_least = trig.cos_yaw * box.axial_least - lean * box.lean_most;
  const double y_most = trig.cos_yaw * box.axial_most - lean * box.lean_least;
  // z between 0 and the radius: sections that lean so far that their point is higher are nearer to the axle.
  const double swing_least = std::min(0.0, trig.sin_roll * box.radius_most);
  const double swing_most = std::max(0.0, trig.sin_roll * box.radius_most);
  const double z_most =
      centre.z + trig.cos_roll * box.radius_most + std::max(trig.sin_roll * y_least, trig.sin_roll * y_most);
  const double from = centre.y + trig.cos_roll * y_least - swing_most - dilation;
  const double to = centre.y + trig.cos_roll * y_most - swing_least + dilation;
  return lowest_rail_z(from, to) - dilation - z_most;
}

void ContactScan::gaps(int block, const WheelsetCentre& centre, const PoseTrigonometry& trig, double dilation,
                       BlockGaps& gap) const noexcept {
  constexpr int n = std::tuple_size_v<BlockGaps>;
  using Row = Eigen::Array<double, n, 1>;
  using ConstRow = Eigen::Map<const Row>;
  const auto first = static_cast<std::size_t>(block * block_size);
  const ConstRow slope(slope_.data() + first);
  const ConstRow radius(radius_.data() + first);
  const ConstRow axial(axial_.data() + first);
  const double t2 = trig.tan_yaw * trig.tan_yaw;
  const Row y0 = trig.cos_yaw * (axial - t2 * radius * slope);
  // Where there is no silhouette point the square root is of zero, and the point at the axle's height: far above.
  const Row z0 = radius * (1.0 - t2 * slope.square()).max(0.0).sqrt();
  BlockGaps y;
  BlockGaps z;
  Eigen::Map<Row>(y.data()) = centre.y + trig.cos_roll * y0 - trig.sin_roll * z0;
  Eigen::Map<Row>(z.data()) = centre.z + trig.sin_roll * y0 + trig.cos_roll * z0;
  rail_heights(y, 0.0, gap);
  if (dilation > 0.0) {
    BlockGaps beside;
    for (const double shift : {-dilation, dilation}) {
      rail_heights(y, shift, beside);
      for (std::size_t j = 0; j < gap.size(); ++j) gap[j] = std::min(gap[j], beside[j]);
    }
  }
  for (std::size_t j = 0; j < gap.size(); ++j) {
    const double g = gap[j] - dilation - z[j];
    gap[j] = g < 1.0 ? g : infinity;  // no rail below or no silhouette point
  }
}

void ContactScan::rail_heights(const BlockGaps& y, double shift, BlockGaps& height) const noexcept {
  const double last = static_cast<double>(rail_z_.size() - 1);
  const double* const z = rail_z_.data();
  for (std::size_t j = 0; j < y.size(); ++j) {
    const double q = (y[j] + shift - rail_y_) * (1.0 / rail_spacing);
    const bool inside = q >= 0.0 && q < last;
    const double bounded = inside ? q : 0.0;
    const int i = static_cast<int>(bounded);
    const double value = z[i] + (bounded - i) * (z[i + 1] - z[i]);
    height[j] = inside ? value : infinity;
  }
}

}  // namespace railtab
