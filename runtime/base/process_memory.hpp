#pragma once

namespace railtab {

/// Memory that this process occupies now, program and libraries included [bytes]; 0 where the system does not tell.
[[nodiscard]] double resident_memory() noexcept;
/// The most that it has occupied so far [bytes]; 0 where the system does not tell.
[[nodiscard]] double peak_resident_memory() noexcept;

/// From here on memory that is freed in large pieces goes back to the system at once, so that what a process occupies
/// is what it uses. The allocator's own way is to keep ever larger pieces for later.
void return_large_pieces() noexcept;

}  // namespace railtab
