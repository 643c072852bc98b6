#include "railtab/runtime/profile/profile_curve.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/tables/input_error.hpp"

namespace railtab {

double CurvePoint::curvature() const noexcept {
  const double t2 = dy * dy + dz * dz;
  return (dy * ddz - dz * ddy) / (t2 * std::sqrt(t2));
}

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
    piece_.push_back({k.s[i], k.y[i], k.dy[i], (3 * vy - 2 * k.dy[i] - k.dy[i + 1]) / h,
                      (k.dy[i] + k.dy[i + 1] - 2 * vy) / (h * h), k.z[i], k.dz[i],
                      (3 * vz - 2 * k.dz[i] - k.dz[i + 1]) / h, (k.dz[i] + k.dz[i + 1] - 2 * vz) / (h * h)});
  }
  // As many buckets as intervals: with near-uniform knots the walk from a bucket's first interval is one step.
  bucket_.resize(n);
  bucket_origin_ = k.s.front();
  bucket_inverse_width_ = static_cast<double>(n) / (k.s.back() - k.s.front());
  std::size_t i = 0;
  for (std::size_t b = 0; b < n; ++b) {
    const double left = bucket_origin_ + static_cast<double>(b) / bucket_inverse_width_;
    while (i + 1 < n && piece_[i + 1].s0 <= left) ++i;
    bucket_[b] = i;
  }
}

double ProfileCurve::s_at_y(double y) const noexcept {
  std::size_t best = 0;
  for (std::size_t i = 1; i < knots_.y.size(); ++i) {
    if (std::abs(knots_.y[i] - y) < std::abs(knots_.y[best] - y)) best = i;
  }
  double s = knots_.s[best];
  for (int iteration = 0; iteration < 20; ++iteration) {
    const CurvePoint p = at(s);
    if (std::abs(p.dy) < 1e-9) break;
    const double step = (y - p.y) / p.dy;
    s += step;
    if (std::abs(step) < 1e-15) break;
  }
  return s;
}

}  // namespace railtab
