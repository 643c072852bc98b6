#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/kalker_asymptotes.hpp"
#include "railtab/runtime/contact/kalker_table.hpp"
#include "railtab/runtime/profile/cubic_spline.hpp"

namespace railtab {

namespace {

using std::numbers::ln10;
using Four = std::array<double, 4>;      // c11, c22, c23, c33, or anything of each
using NuParabola = std::array<Four, 3>;  // powers 0, 1, 2 of nu
constexpr std::size_t kNodes = kKalkerTable.size();

/// The parabolas through values at nu = 0, 1/4, 1/2.
NuParabola nu_parabola(const std::array<Four, 3>& v) {
  NuParabola p;
  for (int l = 0; l < 4; ++l) {
    const double second = 8.0 * (v[0][l] - 2.0 * v[1][l] + v[2][l]);
    p[0][l] = v[0][l];
    p[1][l] = 4.0 * (v[1][l] - v[0][l]) - 0.25 * second;
    p[2][l] = second;
  }
  return p;
}

Four at_nu(const NuParabola& p, double nu) {
  Four value;
  for (int l = 0; l < 4; ++l) value[l] = p[0][l] + nu * (p[1][l] + nu * p[2][l]);
  return value;
}

/// Growth of the coefficients towards both ends, up to logarithms. Divided by it they vary slowly over ln(a/b).
Four growth(double r) { return {1.0 + r, 1.0 + r, std::sqrt(r) * (1.0 + r), 1.0 + 1.0 / r}; }

NuParabola table_node(const KalkerRow& row) {
  const Four g = growth(row.ratio);
  std::array<Four, 3> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = {g[0] / row.c11[i], g[1] / row.c22[i], g[2] / row.c23[i], (1.0 - 0.25 * i) * row.c33[i] / g[3]};
  }
  return nu_parabola(v);
}

/// Slope at the first of four points, of the cubic through them.
double end_slope(const double* t, const double* v, int step) {
  double slope = 0.0;
  for (int i = 1; i < 4; ++i) {
    double weight = 1.0;  // of the chord from point 0 to point i
    for (int j = 1; j < 4; ++j) {
      if (j != i) weight *= (t[0] - t[j * step]) / (t[i * step] - t[j * step]);
    }
    slope += weight * (v[i * step] - v[0]) / (t[i * step] - t[0]);
  }
  return slope;
}

/// The table as cubic splines over ln(a/b) of what is nearly parabolic in nu: growth/c as in Kalker's own
/// interpolation, but (1 - nu) c33/growth for c33, whose 1/c at a/b = 10 bends by a factor of 4 (a parabola there is 4
/// % off at 0.28).
class KalkerSpline {
 public:
  KalkerSpline() {
    std::vector<double> t(kNodes), v(kNodes);
    for (std::size_t i = 0; i < kNodes; ++i) knot_[i] = t[i] = std::log(kKalkerTable[i].ratio);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 4; ++l) {
        for (std::size_t i = 0; i < kNodes; ++i) v[i] = table_node(kKalkerTable[i])[k][l];
        fit(t, v, k, l);
      }
    }
  }

  /// The spline; its end pieces continued outside a/b = 0.1..10.
  [[nodiscard]] Four operator()(double r, double nu) const {
    const std::size_t i = interval(r);
    const double d = std::log(r) - knot_[i];
    const std::array<NuParabola, 4>& c = pieces_[i];
    NuParabola p;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 4; ++l) p[k][l] = c[0][k][l] + d * (c[1][k][l] + d * (c[2][k][l] + d * c[3][k][l]));
    }
    const Four q = at_nu(p, nu);
    const Four g = growth(r);
    return {g[0] / q[0], g[1] / q[1], g[2] / q[2], g[3] * q[3] / (1.0 - nu)};
  }

 private:
  /// The table's steps are 0.1 in a/b up to 1, and 0.1 in b/a beyond.
  [[nodiscard]] static std::size_t interval(double r) {
    const int i = r < 1.0 ? std::max(static_cast<int>(10.0 * r) - 1, 0) : 18 - std::max(static_cast<int>(10.0 / r), 1);
    return static_cast<std::size_t>(std::clamp(i, 0, 17));
  }

  void fit(const std::vector<double>& t, const std::vector<double>& v, int k, int l) {
    const double first = end_slope(t.data(), v.data(), 1);
    const double last = end_slope(&t.back(), &v.back(), -1);
    const std::vector<double> m = clamped_spline_slopes(t, v, first, last);
    for (std::size_t i = 0; i + 1 < kNodes; ++i) {
      const double h = t[i + 1] - t[i];
      const double chord = (v[i + 1] - v[i]) / h;
      pieces_[i][0][k][l] = v[i];
      pieces_[i][1][k][l] = m[i];
      pieces_[i][2][k][l] = (3.0 * chord - 2.0 * m[i] - m[i + 1]) / h;
      pieces_[i][3][k][l] = (m[i] + m[i + 1] - 2.0 * chord) / (h * h);
    }
  }

  std::array<double, kNodes> knot_{};                           // ln(a/b)
  std::array<std::array<NuParabola, 4>, kNodes - 1> pieces_{};  // powers of ln(a/b) - knot
};

const KalkerSpline& table_spline() {
  static const KalkerSpline spline;
  return spline;
}

/// Asymptote times what the table exceeds it by at its end: a factor that goes to one over a decade, as a cubic that
/// keeps value and slope at the table's end, where the asymptotes are up to 6 % off.
Four outside_table(double r, double nu) {
  constexpr double blend = ln10;
  constexpr double h = 1e-4;  // of the difference that gives the slope at the end
  Four c = kalker_asymptotes(r, nu);
  const double t = std::log(r);
  const double u = (std::abs(t) - ln10) / blend;
  if (u >= 1.0) return c;
  const double r_end = t < 0.0 ? 0.1 : 10.0;
  const double outward = t < 0.0 ? -h : h;
  const Four table = table_spline()(r_end, nu);
  const Four table_next = table_spline()(r_end * (1.0 + outward), nu);
  const Four end = kalker_asymptotes(r_end, nu);
  const Four end_next = kalker_asymptotes(r_end * (1.0 + outward), nu);
  const double h0 = (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u);
  const double h1 = (1.0 - u) * (1.0 - u) * u;
  for (int l = 0; l < 4; ++l) {
    const double excess = table[l] / end[l];
    const double slope = (table_next[l] / end_next[l] - excess) / std::abs(std::log1p(outward)) * blend;
    c[l] *= 1.0 + h0 * (excess - 1.0) + h1 * slope;
  }
  return c;
}

}  // namespace

KalkerCoefficients kalker_coefficients(double ratio, double nu) noexcept {
  assert(ratio > 0.0 && nu >= 0.0 && nu <= 0.5);
  const bool inside = ratio >= 0.1 && ratio <= 10.0;
  const Four c = inside ? table_spline()(ratio, nu) : outside_table(ratio, nu);
  return {c[0], c[1], c[2], c[3]};
}

}  // namespace railtab
