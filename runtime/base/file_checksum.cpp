#include "railtab/runtime/base/file_checksum.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
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

namespace {

std::string checksum_of_contents(const std::filesystem::path& file) {
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

/// What a file's entry in the file system says of its contents: another one after every change that is not made by a
/// mapping into memory or behind a network's cache.
struct FileState {
  dev_t device;
  ino_t number;
  off_t size;
  std::int64_t seconds, nanoseconds;  ///< of the last change
  bool operator==(const FileState&) const = default;
};

/// None where there is no such file, or its last change is so recent that another might have the same time.
std::optional<FileState> settled_state(const std::filesystem::path& file) {
  constexpr std::int64_t coarsest_clock = 2;  // s
  struct stat entry {};
  if (::stat(file.c_str(), &entry) != 0) return {};
  if (std::time(nullptr) - entry.st_ctim.tv_sec <= coarsest_clock) return {};
  return FileState{entry.st_dev, entry.st_ino, entry.st_size, entry.st_ctim.tv_sec, entry.st_ctim.tv_nsec};
}

struct KnownSum {
  FileState state;
  std::string sum;
};

}  // namespace

std::string file_checksum(const std::filesystem::path& file) {
  static std::mutex mutex;
  static std::map<std::filesystem::path, KnownSum> known;
  std::error_code failed;
  const std::filesystem::path name = std::filesystem::absolute(file, failed);
  const std::optional<FileState> before = failed ? std::nullopt : settled_state(name);
  if (before) {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(name); found != known.end() && found->second.state == *before) {
      return found->second.sum;
    }
  }
  std::string sum = checksum_of_contents(file);
  if (before && settled_state(name) == before) {
    const std::lock_guard lock(mutex);
    known.insert_or_assign(name, KnownSum{*before, sum});
  }
  return sum;
}

}  // namespace railtab
