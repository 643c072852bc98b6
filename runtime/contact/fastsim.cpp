#include "railtab/runtime/contact/fastsim.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace railtab {

namespace {

using std::numbers::pi;

constexpr int kMaximum = 200;  // strips, and elements of a strip
constexpr int kLanes = 24;     // strips marched together: enough to hide the latency of root and division
using StripLanes = Eigen::Array<double, kLanes, 1>;

/// Strips of the unit circle (x/a, y/b): y = sin θ, half-length l = cos θ. Padded by empty strips to full lanes.
struct Strips {
  std::array<double, kMaximum + kLanes> y{}, half_length{};
  double step;  ///< of θ

  explicit Strips(int n) : step(pi / n) {
    const double c_step = std::cos(step);
    const double s_step = std::sin(step);
    double c = std::sin(0.5 * step);
    double s = -std::cos(0.5 * step);
    for (int j = 0; j < n; ++j) {
      y[j] = s;
      half_length[j] = c;
      const double c_next = c * c_step - s * s_step;
      s = s * c_step + c * s_step;
      c = c_next;
    }
  }
};

/// Traction bound μ p_n at the elements' middles: shape[i]·l^power at x = ξ_i l, scaled so that it sums to μF_n = 1.
struct TractionBound {
  std::array<double, kMaximum> shape{};
  bool parabolic;

  TractionBound(const FastsimCreep& law, const Strips& strips)
      : parabolic(law.bound == FastsimCreep::Bound::parabolic) {
    double along = 0.0;
    for (int i = 0; i < law.elements; ++i) {
      const double xi = 1.0 - (2 * i + 1.0) / law.elements;
      shape[i] = parabolic ? 1.0 - xi * xi : std::sqrt(1.0 - xi * xi);
      along += shape[i];
    }
    double across = 0.0;
    for (int j = 0; j < law.strips; ++j) {
      const double l = strips.half_length[j];
      across += l * l * l * (parabolic ? l : 1.0);
    }
    const double scale = law.elements / (2.0 * along * across * strips.step);
    for (int i = 0; i < law.elements; ++i) shape[i] *= scale;
  }
};

/// 1/L of the three flexibilities of linear theory.
struct Stiffness {
  double x, y, spin;
};

/// In full sliding the tractions must point along the slip, which needs one flexibility for all three creepages: the
/// one that gives the linear tractions' mean. Blended in over the creepages' size (Vollebregt & Voltr 2023).
Stiffness blended(const Stiffness& three, const KalkerCoefficients& c, double a, const Creepage& creepage) {
  const double arm = 3.0 * pi / 32.0 * a;  // mean |x| of the linear spin tractions
  const double x2 = creepage.x * creepage.x;
  const double y2 = creepage.y * creepage.y;
  const double spin2 = creepage.spin * creepage.spin;
  const double total = x2 + y2 + arm * arm * spin2;
  if (total == 0.0) return three;
  const double one = total / (x2 * three.x + y2 * three.y + arm * arm * spin2 * three.spin);  // L
  const double characteristic = 1.0 / (c.c11 * c.c11) + 1.0 / (c.c22 * c.c22) + 1.0 / (c.c23 * c.c23);
  const double weight = std::min(std::sqrt((x2 + y2 + spin2) / characteristic) / 3.0, 1.0);
  const auto mix = [&](double k) { return 1.0 / ((1.0 - weight) / k + weight * one); };
  return {mix(three.x), mix(three.y), mix(three.spin)};
}

/// Growth of the traction per unit of x/a towards the trailing edge: (x_0 + x_y·y, y_0 + y_x·x), x and y in semi-axes.
struct TractionGrowth {
  double x_0, x_y, y_0, y_x;

  TractionGrowth(const FastsimCreep& law, double ratio, const Creepage& creepage) {
    const double a = std::sqrt(ratio);
    const KalkerCoefficients c = kalker_coefficients(ratio, law.nu);
    Stiffness k{0.375 * c.c11 / a, 0.375 * c.c22 / a, 4.0 * c.c23 / (pi * ratio)};
    if (law.flexibility == FastsimCreep::Flexibility::blended) k = blended(k, c, a, creepage);
    x_0 = -a * k.x * creepage.x;
    x_y = k.spin * creepage.spin;
    y_0 = -a * k.y * creepage.y;
    y_x = -ratio * k.spin * creepage.spin;
  }
};

/// Sums over the elements of kLanes strips.
struct LaneSums {
  StripLanes x = StripLanes::Zero(), y = StripLanes::Zero(), xi_y = StripLanes::Zero();
};

/// From the leading edge to the trailing edge: traction grows with the rigid slip, and is cut back to the bound in its
/// own direction. The growth between two elements' middles is linear in x, so the rule of the middle is exact.
LaneSums march(const TractionBound& bound, int elements, const TractionGrowth& growth, const StripLanes& y,
               const StripLanes& l) {
  const double d = 2.0 / elements;
  const StripLanes step = d * l;
  const StripLanes growth_x = step * (growth.x_0 + growth.x_y * y);
  const StripLanes growth_y0 = step * growth.y_0;
  const StripLanes growth_y1 = step * l * growth.y_x;
  const StripLanes bound_scale = bound.parabolic ? StripLanes(l * l) : l;
  LaneSums sums;
  StripLanes px = 0.5 * growth_x - growth_x;  // the first step is half a step, taken around ξ = 1 - d/4
  StripLanes py = 0.5 * (growth_y0 + growth_y1 * (1.0 - 0.25 * d)) - (growth_y0 + growth_y1);
  for (int i = 0; i < elements; ++i) {
    px += growth_x;
    py += growth_y0 + growth_y1 * (1.0 - d * i);
    const StripLanes g = bound.shape[i] * bound_scale;
    // 1 where the trial is within the bound: the root of a square is exact.
    const StripLanes largest = (px * px + py * py).max(g * g).max(std::numeric_limits<double>::min());
    const StripLanes cut = g / largest.sqrt();
    px *= cut;
    py *= cut;
    sums.x += px;
    sums.y += py;
    sums.xi_y += (1.0 - d * (i + 0.5)) * py;
  }
  return sums;
}

}  // namespace

CreepForce fastsim_creep(const FastsimCreep& law, double ratio, const Creepage& creepage) noexcept {
  assert(law.strips >= 2 && law.strips <= kMaximum && law.elements >= 2 && law.elements <= kMaximum);
  const Strips strips(law.strips);
  const TractionBound bound(law, strips);
  const TractionGrowth growth(law, ratio, creepage);
  const double a = std::sqrt(ratio);
  CreepForce total;
  for (int first = 0; first < law.strips; first += kLanes) {
    const StripLanes y = Eigen::Map<const StripLanes>(strips.y.data() + first);
    const StripLanes l = Eigen::Map<const StripLanes>(strips.half_length.data() + first);
    const LaneSums sums = march(bound, law.elements, growth, y, l);
    const StripLanes area = l * l * (strips.step * 2.0 / law.elements);  // dx dy = (2l/n)·(l dθ)
    total.x += (area * sums.x).sum();
    total.y += (area * sums.y).sum();
    total.moment += (area * (a * l * sums.xi_y - y * sums.x / a)).sum();
  }
  return total;
}

}  // namespace railtab
