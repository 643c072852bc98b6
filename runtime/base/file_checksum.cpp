#include "railtab/runtime/base/file_checksum.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

std::uint64_t word_checksum(std::span<const std::byte> bytes, std::uint64_t seed) noexcept {
  constexpr std::uint64_t prime = 1099511628211ULL;
  constexpr std::size_t word_bytes = sizeof(std::uint64_t);
  std::uint64_t hash = seed;
  for (std::size_t i = 0; i < bytes.size(); i += word_bytes) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, i + word_bytes <= bytes.size() ? word_bytes : bytes.size() - i);
    hash = (hash ^ word) * prime;
    hash ^= hash >> 32U;
  }
  return hash;
}

std::string file_checksum(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw input_error(file.string(), std::strerror(errno), "a readable file");
  std::vector<std::byte> buffer(std::size_t{1} << 16U);  // whole words
  std::uint64_t sum = word_checksum({});
  std::uint64_t length = 0;
  while (stream) {
    stream.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size()));
    const auto bytes = static_cast<std::size_t>(stream.gcount());
    sum = word_checksum(std::span(buffer).first(bytes), sum);
    length += bytes;
  }
  if (stream.bad()) throw input_error(file.string(), std::strerror(errno), "a file readable to its end");
  return fmt::format("{:016x}", word_checksum(std::as_bytes(std::span(&length, 1)), sum));
}

}  // namespace railtab
