#include "railtab/runtime/line/body_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/linear_interpolation.hpp"

namespace railtab {

LoadHistory::LoadHistory(LoadArgument argument, std::vector<double> points, std::vector<ForceAndMoment> loads)
    : argument_(argument), points_(std::move(points)), loads_(std::move(loads)) {
  if (points_.empty() || points_.size() != loads_.size()) {
    throw input_error("load history", fmt::format("{} points and {} loads", points_.size(), loads_.size()),
                      "as many of both, at least 1");
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool increasing = i == 0 || points_[i] > points_[i - 1];
    if (std::isfinite(points_[i]) && increasing && loads_[i].allFinite()) continue;
    throw input_error(fmt::format("load history, point {}", i + 1), "a value that is not finite or not increasing",
                      "finite loads at increasing points");
  }
}

ForceAndMoment LoadHistory::at(double point) const noexcept { return interpolate(points_, loads_, point); }

Eigen::Array<bool, 6, 1> LoadHistory::acting() const noexcept {
  Eigen::Array<bool, 6, 1> result = Eigen::Array<bool, 6, 1>::Constant(false);
  for (const ForceAndMoment& load : loads_) result = result || (load.array() != 0.0);
  return result;
}

namespace {

/// Add the pulses of one component at increasing points.
void add_pulses(const std::vector<double>& points, const std::vector<double>& value, int component,
                std::vector<LoadHistory::Pulse>& pulses) {
  constexpr double noticeable = 0.1;  // of the largest amount
  double largest = 0.0;
  for (const double v : value) largest = std::max(largest, std::abs(v));
  struct Change {
    std::size_t begin, end;
  };
  Change before{0, 0};  // the last one in one direction
  for (std::size_t i = 0; i + 1 < points.size();) {
    const double way = value[i + 1] - value[i];
    std::size_t end = i + 1;
    while (end + 1 < points.size() && way * (value[end + 1] - value[end]) > 0.0) ++end;
    if (way != 0.0) {
      const double now = value[end] - value[i], last = value[before.end] - value[before.begin];
      const double height = std::min(std::abs(now), std::abs(last));
      if (now * last < 0.0 && height >= noticeable * largest) {
        pulses.push_back({points[before.begin], points[end], component, height});
      }
      before = {i, end};
    }
    i = end;
  }
}

}  // namespace

std::vector<LoadHistory::Pulse> LoadHistory::pulses() const {
  std::vector<Pulse> result;
  std::vector<double> value(loads_.size());
  for (int component = 0; component < 6; ++component) {
    std::transform(loads_.begin(), loads_.end(), value.begin(),
                   [&](const ForceAndMoment& load) { return load[component]; });
    add_pulses(points_, value, component, result);
  }
  return result;
}

GustShape one_minus_cosine(double start, double duration) {
  constexpr int lines = 400;  // (2π/lines)²/16 of the peak is the largest distance of a chord
  GustShape gust;
  for (int i = 0; i <= lines; ++i) {
    const double part = static_cast<double>(i) / lines;
    gust.points.push_back(start + part * duration);
    gust.share.push_back(i == lines ? 0.0 : 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * part)));
  }
  return gust;
}

LoadHistory gust_history(const ForceAndMoment& peak, double start, double duration) {
  GustShape gust = one_minus_cosine(start, duration);
  std::vector<ForceAndMoment> loads;
  for (const double share : gust.share) loads.emplace_back(share * peak);
  return {LoadArgument::time, std::move(gust.points), std::move(loads)};
}

LoadHistory read_load_history(const std::filesystem::path& file, double start) {
  constexpr std::array<std::string_view, 6> names{"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  const std::vector<FileColumn> columns = read_columns(file);
  const bool over_time = columns[0].name == "t";
  if (!over_time && columns[0].name != "x") {
    throw input_error(columns[0].place(0), fmt::format("column '{}'", columns[0].name), "t[s] or x[m] first");
  }
  static_cast<void>(factor_to_si(columns[0], {{over_time ? "s" : "m", 1.0}}));
  require_argument(columns[0]);
  std::vector<double> points = columns[0].values;
  for (double& p : points) p += start;
  std::vector<ForceAndMoment> loads(points.size(), ForceAndMoment::Zero());
  std::array<bool, 6> taken{};
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const auto component =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), columns[c].name) - names.begin());
    if (component == names.size() || taken[component]) {
      throw input_error(columns[c].place(0), fmt::format("column '{}'", columns[c].name),
                        "each of Fx, Fy, Fz, Mx, My, Mz at most once");
    }
    taken[component] = true;
    const double factor = component < 3 ? factor_to_si(columns[c], {{"N", 1.0}, {"kN", 1e3}})
                                        : factor_to_si(columns[c], {{"N m", 1.0}, {"kN m", 1e3}});
    constexpr double largest_force = 1e8, largest_moment = 1e9;  // [N], [N m], as for a scene's own numbers
    require_magnitude(columns[c], factor, component < 3 ? largest_force : largest_moment);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      loads[i][static_cast<Eigen::Index>(component)] = factor * columns[c].values[i];
    }
  }
  return {over_time ? LoadArgument::time : LoadArgument::position, std::move(points), std::move(loads)};
}

}  // namespace railtab
