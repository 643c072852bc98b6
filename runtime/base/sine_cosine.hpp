#pragma once

#include <cmath>
#include <concepts>

#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Sine and cosine to rounding, of an angle or of angles side by side; of small ones by their series, in a tenth of the
/// library's time.
template <class V>
struct SineCosineOf {
  V sine, cosine;

  explicit SineCosineOf(const V& angle) noexcept {
    if constexpr (std::same_as<V, double>) {
      constexpr double series_limit = 0.1;  // the first terms left out are 3e-18 of the sine, 3e-17 of the cosine
      const double x = angle * angle;
      if (angle == 0.0) {  // most tracks have no cross-level
        sine = 0.0;
        cosine = 1.0;
      } else if (x <= series_limit * series_limit) {
        sine = angle + angle * x * (-1.0 / 6 + x * (1.0 / 120 + x * (-1.0 / 5040 + x * (1.0 / 362880))));
        cosine = 1.0 + x * (-0.5 + x * (1.0 / 24 + x * (-1.0 / 720 + x * (1.0 / 40320))));
      } else {
        sine = std::sin(angle);
        cosine = std::cos(angle);
      }
    } else {
      constexpr double series_limit = 1.6;  // contact angles; the first terms left out are below 1e-18
      if (!all(abs(angle) < series_limit)) {
        for (int i = 0; i < lanes_of<V>; ++i) {
          lane(sine, i) = std::sin(lane(angle, i));
          lane(cosine, i) = std::cos(lane(angle, i));
        }
        return;
      }
      const V x = angle * angle;
      sine = cosine = broadcast<V>(1.0);
      for (int k = 24; k > 0; k -= 2) {
        sine = 1.0 - x * sine * (1.0 / (k * (k + 1)));
        cosine = 1.0 - x * cosine * (1.0 / (k * (k - 1)));
      }
      sine = sine * angle;
    }
  }
};
using SineCosine = SineCosineOf<double>;

}  // namespace railtab
