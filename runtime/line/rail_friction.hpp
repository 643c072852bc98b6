#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "railtab/runtime/base/rail_side.hpp"

namespace railtab {

/// Coefficient of friction of both rails along the track: straight lines between the points given, the first and the
/// last value beyond them.
class RailFriction {
 public:
  /// @param x strictly increasing, at least 1 [m]; as many coefficients of each rail, 0..2
  /// @throws InputError naming the point
  RailFriction(std::vector<double> x, std::vector<double> left, std::vector<double> right);

  [[nodiscard]] double at(RailSide side, double x) const noexcept;
  [[nodiscard]] double largest() const noexcept;                      ///< of both rails
  [[nodiscard]] double begin() const noexcept { return x_.front(); }  ///< first and last point [m]
  [[nodiscard]] double end() const noexcept { return x_.back(); }

 private:
  std::vector<double> x_;
  std::array<std::vector<double>, 2> value_;  // by RailSide
};

/// Columns x[m], left[1], right[1] (docs/file_formats/histories.md). @throws InputError with file and line
[[nodiscard]] RailFriction read_rail_friction(const std::filesystem::path& file);

}  // namespace railtab
