#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace railtab {

/// 64-bit checksum that takes eight bytes at a time: h := (h XOR word)·p,
/// then h := h XOR h >> 32, with the prime p of FNV. Each step is a bijection of h, so that a change within one word
/// always shows; the shift keeps changes of the highest bits of two words from cancelling. The last bytes are filled up
/// with zeros to a word: add the length where it may vary.
[[nodiscard]] std::uint64_t word_checksum(std::span<const std::byte> bytes,
                                          std::uint64_t seed = 14695981039346656037ULL) noexcept;

/// Of the contents and the length of a file, 16 hexadecimal digits: tells whether an input has changed. A file that the
/// file system says is untouched since its sum was last asked for is not read again.
/// @throws InputError where it cannot be read.
[[nodiscard]] std::string file_checksum(const std::filesystem::path& file);

}  // namespace railtab
