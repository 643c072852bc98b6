#include "railtab/tables/files/array_file_seal.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

constexpr std::string_view mark = "railtab\n";

/// The whole block, so that damage to any of its bytes shows: mark, length of the rest, checksum of the rest, zeros.
std::string seal_of(std::uint64_t length, std::uint64_t sum) {
  std::string block =
      fmt::format("{}{} bytes follow this block of {}, FNV-1a {:016x}\n", mark, length, seal_bytes, sum);
  block.resize(seal_bytes, '\0');
  return block;
}

/// Of everything after the block; the last bytes are filled up with zeros to a whole number.
std::string expected_seal(std::istream& stream) {
  stream.seekg(seal_bytes);
  std::vector<double> buffer(8192);
  std::uint64_t sum = checksum({});
  std::uint64_t length = 0;
  while (stream) {
    stream.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size() * sizeof(double)));
    const std::size_t bytes = static_cast<std::size_t>(stream.gcount());
    std::memset(reinterpret_cast<char*>(buffer.data()) + bytes, 0, buffer.size() * sizeof(double) - bytes);
    sum = checksum(std::span(buffer).first((bytes + sizeof(double) - 1) / sizeof(double)), sum);
    length += bytes;
  }
  return seal_of(length, sum);
}

}  // namespace

std::uint64_t checksum_of_bytes(std::span<const std::byte> bytes, std::uint64_t seed) noexcept {
  constexpr std::uint64_t prime = 1099511628211ULL;
  for (const std::byte byte : bytes) seed = (seed ^ static_cast<std::uint64_t>(byte)) * prime;
  return seed;
}

void seal_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string block = expected_seal(in);
  std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
  out.write(block.data(), static_cast<std::streamsize>(block.size()));
  out.close();
  if (!out) throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), std::strerror(errno)));
}

bool is_sealed(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, mark.size()> head{};
  stream.read(head.data(), head.size());
  return std::string_view(head.data(), head.size()) == mark;
}

void check_seal(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string found(seal_bytes, '\0');
  stream.read(found.data(), static_cast<std::streamsize>(found.size()));
  stream.clear();
  const std::string expected = expected_seal(stream);
  if (found == expected) return;
  // Of a seal that is as it was written, the length tells what happened.
  unsigned long long length = 0, sum = 0;
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failed);
  if (std::sscanf(found.c_str() + mark.size(), "%llu bytes follow this block of %*u, FNV-1a %llx", &length, &sum) !=
          2 ||
      found != seal_of(length, sum)) {
    throw input_error(file.string(), fmt::format("damage in the first {} bytes", seal_bytes),
                      "the seal with which railtab writes tables");
  }
  const std::uint64_t written = seal_bytes + length;
  if (bytes != written) {
    throw input_error(file.string(), fmt::format("{} bytes", bytes),
                      fmt::format("{} bytes: the file is {}", written, bytes < written ? "cut short" : "too long"));
  }
  throw input_error(file.string(), fmt::format("contents that are not those that were written ({} bytes)", bytes),
                    fmt::format("their checksum {:016x}: the file is damaged", sum));
}

}  // namespace railtab
