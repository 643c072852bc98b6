#include "railtab/runtime/line/rail_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/linear_interpolation.hpp"

namespace railtab {
namespace {

constexpr double most = 2.0;

/// @param place name of a point for messages
template <class Place>
void check_friction(const std::vector<double>& x, const std::vector<double>& friction, const Place& place) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(friction[i] >= 0.0 && friction[i] <= most)) {
      throw input_error(place(i), fmt::format("a coefficient of friction of {}", friction[i]),
                        fmt::format("0 to {}", most));
    }
    if (i > 0 && !(x[i] > x[i - 1])) {
      throw input_error(place(i), fmt::format("x = {} m", x[i]),
                        fmt::format("more than {} m of the point before", x[i - 1]));
    }
  }
}

}  // namespace

RailFriction::RailFriction(std::vector<double> x, std::vector<double> left, std::vector<double> right)
    : x_(std::move(x)), value_{std::move(left), std::move(right)} {
  if (x_.empty() || value_[0].size() != x_.size() || value_[1].size() != x_.size()) {
    throw input_error("friction along the track", fmt::format("{} positions", x_.size()),
                      "as many coefficients of each rail, at least one");
  }
  for (const std::vector<double>& value : value_) {
    check_friction(x_, value, [](std::size_t i) { return fmt::format("friction along the track, point {}", i + 1); });
  }
}

double RailFriction::at(RailSide side, double x) const noexcept {
  const std::vector<double>& value = value_[static_cast<std::size_t>(side)];
  return interpolate(x_, value, x);
}

double RailFriction::largest() const noexcept {
  return std::max(std::ranges::max(value_[0]), std::ranges::max(value_[1]));
}

RailFriction read_rail_friction(const std::filesystem::path& file) {
  std::vector<FileColumn> columns = read_columns(file);
  if (columns.size() != 3 || columns[0].name != "x" || columns[1].name != "left" || columns[2].name != "right") {
    throw input_error(columns[0].place(0), names_of(columns), "x[m], left[1], right[1]");
  }
  static_cast<void>(factor_to_si(columns[0], {{"m", 1.0}}));
  require_argument(columns[0]);
  for (std::size_t c = 1; c < 3; ++c) {
    static_cast<void>(factor_to_si(columns[c], {{"1", 1.0}, {"-", 1.0}}));
    check_friction(columns[0].values, columns[c].values, [&](std::size_t i) { return columns[c].place(i + 1); });
  }
  return {std::move(columns[0].values), std::move(columns[1].values), std::move(columns[2].values)};
}

}  // namespace railtab
