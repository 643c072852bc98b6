#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace railtab::testing {

/// The S1002 wheel profile straight from its published zones, steps at the joints included: z [mm] over y [mm].
/// Coefficients of UIC 510-2 / [EN13715]; each zone is left of its upper limit. Powers are summed term by term in
/// extended precision, another way than the library's Horner scheme.
inline double s1002_published(double y) {
  constexpr std::array<double, 9> b{0.0,
                                    -3.358537058e-2,
                                    1.565681624e-3,
                                    -2.810427944e-5,
                                    5.844240864e-8,
                                    -1.562379023e-8,
                                    5.309217349e-15,
                                    -5.957839843e-12,
                                    2.646656573e-13};
  constexpr std::array<double, 8> c{-4.320221063e3,  -1.038384026e3,  -1.065501873e2,  -6.051367875,
                                    -2.054332446e-1, -4.169739389e-3, -4.687195829e-5, -2.252755540e-7};
  const auto sum = [y](const auto& coefficients) {
    long double result = 0.0L;
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      result += static_cast<long double>(coefficients[i]) * std::pow(static_cast<long double>(y), static_cast<int>(i));
    }
    return static_cast<double>(result);
  };
  const auto root = [y](double radius, double centre) {
    return std::sqrt(radius * radius - (y - centre) * (y - centre));
  };
  if (y > 32.15796) return 1.364323640 - 0.066666667 * y;
  if (y > -26.0) return sum(b);
  if (y > -35.0) return sum(c);
  if (y > -38.426669071) return 16.446 - root(13.0, -26.210665);
  if (y > -39.764473993) return -93.576667419 - 2.747477419 * y;
  if (y > -49.662510381) return 8.834924130 + root(20.0, -58.558326413);
  if (y > -62.764705882) return 16.0 + root(12.0, -55.0);
  return 9.519259302 + root(20.5, -49.5);
}

/// Joints between the zones, from the flange to the field side [mm].
constexpr std::array<double, 7> s1002_joints{-62.764705882, -49.662510381, -39.764473993, -38.426669071,
                                             -35.0,         -26.0,         32.15796};

}  // namespace railtab::testing
