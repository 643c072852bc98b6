#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/arc_lengths.hpp"
#include "railtab/runtime/profile/cubic_spline.hpp"
#include "railtab/runtime/profile/profile_file.hpp"

namespace railtab {

namespace {

/// Natural smoothing spline over given arc lengths [Reinsch1967]: with h the intervals, Q the second divided
/// differences and R the tridiagonal matrix of their hat functions, (R + λQᵀQ)γ = Qᵀv gives the second derivatives γ
/// and the fit v − λQγ. One factorisation serves y and z.
class SmoothingSystem {
 public:
  SmoothingSystem(const std::vector<double>& s, double lambda) : s_(s), lambda_(lambda) {
    const std::size_t m = s.size() - 2;
    d_.resize(m);
    l1_.assign(m, 0.0);
    l2_.assign(m, 0.0);
    for (std::size_t i = 0; i < m; ++i) {
      const Column a = column(i);
      double diagonal = (a.h_left + a.h_right) / 3.0 + lambda * (a.q[0] * a.q[0] + a.q[1] * a.q[1] + a.q[2] * a.q[2]);
      if (i >= 1) {
        const Column b = column(i - 1);
        double off = a.h_left / 6.0 + lambda * (b.q[1] * a.q[0] + b.q[2] * a.q[1]);
        if (i >= 2) {
          l2_[i] = lambda * column(i - 2).q[2] * a.q[0] / d_[i - 2];
          diagonal -= l2_[i] * l2_[i] * d_[i - 2];
          off -= l2_[i] * d_[i - 2] * l1_[i - 1];
        }
        l1_[i] = off / d_[i - 1];
        diagonal -= l1_[i] * l1_[i] * d_[i - 1];
      }
      d_[i] = diagonal;
    }
  }

  [[nodiscard]] std::vector<double> fit(const std::vector<double>& v) const {
    const std::size_t m = d_.size();
    std::vector<double> g(m);
    for (std::size_t i = 0; i < m; ++i) {
      const Column a = column(i);
      g[i] = a.q[0] * v[i] + a.q[1] * v[i + 1] + a.q[2] * v[i + 2];
      if (i >= 1) g[i] -= l1_[i] * g[i - 1];
      if (i >= 2) g[i] -= l2_[i] * g[i - 2];
    }
    for (std::size_t i = 0; i < m; ++i) g[i] /= d_[i];
    for (std::size_t i = m; i-- > 0;) {
      if (i + 1 < m) g[i] -= l1_[i + 1] * g[i + 1];
      if (i + 2 < m) g[i] -= l2_[i + 2] * g[i + 2];
    }
    std::vector<double> fitted = v;
    for (std::size_t i = 0; i < m; ++i) {
      const Column a = column(i);
      for (std::size_t k = 0; k < 3; ++k) fitted[i + k] -= lambda_ * a.q[k] * g[i];
    }
    return fitted;
  }

 private:
  struct Column {
    double h_left, h_right;
    std::array<double, 3> q;  ///< rows i to i + 2 of Q
  };
  [[nodiscard]] Column column(std::size_t i) const {
    const double h0 = s_[i + 1] - s_[i];
    const double h1 = s_[i + 2] - s_[i + 1];
    return {h0, h1, {1.0 / h0, -1.0 / h0 - 1.0 / h1, 1.0 / h1}};
  }

  const std::vector<double>& s_;
  double lambda_;
  std::vector<double> d_, l1_, l2_;  // LDLᵀ of the pentadiagonal matrix
};

/// Points, their arc lengths, and the curves that smooth them.
struct Smoother {
  ProfileKind kind;
  const std::string& name;
  const std::vector<double>& y;
  const std::vector<double>& z;

  [[nodiscard]] SmoothedProfile at(const std::vector<double>& s, double lambda) const {
    const SmoothingSystem system(s, lambda);
    const std::vector<double> fy = system.fit(y);
    const std::vector<double> fz = system.fit(z);
    SmoothedProfile result;
    result.knots = {kind, name, s, fy, fz, natural_spline_slopes(s, fy), natural_spline_slopes(s, fz)};
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double ty = result.knots.dy[i];
      const double tz = result.knots.dz[i];
      const double distance = ((z[i] - fz[i]) * ty - (y[i] - fy[i]) * tz) / std::hypot(ty, tz);
      sum += distance * distance;
      result.largest_distance = std::max(result.largest_distance, std::abs(distance));
    }
    result.rms_distance = std::sqrt(sum / static_cast<double>(s.size()));
    return result;
  }

  /// λ by bisection of its logarithm: the distance of the points grows with it.
  [[nodiscard]] SmoothedProfile with_distance(const std::vector<double>& s, double noise) const {
    const double spacing = s.back() / static_cast<double>(s.size() - 1);
    double low = std::log(1e-6 * spacing * spacing * spacing);
    double high = std::log(1e2 * s.back() * s.back() * s.back());
    if (at(s, std::exp(high)).rms_distance < noise) {
      throw input_error(fmt::format("profile {}", name), fmt::format("points on a line within the noise {} m", noise),
                        "a smaller noise to smooth by");
    }
    constexpr int steps = 40;  // to 1e-11 in λ
    for (int i = 0; i < steps; ++i) {
      const double middle = 0.5 * (low + high);
      (at(s, std::exp(middle)).rms_distance < noise ? low : high) = middle;
    }
    return at(s, std::exp(low));
  }
};

}  // namespace

SmoothedProfile smoothing_spline(ProfileKind kind, std::string name, const std::vector<double>& y,
                                 const std::vector<double>& z, double noise) {
  constexpr double largest_noise = 1e-3;  // [m]
  if (!(noise > 0.0 && noise <= largest_noise)) {
    throw input_error("smoothing", fmt::format("a noise of {} m", noise),
                      fmt::format("a standard deviation above 0 and at most {} m", largest_noise));
  }
  if (y.size() != z.size() || y.size() < 4) {
    throw input_error(fmt::format("profile {}", name), fmt::format("{} values y, {} values z", y.size(), z.size()),
                      "equal numbers of at least 4");
  }
  const Smoother smoother{kind, name, y, z};
  // Chords between noisy points are too long; the first curve's arc lengths are not.
  const SmoothedProfile first = smoother.with_distance(chord_lengths(name, y, z), noise);
  return smoother.with_distance(arc_lengths(ProfileCurve(first.knots)), noise);
}

}  // namespace railtab
