#include "railtab/runtime/profile/profile_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

void check(const ProfileKnots& k) {
  const std::size_t n = k.s.size();
  if (n < 2 || k.y.size() != n || k.z.size() != n || k.dy.size() != n || k.dz.size() != n) {
    throw input_error(fmt::format("profile {}", k.name),
                      fmt::format("{} arc lengths, {} y, {} z, {} dy/ds, {} dz/ds", n, k.y.size(), k.z.size(),
                                  k.dy.size(), k.dz.size()),
                      "equal numbers of at least 2");
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double sum = k.s[i] + k.y[i] + k.z[i] + k.dy[i] + k.dz[i];
    if (!std::isfinite(sum)) {
      throw input_error(fmt::format("profile {}, knot {}", k.name, i), "a value that is not finite", "finite numbers");
    }
    if (i > 0 && !(k.s[i] > k.s[i - 1])) {
      throw input_error(fmt::format("profile {}, knot {}", k.name, i),
                        fmt::format("arc length {} after {}", k.s[i], k.s[i - 1]), "strictly increasing arc length");
    }
  }
}

}  // namespace

ProfileCurve::ProfileCurve(ProfileKnots knots) : knots_(std::move(knots)) {
  check(knots_);
  const ProfileKnots& k = knots_;
  const std::size_t n = k.s.size() - 1;
  piece_.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double h = k.s[i + 1] - k.s[i];
    const double vy = (k.y[i + 1] - k.y[i]) / h;
    const double vz = (k.z[i + 1] - k.z[i]) / h;
    piece_.push_back({k.y[i], k.z[i], k.dy[i], k.dz[i], (3 * vy - 2 * k.dy[i] - k.dy[i + 1]) / h,
                      (3 * vz - 2 * k.dz[i] - k.dz[i + 1]) / h, (k.dy[i] + k.dy[i + 1] - 2 * vy) / (h * h),
                      (k.dz[i] + k.dz[i + 1] - 2 * vz) / (h * h)});
  }
  for (const Piece& p : piece_) {
    const double inverse_speed = 1.0 / std::sqrt(p.y1 * p.y1 + p.z1 * p.z1);
    tangent_.push_back({std::atan2(p.z1, p.y1), p.y1 * inverse_speed, p.z1 * inverse_speed});
  }
  start_ = k.s;
  fill_buckets();
}

void ProfileCurve::fill_buckets() {
  const std::vector<double>& s = knots_.s;
  const std::size_t n = s.size() - 1;
  double narrowest = s[1] - s[0];
  for (std::size_t i = 1; i < n; ++i) narrowest = std::min(narrowest, s[i + 1] - s[i]);
  // Buckets half as wide as the narrowest interval: few of them hold a knot, and only there an evaluation may have
  // to walk one interval beyond its bucket's first. Points that crowd far below the mean spacing are worth a short walk
  // rather than a large table.
  const double length = s.back() - s.front();
  const double wanted = std::min(std::ceil(2.0 * length / narrowest), 8.0 * static_cast<double>(n));
  const auto buckets = static_cast<std::size_t>(wanted);
  bucket_.resize(buckets);
  bucket_inverse_width_ = static_cast<double>(buckets) / length;
  bucket_offset_ = s.front() * bucket_inverse_width_;
  last_bucket_ = static_cast<double>(buckets - 1);
  std::size_t i = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    constexpr double reserve = 1e-6;  // of a bucket: an s at its beginning may be counted to it by rounding
    const double left = s.front() + (static_cast<double>(b) - reserve) / bucket_inverse_width_;
    while (start_[i + 1] <= left) ++i;
    bucket_[b] = static_cast<std::uint32_t>(i);
  }
}

namespace {

constexpr int most_halvings = 2200;  // of any interval of doubles down to one bit

/// Root of f in [a, b], where its signs differ or one end is the root, by bisection to the last bit of s.
template <class F>
double bisect(F f, double a, double b) {
  if (f(a) == 0.0) return a;
  if (f(b) == 0.0) return b;
  const bool positive_at_a = f(a) > 0;
  double middle = 0.5 * (a + b);
  for (int i = 0; i < most_halvings && middle > a && middle < b; ++i) {
    ((f(middle) > 0) == positive_at_a ? a : b) = middle;
    middle = 0.5 * (a + b);
  }
  return middle;
}

}  // namespace

double ProfileCurve::s_at_y(double y) const noexcept {
  const ProfileKnots& k = knots_;
  const double facing = k.kind == ProfileKind::wheel ? 1.0 : -1.0;
  std::size_t nearest = 0;
  bool passes = false;
  double best = 0.0;
  for (std::size_t i = 0; i < k.s.size(); ++i) {
    if (std::abs(k.y[i] - y) < std::abs(k.y[nearest] - y)) nearest = i;
    if (i == 0 || std::min(k.y[i - 1], k.y[i]) > y || std::max(k.y[i - 1], k.y[i]) < y) continue;
    const double s = bisect([&](double at_s) { return at(at_s).y - y; }, k.s[i - 1], k.s[i]);
    if (!passes || facing * at(s).z > facing * at(best).z) best = s;
    passes = true;
  }
  return passes ? best : k.s[nearest];
}

double ProfileCurve::s_at_highest_point() const noexcept {
  const ProfileKnots& k = knots_;
  const auto top = static_cast<std::size_t>(std::min_element(k.z.begin(), k.z.end()) - k.z.begin());
  // The slope at the least knot tells on which side the curve still rises; at an end it may rise out of the profile.
  const std::size_t other = k.dz[top] > 0 ? top - 1 : top + 1;
  if (k.dz[top] == 0.0 || other >= k.s.size() || (k.dz[top] > 0) == (k.dz[other] > 0)) return k.s[top];
  return bisect([&](double s) { return at(s).dz; }, std::min(k.s[top], k.s[other]), std::max(k.s[top], k.s[other]));
}

}  // namespace railtab
