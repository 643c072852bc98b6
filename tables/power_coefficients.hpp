#pragma once

#include <array>
#include <cstddef>

namespace railtab {

/// Coefficients of powers, from the constant, of the polynomial through values at nodes: Newton's divided differences,
/// expanded. @pre nodes differ
template <class Real, std::size_t count>
[[nodiscard]] std::array<Real, count> power_coefficients(const std::array<Real, count>& node,
                                                         std::array<Real, count> value) {
  for (std::size_t order = 1; order < count; ++order) {
    for (std::size_t i = count - 1; i >= order; --i) {
      value[i] = (value[i] - value[i - 1]) / (node[i] - node[i - order]);
    }
  }
  std::array<Real, count> power{};
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = count; k-- > 0;) power[k] = (k > 0 ? power[k - 1] : value[i]) - node[i] * power[k];
  }
  return power;
}

}  // namespace railtab
