#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace railtab {

/// A finished file begins with a block (an HDF5 user block) that holds a checksum of all bytes after it. So damage is
/// found before HDF5 reads anything, which on damaged files leaks memory and has been known to crash. Growing files and
/// files rewritten by other programs have none.
inline constexpr std::size_t seal_bytes = 512;  // the smallest user block of HDF5

/// Writes the block of a file that was made with room for it. @throws ComputationError where it cannot be written.
void seal_file(const std::filesystem::path& file);

/// Checks, before HDF5 opens it, that the file exists, agrees with its seal, is HDF5 and, unless it is being written,
/// not cut short. @return its size @throws InputError
std::uint64_t inspect_file(const std::filesystem::path& file);

}  // namespace railtab
