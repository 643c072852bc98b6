#pragma once

namespace railtab {

/// Memory that this process occupies now, program and libraries included [bytes]; 0 where the system does not tell.
[[nodiscard]] double resident_memory() noexcept;
/// The most that it has occupied so far [bytes]; 0 where the system does not tell.
[[nodiscard]] double peak_resident_memory() noexcept;

/// What this machine has [bytes]; 0 where the system does not tell.
[[nodiscard]] double installed_memory() noexcept;

/// From here on memory that is freed in large pieces goes back to the system at once, so that what a process occupies
/// is nearly what it uses. The allocator's own way is to keep ever larger pieces for later.
void return_large_pieces() noexcept;
/// Gives freed memory that is kept for later back to the system: resident_memory() then is what is in use.
void return_freed_memory() noexcept;

}  // namespace railtab
