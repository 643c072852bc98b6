#include "railtab/tables/files/array_file_seal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/file_signatures.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

constexpr std::string_view mark = sealed_file_signature;
static_assert(mark.size() == hdf5_signature.size());

// Checksums of seals. 64-bit FNV-1a, of earlier versions, is only read.
constexpr std::string_view word_sum = "word checksum", byte_sum = "FNV-1a";

/// The whole block, so that damage to any of its bytes shows: mark, length of the rest, checksum of the rest, zeros.
std::string seal_of(std::uint64_t length, std::string_view kind, std::uint64_t sum) {
  std::string block =
      fmt::format("{}{} bytes follow this block of {}, {} {:016x}\n", mark, length, seal_bytes, kind, sum);
  block.resize(seal_bytes, '\0');
  return block;
}

/// Of everything after the block; the last bytes are filled up with zeros to a whole number.
std::string expected_seal(std::istream& stream, std::string_view kind) {
  const auto continued = kind == word_sum ? word_checksum : checksum_of_bytes;
  stream.seekg(seal_bytes);
  std::vector<char> buffer(std::size_t{1} << 16U);
  std::uint64_t sum = checksum_seed, length = 0;
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto bytes = static_cast<std::size_t>(stream.gcount());
    length += bytes;
    const std::size_t whole = (bytes + sizeof(double) - 1) / sizeof(double) * sizeof(double);
    std::fill(buffer.begin() + static_cast<std::ptrdiff_t>(bytes), buffer.begin() + static_cast<std::ptrdiff_t>(whole),
              '\0');
    sum = continued(std::as_bytes(std::span(buffer)).first(whole), sum);
  }
  return seal_of(length, kind, sum);
}

std::string first_bytes(std::istream& stream, std::size_t count) {
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  stream.clear();
  return bytes;
}

void check_seal(const std::filesystem::path& file, std::istream& stream, std::uint64_t bytes) {
  const std::string found = first_bytes(stream, seal_bytes);
  const std::string_view kind = found.find(byte_sum) == std::string::npos ? word_sum : byte_sum;
  if (found == expected_seal(stream, kind)) return;
  // Of a seal that is as it was written, the length tells what happened.
  unsigned long long length = 0, sum = 0;
  const std::size_t sum_at = found.find(kind) + kind.size();
  const bool readable = std::sscanf(found.c_str() + mark.size(), "%llu bytes follow", &length) == 1 &&
                        sum_at < found.size() && std::sscanf(found.c_str() + sum_at, "%llx", &sum) == 1;
  if (!readable || found != seal_of(length, kind, sum)) {
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

}  // namespace

std::uint64_t checksum_of_bytes(std::span<const std::byte> bytes, std::uint64_t seed) noexcept {
  constexpr std::uint64_t prime = 1099511628211ULL;
  for (const std::byte byte : bytes) seed = (seed ^ static_cast<std::uint64_t>(byte)) * prime;
  return seed;
}

void seal_file(const std::filesystem::path& file) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  const std::string block = expected_seal(stream, word_sum);
  stream.clear();
  stream.seekp(0);
  stream.write(block.data(), static_cast<std::streamsize>(block.size()));
  stream.close();
  if (!stream) throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), std::strerror(errno)));
}

bool is_array_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string head = first_bytes(stream, mark.size());
  return head == mark || head == hdf5_signature;
}

std::uint64_t inspect_file(const std::filesystem::path& file) {
  if (!is_file(file)) throw input_error(file.string(), std::string(what_is_at(file)), "an HDF5 file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw input_error(file.string(), std::strerror(errno), "a readable file");
  const bool sealed = first_bytes(stream, mark.size()) == mark;
  stream.seekg(sealed ? seal_bytes : 0);
  const std::string head = first_bytes(stream, 36);  // superblock [HDF5 file format specification 3.0, section II.A]
  // after the superblock: a writer that ends between the two has extended the file to what the superblock says
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file, error);
  if (sealed) {
    stream.seekg(0);
    check_seal(file, stream, bytes);
  }
  if (!head.starts_with(hdf5_signature)) {
    throw input_error(file.string(), bytes == 0 ? "an empty file" : "no HDF5 signature", "an HDF5 file");
  }
  constexpr int written_format = 3, eight_byte_offsets = 8;
  if (head[8] != written_format || head[9] != eight_byte_offsets) {
    throw input_error(file.string(), fmt::format("an HDF5 superblock of version {}", int{head[8]}),
                      fmt::format("version {} with 8-byte offsets, as railtab writes it", written_format));
  }
  const bool being_written = (static_cast<unsigned char>(head[11]) & 1U) != 0;
  std::uint64_t end_of_file = 0;
  std::memcpy(&end_of_file, head.data() + 28, sizeof end_of_file);
  // While a file is written, its end runs ahead of the superblock or behind it; reading then checks dataset by dataset.
  if (!being_written && bytes < end_of_file) {
    throw input_error(file.string(), fmt::format("{} bytes", bytes),
                      fmt::format("{} bytes: the file is cut short", end_of_file));
  }
  return bytes;
}

}  // namespace railtab
