#include "railtab/runtime/reliability/counter_random.hpp"

#include "railtab/runtime/reliability/standard_normal.hpp"

namespace railtab {
namespace {

constexpr unsigned word = 32;

constexpr std::uint32_t low(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t high(std::uint64_t x) noexcept { return static_cast<std::uint32_t>(x >> word); }

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) noexcept {
  constexpr std::uint64_t multiplier_0 = 0xD2511F53, multiplier_1 = 0xCD9E8D57;
  constexpr std::uint32_t weyl_0 = 0x9E3779B9, weyl_1 = 0xBB67AE85;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = multiplier_0 * c[0], p1 = multiplier_1 * c[2];
    c = {high(p1) ^ c[1] ^ k[0], low(p1), high(p0) ^ c[3] ^ k[1], low(p0)};
    k = {k[0] + weyl_0, k[1] + weyl_1};
  }
  return c;
}

double uniform_random(std::uint64_t seed, const RandomPlace& place) noexcept {
  const std::array<std::uint32_t, 4> words =
      philox({low(place.sample), high(place.sample), place.variable, place.stream}, {low(seed), high(seed)});
  const std::uint64_t bits = (static_cast<std::uint64_t>(words[1]) << word | words[0]) >> 11;
  return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

double normal_random(std::uint64_t seed, const RandomPlace& place) noexcept {
  return normal_quantile(uniform_random(seed, place));
}

}  // namespace railtab
