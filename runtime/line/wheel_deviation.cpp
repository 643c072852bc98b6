#include "railtab/runtime/line/wheel_deviation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

constexpr double turn = 2.0 * std::numbers::pi, largest = 0.02;  // rad, m

// -π to π
double within_half_turn(double angle) { return std::remainder(angle, turn); }

WheelRise rise_of(const WheelFlat& flat, double radius, double angle) {
  const double half = std::asin(0.5 * flat.length / radius);
  const double theta = within_half_turn(angle - flat.angle);
  const double inside = half - std::abs(theta);
  if (inside <= 0.0) return {};
  if (flat.edges == WheelFlat::Edges::sharp) {
    const double side = theta < 0.0 ? -1.0 : 1.0;  // inside falls by θ on the right, rises on the left
    return {-radius * (1.0 - std::cos(inside)), side * radius * std::sin(inside), -radius * std::cos(inside)};
  }
  const double depth = flat.length * flat.length / (16.0 * radius), k = std::numbers::pi / half;
  return {-0.5 * depth * (1.0 + std::cos(k * theta)), 0.5 * depth * k * std::sin(k * theta),
          0.5 * depth * k * k * std::cos(k * theta)};
}

WheelRise rise_of(const WheelHarmonic& h, double angle) {
  const double n = h.order, a = n * (angle - h.phase);
  return {h.amplitude * std::cos(a), -n * h.amplitude * std::sin(a), -n * n * h.amplitude * std::cos(a)};
}

WheelRise rise_of(const WheelContour& contour, double angle) {
  const std::vector<double>& x = contour.angle;
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  // points beyond a turn's ends are those of the turns before and after
  const auto place = [&](std::ptrdiff_t i) {
    const std::ptrdiff_t turns = i < 0 ? -1 : i / n;
    return x[static_cast<std::size_t>(i - turns * n)] + static_cast<double>(turns) * turn;
  };
  const auto value = [&](std::ptrdiff_t i) { return contour.rise[static_cast<std::size_t>((i + n) % n)]; };
  double theta = x.front() + std::fmod(angle - x.front(), turn);
  if (theta < x.front()) theta += turn;
  const std::ptrdiff_t i = std::upper_bound(x.begin(), x.end(), theta) - x.begin() - 1;
  const double h = place(i + 1) - place(i), u = (theta - place(i)) / h;
  const auto slope = [&](std::ptrdiff_t k) { return (value(k + 1) - value(k - 1)) / (place(k + 1) - place(k - 1)); };
  const double y0 = value(i), y1 = value(i + 1), m0 = h * slope(i), m1 = h * slope(i + 1);
  const double c2 = 3.0 * (y1 - y0) - 2.0 * m0 - m1, c3 = 2.0 * (y0 - y1) + m0 + m1;
  return {y0 + u * (m0 + u * (c2 + u * c3)), (m0 + u * (2.0 * c2 + 3.0 * u * c3)) / h,
          (2.0 * c2 + 6.0 * u * c3) / (h * h)};
}

template <class Place>
void check_contour(const WheelContour& contour, const Place& place) {
  const std::size_t n = contour.angle.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(std::abs(contour.rise[i]) <= largest)) {
      throw input_error(place(i), fmt::format("a deviation of {} m", contour.rise[i]),
                        fmt::format("at most {} m of either sign", largest));
    }
    if (i == 0) continue;
    if (!(contour.angle[i] > contour.angle[i - 1]) || !(contour.angle[i] < contour.angle[0] + turn)) {
      throw input_error(
          place(i), fmt::format("an angle of {} rad", contour.angle[i]),
          fmt::format("more than {} rad of the point before, within one turn from the first", contour.angle[i - 1]));
    }
  }
}

}  // namespace

WheelDeviation::WheelDeviation(double radius, std::vector<WheelFlat> flats, std::vector<WheelHarmonic> harmonics,
                               WheelContour contour)
    : radius_(radius), flats_(std::move(flats)), harmonics_(std::move(harmonics)), contour_(std::move(contour)) {
  for (const WheelFlat& flat : flats_) {
    if (flat.length > 0.0 && flat.length < radius) continue;
    throw input_error("wheel flat", fmt::format("a length of {} m", flat.length),
                      fmt::format("above 0, below the wheel's radius of {} m", radius));
  }
  for (const WheelHarmonic& harmonic : harmonics_) {
    if (harmonic.order >= 1 && std::abs(harmonic.amplitude) <= largest) continue;
    throw input_error("wheel harmonic", fmt::format("order {}, {} m", harmonic.order, harmonic.amplitude),
                      fmt::format("an order from 1 on, at most {} m", largest));
  }
  if (contour_.angle.size() != contour_.rise.size() || (!contour_.angle.empty() && contour_.angle.size() < 4)) {
    throw input_error("wheel contour",
                      fmt::format("{} angles and {} deviations", contour_.angle.size(), contour_.rise.size()),
                      "as many of both, at least 4");
  }
  check_contour(contour_, [](std::size_t i) { return fmt::format("wheel contour, point {}", i + 1); });
}

WheelRise WheelDeviation::at(double angle) const noexcept {
  WheelRise sum;
  const auto add = [&](const WheelRise& part) {
    sum.rise += part.rise;
    sum.slope += part.slope;
    sum.curvature += part.curvature;
  };
  for (const WheelFlat& flat : flats_) add(rise_of(flat, radius_, angle));
  for (const WheelHarmonic& harmonic : harmonics_) add(rise_of(harmonic, angle));
  if (!contour_.angle.empty()) add(rise_of(contour_, angle));
  return sum;
}

WheelContour read_wheel_contour(const std::filesystem::path& file) {
  std::vector<FileColumn> columns = read_columns(file);
  if (columns.size() != 2 || columns[0].name != "angle" || columns[1].name != "rise") {
    throw input_error(columns[0].place(0), names_of(columns), "angle[rad] or angle[deg], rise[m] or rise[mm]");
  }
  const double to_rad = factor_to_si(columns[0], {{"rad", 1.0}, {"deg", std::numbers::pi / 180.0}});
  const double to_m = factor_to_si(columns[1], {{"m", 1.0}, {"mm", 1e-3}});
  for (double& v : columns[0].values) v *= to_rad;
  for (double& v : columns[1].values) v *= to_m;
  WheelContour contour{std::move(columns[0].values), std::move(columns[1].values)};
  if (contour.angle.size() < 4) {
    throw input_error(columns[0].place(0), fmt::format("{} points", contour.angle.size()), "at least 4");
  }
  check_contour(contour, [&](std::size_t i) { return columns[0].place(i + 1); });
  return contour;
}

}  // namespace railtab
