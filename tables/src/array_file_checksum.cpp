#include "railtab/tables/array_file.hpp"

namespace railtab {

std::uint64_t checksum(std::span<const double> values, std::uint64_t seed) noexcept {
  constexpr std::uint64_t prime = 1099511628211ULL;
  std::uint64_t hash = seed;
  for (const std::byte byte : std::as_bytes(values)) {
    hash = (hash ^ static_cast<std::uint64_t>(byte)) * prime;
  }
  return hash;
}

}  // namespace railtab
