#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// Samples of a pair for screening: where along the wheel profile can there be contact at a pose? Heights are of
/// screening accuracy (linear between rail samples 0.05 mm apart); pairs are found on the profiles themselves.
///
/// Scan points stand at uniform arc length on the wheel; interval k lies between the points k and k+1. Intervals are
/// handled in blocks. Const, allocation-free queries.
class ContactScan {
 public:
  static constexpr int block_size = 16;
  static constexpr int most_blocks = 4096;
  /// Gap at the scan points of a block's intervals, one point more in front and two behind (a whole number of vector
  /// registers): element j belongs to scan point block·block_size - 1 + j. Infinity where there is no silhouette
  /// point or no rail below it [m].
  using BlockGaps = std::array<double, block_size + 4>;

  /// @throws InputError where spacing is not in (0, 1e-2] m or gives more than most_blocks blocks
  ContactScan(const WheelRailPair& pair, double spacing);

  [[nodiscard]] int blocks() const noexcept { return static_cast<int>(box_.size()); }
  [[nodiscard]] double spacing() const noexcept { return spacing_; }
  /// Arc length of scan point k on the wheel [m].
  [[nodiscard]] double s_wheel(int k) const noexcept { return s_begin_ + spacing_ * k; }

  /// A lower bound of every gap of a block, without looking at its points [m].
  [[nodiscard]] double gap_bound(int block, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                                 double dilation) const noexcept;
  /// Vertical gaps of a block's points to the rail. With `dilation` > 0: to the rail grown by a square of that half
  /// width, which holds every point that is nearer to the rail than `dilation` [m].
  void gaps(int block, const WheelsetCentre& centre, const PoseTrigonometry& trig, double dilation,
            BlockGaps& gap) const noexcept;

  /// Arc length of the rail's point at this y, to screening accuracy, for Newton's start; the nearer end outside [m].
  [[nodiscard]] double s_rail_at(double y) const noexcept;

 private:
  void sample_rail(const ProfileCurve& rail);
  void sample_wheel(const WheelRailPair& pair);
  void rail_heights(const BlockGaps& y, double shift, BlockGaps& height) const noexcept;
  [[nodiscard]] double lowest_rail_z(double y_from, double y_to) const noexcept;

  // Bounds of a block's scan points: axial position, radius, radius times slope.
  struct Box {
    double axial_least, axial_most, radius_most, lean_least, lean_most;
  };

  double spacing_ = 0.0;
  double s_begin_ = 0.0;
  int intervals_ = 0;
  // Scan points, one filler in front and fillers behind that round up to whole blocks.
  std::vector<double> axial_, radius_, slope_;
  std::vector<Box> box_;
  // Upper envelope of the rail over a uniform y axis, its arc length, and the least z of each group of samples.
  double rail_y_ = 0.0;
  std::vector<double> rail_z_, rail_s_, rail_group_z_;
};

}  // namespace railtab
