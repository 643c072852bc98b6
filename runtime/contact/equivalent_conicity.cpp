#include "railtab/runtime/contact/equivalent_conicity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

RadiusDifferenceCurve::RadiusDifferenceCurve(std::vector<double> y, std::vector<double> radius_difference)
    : y_(std::move(y)), difference_(std::move(radius_difference)) {
  constexpr const char* place = "rolling radius difference";
  if (y_.size() < 2 || y_.size() != difference_.size()) {
    throw input_error(place, fmt::format("{} values y, {} radius differences", y_.size(), difference_.size()),
                      "equal numbers of at least 2");
  }
  integral_.assign(1, 0.0);
  for (std::size_t i = 0; i < y_.size(); ++i) {
    if (!std::isfinite(y_[i] + difference_[i]) || (i > 0 && !(y_[i] > y_[i - 1]))) {
      throw input_error(fmt::format("{}, sample {}", place, i), fmt::format("({}, {}) m", y_[i], difference_[i]),
                        "finite numbers with increasing y");
    }
    if (i > 0)
      integral_.push_back(integral_[i - 1] + 0.5 * (y_[i] - y_[i - 1]) * (difference_[i] + difference_[i - 1]));
  }
}

namespace {

std::vector<double> column(std::span<const WheelsetContact> contacts, double WheelsetContact::*member) {
  std::vector<double> values;
  values.reserve(contacts.size());
  for (const WheelsetContact& c : contacts) values.push_back(c.*member);
  return values;
}

}  // namespace

RadiusDifferenceCurve::RadiusDifferenceCurve(std::span<const WheelsetContact> contacts)
    : RadiusDifferenceCurve(column(contacts, &WheelsetContact::y),
                            column(contacts, &WheelsetContact::radius_difference)) {}

std::size_t RadiusDifferenceCurve::interval(double y) const noexcept {
  assert(y >= y_.front() && y <= y_.back());
  const auto above = static_cast<std::size_t>(std::upper_bound(y_.begin(), y_.end(), y) - y_.begin());
  return std::clamp<std::size_t>(above, 1, y_.size() - 1) - 1;
}

double RadiusDifferenceCurve::at(double y) const noexcept {
  const std::size_t i = interval(y);
  const double t = (y - y_[i]) / (y_[i + 1] - y_[i]);
  return (1.0 - t) * difference_[i] + t * difference_[i + 1];
}

double RadiusDifferenceCurve::integral(double y) const noexcept {
  const std::size_t i = interval(y);
  return integral_[i] + 0.5 * (y - y_[i]) * (difference_[i] + at(y));
}

namespace {

/// Ends of a wave.
struct Wave {
  double low, high;
};

/// Breakpoints of the curve between the ends of a wave, ends included, and the zeros of Δr. None within rounding of an
/// end, where the wheelset would stand still at both ends of a piece.
std::vector<double> breakpoints(const RadiusDifferenceCurve& curve, const Wave& wave) {
  const double margin = 1e-9 * (wave.high - wave.low);
  const auto inside = [&](double y) { return y > wave.low + margin && y < wave.high - margin; };
  const std::vector<double>& y = curve.y();
  const std::vector<double>& r = curve.radius_difference();
  std::vector<double> points{wave.low};
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (inside(y[i])) points.push_back(y[i]);
    if (i + 1 == y.size() || (r[i] > 0.0) == (r[i + 1] > 0.0) || r[i] == 0.0 || r[i + 1] == 0.0) continue;
    const double zero = y[i] - r[i] * (y[i + 1] - y[i]) / (r[i + 1] - r[i]);
    if (inside(zero) && zero > points.back()) points.push_back(zero);
  }
  points.push_back(wave.high);
  return points;
}

/// Whether the wheelset, at rest at one end, runs to the other: ∫Δr stays below its value there.
bool closed(const RadiusDifferenceCurve& curve, const Wave& wave) {
  const std::vector<double> points = breakpoints(curve, wave);
  const double level = std::max(curve.integral(wave.low), curve.integral(wave.high));
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (!(curve.integral(points[i]) < level)) return false;
  }
  return points.size() > 2;
}

/// The wave of a given amplitude nearest to y = 0. g(y) = ∫Δr from y to y + 2ŷ rises through zero at its lower end.
std::optional<Wave> find_wave(const RadiusDifferenceCurve& curve, double amplitude, ConicityStatus& status) {
  status = ConicityStatus::outside;
  const double first = curve.y().front();
  const double last = curve.y().back() - 2.0 * amplitude;
  if (!(last > first)) return std::nullopt;
  const auto end_of = [&](double low) { return std::min(low + 2.0 * amplitude, curve.y().back()); };
  const auto gain = [&](double low) { return curve.integral(end_of(low)) - curve.integral(low); };
  std::vector<double> starts{first, last};
  for (const double y : curve.y()) {
    for (const double start : {y, y - 2.0 * amplitude}) {
      if (start > first && start < last) starts.push_back(start);
    }
  }
  std::sort(starts.begin(), starts.end());
  std::optional<Wave> best;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    double below = starts[i];
    double above = starts[i + 1];
    if (!(gain(below) < 0.0 && gain(above) >= 0.0)) continue;
    constexpr int most_halvings = 2200;  // of any interval of doubles down to one bit
    for (int halving = 0; halving < most_halvings; ++halving) {
      const double middle = 0.5 * (below + above);
      if (!(middle > below && middle < above)) break;
      (gain(middle) < 0.0 ? below : above) = middle;
    }
    const Wave wave{above, end_of(above)};
    if (!closed(curve, wave)) {
      if (!best) status = ConicityStatus::no_wave;
      continue;
    }
    status = ConicityStatus::found;
    if (!best || std::abs(wave.low + wave.high) < std::abs(best->low + best->high)) best = wave;
  }
  return best;
}

/// Distance along the track for one piece of the wave over which Δr is a straight line, in units of √(e r0): from
/// lateral velocity u to v over the lateral distance h. The motion is harmonic (slope > 0), uniformly accelerated, or
/// hyperbolic; in all of them the distance is 2h/(u + v) times a function of x² = slope·h²/(u + v)².
double piece_length(double h, double u, double v, double slope) {
  const double mean = h / (u + v);
  const double x2 = slope * mean * mean;
  if (std::abs(x2) < 1e-8) return 2.0 * mean * (1.0 - x2 / 3.0);
  const double x = std::sqrt(std::abs(x2));
  return 2.0 * mean * (x2 > 0.0 ? std::atan(x) : std::atanh(x)) / x;
}

/// Half the wavelength in units of √(e r0).
double half_wavelength(const RadiusDifferenceCurve& curve, const Wave& wave) {
  const std::vector<double> points = breakpoints(curve, wave);
  const double level = curve.integral(wave.low);
  double length = 0.0;
  double u = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const bool last = i + 2 == points.size();
    const double v = last ? 0.0 : std::sqrt(std::max(0.0, 2.0 * (level - curve.integral(points[i + 1]))));
    const double h = points[i + 1] - points[i];
    const double middle = points[i] + 0.5 * h;
    // The line's own slope: ends of the piece may lie on neighbouring lines within rounding.
    const auto above = std::upper_bound(curve.y().begin(), curve.y().end(), middle);
    const auto k = static_cast<std::size_t>(above - curve.y().begin()) - 1;
    const double slope =
        (curve.radius_difference()[k + 1] - curve.radius_difference()[k]) / (curve.y()[k + 1] - curve.y()[k]);
    length += piece_length(h, u, v, slope);
    u = v;
  }
  return length;
}

/// Slope of the least-squares line through Δr over an interval: 12/L³ ∫ Δr (y − middle) dy.
double regression_slope(const RadiusDifferenceCurve& curve, const Wave& interval) {
  const std::vector<double> points = breakpoints(curve, interval);
  const double middle = 0.5 * (interval.low + interval.high);
  const double width = interval.high - interval.low;
  double moment = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double a = points[i] - middle;
    const double b = points[i + 1] - middle;
    const double ra = curve.at(points[i]);
    const double rb = curve.at(points[i + 1]);
    moment += (b - a) * (a * (2.0 * ra + rb) + b * (ra + 2.0 * rb)) / 6.0;
  }
  return 12.0 * moment / (width * width * width);
}

/// Zero of Δr nearest to y = 0.
std::optional<double> central_zero(const RadiusDifferenceCurve& curve) {
  const std::vector<double>& y = curve.y();
  const std::vector<double>& r = curve.radius_difference();
  std::optional<double> best;
  for (std::size_t i = 0; i + 1 < y.size(); ++i) {
    if (r[i] * r[i + 1] > 0.0 || r[i] == r[i + 1]) continue;
    const double zero = y[i] - r[i] * (y[i + 1] - y[i]) / (r[i + 1] - r[i]);
    if (!best || std::abs(zero) < std::abs(*best)) best = zero;
  }
  return best;
}

}  // namespace

EquivalentConicity conicity_of_wave(const RadiusDifferenceCurve& curve, double amplitude) noexcept {
  EquivalentConicity result;
  result.tan_gamma = std::numeric_limits<double>::quiet_NaN();
  if (!(amplitude > 0.0)) return result;
  const std::optional<Wave> wave = find_wave(curve, amplitude, result.status);
  if (!wave) return result;
  const double half = half_wavelength(curve, *wave);
  using std::numbers::pi;
  result.tan_gamma = 0.5 * pi * pi / (half * half);
  result.y_low = wave->low;
  result.y_high = wave->high;
  return result;
}

EquivalentConicity conicity_of_regression(const RadiusDifferenceCurve& curve, double amplitude) noexcept {
  EquivalentConicity result;
  result.tan_gamma = std::numeric_limits<double>::quiet_NaN();
  if (!(amplitude > 0.0)) return result;
  std::optional<Wave> wave = find_wave(curve, amplitude, result.status);
  if (!wave) {
    const std::optional<double> zero = central_zero(curve);
    if (!zero || *zero - amplitude < curve.y().front() || *zero + amplitude > curve.y().back()) return result;
    wave = Wave{*zero - amplitude, *zero + amplitude};
  }
  result.tan_gamma = 0.5 * regression_slope(curve, *wave);
  result.y_low = wave->low;
  result.y_high = wave->high;
  return result;
}

}  // namespace railtab
