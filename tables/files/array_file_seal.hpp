#pragma once

#include <cstddef>
#include <filesystem>

namespace railtab {

/// A finished file begins with a block (an HDF5 user block) that holds a checksum of all bytes after it. So damage is
/// found before HDF5 reads anything, which on damaged files leaks memory and has been known to crash.
inline constexpr std::size_t seal_bytes = 512;  // the smallest user block of HDF5

/// Writes the block of a file that was made with room for it. @throws InputError where it cannot be written.
void seal_file(const std::filesystem::path& file);

/// Whether the file begins as a sealed one does. Growing files and files rewritten by other programs do not.
[[nodiscard]] bool is_sealed(const std::filesystem::path& file);

/// @throws InputError where the bytes do not agree with the seal: cut short or damaged.
void check_seal(const std::filesystem::path& file);

}  // namespace railtab
