#pragma once

#include <array>
#include <cstdint>

namespace railtab {

/// Philox4x32-10 [SalmonEtAl2011]: four random words of a counter and a key, without a state.
[[nodiscard]] std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) noexcept;

/// Which random number: the same three give the same number, on any number of threads and in any order.
struct RandomPlace {
  std::uint64_t sample = 0;  ///< of a run, of a replicate
  std::uint32_t variable = 0;
  std::uint32_t stream = 0;  ///< keeps apart what one seed is used for
};

/// Uniform in the open interval (0, 1), 53 bits: a multiple of 2⁻⁵³ plus 2⁻⁵⁴.
[[nodiscard]] double uniform_random(std::uint64_t seed, const RandomPlace& place) noexcept;
/// Standard normal: Φ⁻¹ of uniform_random().
[[nodiscard]] double normal_random(std::uint64_t seed, const RandomPlace& place) noexcept;

}  // namespace railtab
