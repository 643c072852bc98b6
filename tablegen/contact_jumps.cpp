#include "railtab/tablegen/contact_jumps.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/tablegen/undeformed_distance.hpp"
#include "railtab/tables/hermite_basis.hpp"

namespace railtab {

namespace {

constexpr double scan_step = 1e-4;    // of y [m]
constexpr double least_jump = 1e-3;   // along the rail [m]
constexpr double suspicion = 3e-4;    // along the rail within one step: a jump may be there [m]
constexpr double resolution = 1e-10;  // of y [m]

}  // namespace

std::vector<ContactJump> contact_jumps(const ContactSearch& search, const Interval& lateral, double roll, double yaw,
                                       double climb) {
  std::vector<ContactJump> jumps;
  const auto place = [&](double y) { return search.first_touch(y, roll - climb * y, yaw).s_rail; };
  const int steps = static_cast<int>(std::ceil((lateral.high - lateral.low) / scan_step));
  double y_before = lateral.low, s_before = place(y_before);
  for (int i = 1; i <= steps; ++i) {
    const double y = lateral.low + (lateral.high - lateral.low) * i / steps, s = place(y);
    double low = y_before, high = y, s_low = s_before, s_high = s;
    y_before = y;
    s_before = s;
    if (!(std::abs(s_high - s_low) > suspicion)) continue;
    while (high - low > resolution) {
      const double middle = 0.5 * (low + high), s_middle = place(middle);
      // the greater change holds the jump
      if (std::abs(s_middle - s_low) > std::abs(s_high - s_middle)) {
        high = middle;
        s_high = s_middle;
      } else {
        low = middle;
        s_low = s_middle;
      }
    }
    if (std::abs(s_high - s_low) > least_jump) jumps.push_back({0.5 * (low + high), s_low, s_high});
  }
  return jumps;
}

std::vector<std::optional<double>> same_jumps(const std::vector<ContactJump>& reference,
                                              const std::vector<ContactJump>& moved) {
  struct Pair {
    double shared;
    std::size_t of_reference, of_moved;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto [low, high] = std::minmax(reference[i].s_below, reference[i].s_above);
    for (std::size_t j = 0; j < moved.size(); ++j) {
      const auto [moved_low, moved_high] = std::minmax(moved[j].s_below, moved[j].s_above);
      const double shared = std::min(high, moved_high) - std::max(low, moved_low);
      if (shared > 0.0) pairs.push_back({shared, i, j});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.shared > q.shared; });
  std::vector<std::optional<double>> places(reference.size());
  std::vector<bool> taken(moved.size(), false);
  for (const Pair& pair : pairs) {
    if (places[pair.of_reference] || taken[pair.of_moved]) continue;
    places[pair.of_reference] = moved[pair.of_moved].y;
    taken[pair.of_moved] = true;
  }
  return places;
}

double widest_gap(const ContactSearch& search, const ContactJump& jump, double roll) {
  WheelsetPose pose{.y = jump.y, .roll = roll};
  pose.z = search.touch_height(jump.y, roll, 0.0);
  const UndeformedDistance distance(search.pair(), pose);
  const double low = std::min(jump.s_below, jump.s_above), high = std::max(jump.s_below, jump.s_above);
  double widest = 0.0, at = 0.5 * (low + high);
  constexpr int steps = 400;
  for (int i = 1; i < steps; ++i) {
    const double s = low + (high - low) * i / steps;
    const std::optional<SurfaceLine> line = distance.line(s);
    if (!line || line->overlap >= widest) continue;
    widest = line->overlap;
    at = s;
  }
  return at;
}

LateralWarp::LateralWarp(std::vector<double> reference, const std::vector<double>& moved, double constant)
    : y0_(std::move(reference)), slope_(y0_.size(), 0.0), constant_(constant) {
  for (std::size_t i = 0; i < y0_.size(); ++i) displacement_.push_back(moved[i] - y0_[i]);
  // Monotone between the jumps [FritschCarlson1980]: the harmonic mean of both sides, none at an extremum or end.
  for (std::size_t i = 1; i + 1 < y0_.size(); ++i) {
    const double before = (displacement_[i] - displacement_[i - 1]) / (y0_[i] - y0_[i - 1]);
    const double after = (displacement_[i + 1] - displacement_[i]) / (y0_[i + 1] - y0_[i]);
    if (before * after > 0.0) slope_[i] = 2.0 * before * after / (before + after);
  }
}

LateralWarp::Place LateralWarp::at(double y0) const noexcept {
  if (y0_.empty()) return {y0 + constant_, 1.0};
  if (y0 <= y0_.front()) return {y0 + displacement_.front(), 1.0};
  if (y0 >= y0_.back()) return {y0 + displacement_.back(), 1.0};
  const auto next = static_cast<std::size_t>(std::upper_bound(y0_.begin(), y0_.end(), y0) - y0_.begin());
  const std::size_t i = next - 1;
  const double h = y0_[next] - y0_[i];
  const HermiteBasis basis((y0 - y0_[i]) / h, h);
  const std::array<double, 4> ends{displacement_[i], slope_[i], displacement_[next], slope_[next]};
  return {y0 + HermiteBasis::sum(basis.value, ends), 1.0 + HermiteBasis::sum(basis.first, ends)};
}

}  // namespace railtab
