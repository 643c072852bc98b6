#include "railtab/runtime/contact/rolling_radius_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

constexpr double closest_samples = 1e-6;  // [m]

/// d z_touch / d roll of a touching wheel: rolling by dφ moves the contact point by (−c, a) dφ, (a, c) its position
/// from the wheelset centre, and z_touch rises by tan(contact angle) per lateral shift.
double height_by_roll(const ContactPatch& patch, double rail_offset, double y) {
  const double a = patch.y_rail + rail_offset - y;
  return -a - patch.rolling_radius * std::tan(patch.angle);
}

/// Both wheels at one lateral shift and roll. A wheel whose radius is larger by δ stands as the nominal one shifted
/// along its own vertical: centre at (y − δ sin φ, z + δ cos φ).
struct TwoWheels {
  const WheelOnRail& right_side;
  const WheelOnRail& left_side;
  double radius_excess;  ///< of the right wheel over nominal [m]; of the left wheel the negative

  [[nodiscard]] std::optional<WheelsetContact> at(double y, double roll, const WheelsetContact& start) const {
    const double shift = radius_excess * std::sin(roll);
    const auto right = first_contact(right_side.patches, y - shift, roll, start.z_right);
    const auto left = first_contact(left_side.patches, -y - shift, -roll, start.z_left);
    if (!right || !left) return std::nullopt;
    const double difference = right->patch.rolling_radius - left->patch.rolling_radius + 2.0 * radius_excess;
    return WheelsetContact{y, roll, right->patch, left->patch, difference, right->z, left->z};
  }

  /// Height of the wheelset's centre above the left wheel's touch where the right wheel touches; falls with roll.
  [[nodiscard]] double height_difference(const WheelsetContact& c) const {
    return c.z_right - c.z_left - 2.0 * radius_excess * std::cos(c.roll);
  }
};

/// Roll at which both wheels touch: Newton inside a bracket, as rigid_position().
std::optional<WheelsetContact> free_roll(const TwoWheels& wheels, double y, const WheelsetContact& start) {
  constexpr int most_steps = 80;
  constexpr double largest_roll = 0.1;  // [rad]
  constexpr double tolerance = 1e-12;   // [m]
  double below = -largest_roll;
  double above = largest_roll;
  WheelsetContact from = start;
  double roll = start.roll;
  for (int i = 0; i < most_steps; ++i) {
    std::optional<WheelsetContact> c = wheels.at(y, roll, from);
    if (!c) return std::nullopt;
    const double f = wheels.height_difference(*c);
    if (std::abs(f) < tolerance || above - below < 1e-14) return c;
    (f > 0.0 ? below : above) = roll;
    const double slope = height_by_roll(c->right, wheels.right_side.rail_offset, y) +
                         height_by_roll(c->left, wheels.left_side.rail_offset, -y);
    const double newton = roll - f / slope;
    from = *c;
    roll = newton > below && newton < above ? newton : 0.5 * (below + above);
  }
  return std::nullopt;
}

struct Sampler {
  TwoWheels wheels;
  const WheelsetContactOptions& options;

  [[nodiscard]] std::optional<WheelsetContact> at(double y, const WheelsetContact& start) const {
    return options.roll == WheelsetRoll::off ? wheels.at(y, 0.0, start) : free_roll(wheels, y, start);
  }

  /// Samples between a and b (both excluded) until lines between neighbours suffice. Two inner points are looked at:
  /// one alone may lie on the line by symmetry.
  void refine(const WheelsetContact& a, const WheelsetContact& b, std::vector<WheelsetContact>& samples) const {
    const double width = b.y - a.y;
    if (width <= closest_samples) return;
    const auto middle = at(a.y + 0.5 * width, a);
    const auto quarter = middle ? at(a.y + 0.25 * width, a) : std::nullopt;
    if (!middle || !quarter) return;
    const double rise = b.radius_difference - a.radius_difference;
    const double middle_error = std::abs(middle->radius_difference - a.radius_difference - 0.5 * rise);
    const double quarter_error = std::abs(quarter->radius_difference - a.radius_difference - 0.25 * rise);
    if (middle_error <= options.tolerance && quarter_error <= options.tolerance) return;
    refine(a, *middle, samples);
    samples.push_back(*middle);
    refine(*middle, b, samples);
  }

  /// Lateral shifts from the centre, excluded, to y_end: multiples of the step, or parts of the range of at most a
  /// step.
  [[nodiscard]] std::vector<double> shifts_to(double y_end) const {
    const bool even = options.sampling == ShiftSampling::even;
    constexpr double rounding = 1e-9;
    const double steps = std::abs(y_end) / options.step;
    const int count = static_cast<int>(even ? std::floor(steps + rounding) : std::ceil(steps));
    std::vector<double> shifts;
    for (int k = 1; k <= count; ++k) {
      shifts.push_back(even ? std::copysign(k * options.step, y_end) : y_end * k / count);
    }
    return shifts;
  }

  /// From the centre, excluded, to y_end; ends where a wheel loses its rail.
  [[nodiscard]] std::vector<WheelsetContact> outward(const WheelsetContact& centre, double y_end) const {
    std::vector<WheelsetContact> samples;
    WheelsetContact last = centre;
    for (const double y : shifts_to(y_end)) {
      const auto next = at(y, last);
      if (!next) break;
      std::vector<WheelsetContact> inner;
      if (options.sampling == ShiftSampling::refined) {
        y_end > 0.0 ? refine(last, *next, inner) : refine(*next, last, inner);
        if (y_end < 0.0) std::reverse(inner.begin(), inner.end());
      }
      samples.insert(samples.end(), inner.begin(), inner.end());
      samples.push_back(*next);
      last = *next;
    }
    return samples;
  }
};

}  // namespace

void WheelsetContactOptions::validate() const {
  if (!(y_low < 0.0 && y_high > 0.0 && y_low >= -0.1 && y_high <= 0.1)) {
    throw input_error("lateral range", fmt::format("{}:{} m", y_low, y_high), "a range around 0 within +-0.1 m");
  }
  if (!(std::abs(diameter_difference) <= 0.02)) {
    throw input_error("diameter difference", fmt::format("{} m", diameter_difference), "at most 0.02 m either way");
  }
  if (!(step >= 1e-6 && step <= 1e-3)) {
    throw input_error("step of the lateral shift", fmt::format("{} m", step), "a number in 1e-6..1e-3 m");
  }
  if (!(tolerance >= 1e-12 && tolerance <= 1e-3)) {
    throw input_error("tolerance", fmt::format("{} m", tolerance), "a number in 1e-12..1e-3 m");
  }
}

std::optional<FirstContact> first_contact(const PatchQuery& patches, double y, double roll, double z_start) {
  constexpr int most_steps = 60;
  constexpr double touch = 1e-12;         // [m]
  constexpr double wide_miss = 3e-3;      // [m]
  constexpr double deepest_fall = 30e-3;  // [m]
  double z = z_start;
  double near_miss = 0.1e-3;
  for (int i = 0; i < most_steps && z - z_start <= deepest_fall; ++i) {
    const ContactPatches found = patches({y, z, roll, 0.0}, near_miss);
    if (found.count == 0) {
      // Nothing within reach: look further, then go down.
      if (near_miss == wide_miss) z += wide_miss;
      near_miss = wide_miss;
      continue;
    }
    double lift = -deepest_fall;
    const ContactPatch* first = nullptr;
    for (const ContactPatch& p : found) {
      const double height = p.penetration / std::cos(p.angle);
      if (height <= lift) continue;
      lift = height;
      first = &p;
    }
    if (first == nullptr) return std::nullopt;
    if (std::abs(first->penetration) <= touch) return FirstContact{*first, z};
    z -= lift;
    near_miss = 1e-6;
  }
  return std::nullopt;
}

WheelOnRail searched_side(const ContactSearch& search) {
  return {[&search](const WheelsetPose& pose, double near_miss) { return search.patches(pose, near_miss); },
          search.pair().rail_offset()};
}

std::vector<WheelsetContact> wheelset_contacts(const WheelOnRail& right_side, const WheelOnRail& left_side,
                                               const WheelsetContactOptions& options) {
  options.validate();
  const Sampler sampler{{right_side, left_side, 0.25 * options.diameter_difference}, options};
  const auto centre = sampler.at(0.0, WheelsetContact{});
  if (!centre) return {};
  std::vector<WheelsetContact> all = sampler.outward(*centre, options.y_low);
  std::reverse(all.begin(), all.end());
  all.push_back(*centre);
  const std::vector<WheelsetContact> right = sampler.outward(*centre, options.y_high);
  all.insert(all.end(), right.begin(), right.end());
  return all;
}

std::vector<WheelsetContact> wheelset_contacts(const PatchQuery& patches, const WheelRailPair& pair,
                                               const WheelsetContactOptions& options) {
  const WheelOnRail side{patches, pair.rail_offset()};
  return wheelset_contacts(side, side, options);
}

std::vector<WheelsetContact> wheelset_contacts(const ContactSearch& search, const WheelsetContactOptions& options) {
  const WheelOnRail side = searched_side(search);
  return wheelset_contacts(side, side, options);
}

}  // namespace railtab
