#pragma once

#include <array>

namespace railtab {

/// Kalker's coefficients {c11, c22, c23, c33} of a slender ellipse, to leading orders in g = min(a/b, b/a)
/// [Kalker1990, Table E.3 with its asymptotes]; a/b -> 0 for ratio < 1, a/b -> infinity for ratio > 1.
/// @param ratio a/b > 0, meant below 0.1 or above 10; @param nu 0..0.5
[[nodiscard]] std::array<double, 4> kalker_asymptotes(double ratio, double nu) noexcept;

}  // namespace railtab
