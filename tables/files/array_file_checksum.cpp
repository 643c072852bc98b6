#include "railtab/tables/files/array_file.hpp"

namespace railtab {

namespace {

std::uint64_t of_bytes(std::span<const std::byte> bytes, std::uint64_t hash) noexcept {
  constexpr std::uint64_t prime = 1099511628211ULL;
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * prime;
  return hash;
}

}  // namespace

std::uint64_t checksum(std::span<const double> values, std::uint64_t seed) noexcept {
  return of_bytes(std::as_bytes(values), seed);
}

std::uint64_t checksum(std::span<const float> values, std::uint64_t seed) noexcept {
  return of_bytes(std::as_bytes(values), seed);
}

std::uint64_t checksum(std::span<const std::uint32_t> values, std::uint64_t seed) noexcept {
  return of_bytes(std::as_bytes(values), seed);
}

}  // namespace railtab
