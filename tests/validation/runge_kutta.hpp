#pragma once

#include <array>
#include <cstddef>

namespace railtab {

/// A step of Runge and Kutta's classical scheme of fourth order for s' = rate(s).
template <std::size_t n, class Rate>
void runge_kutta_step(const Rate& rate, double dt, std::array<double, n>& s) {
  using State = std::array<double, n>;
  const auto plus = [](State a, double h, const State& b) {
    for (std::size_t i = 0; i < n; ++i) a[i] += h * b[i];
    return a;
  };
  const State k1 = rate(s), k2 = rate(plus(s, 0.5 * dt, k1)), k3 = rate(plus(s, 0.5 * dt, k2)),
              k4 = rate(plus(s, dt, k3));
  for (std::size_t i = 0; i < n; ++i) s[i] += dt / 6.0 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

}  // namespace railtab
