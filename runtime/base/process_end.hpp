#pragma once

#include <functional>
#include <string_view>

namespace railtab {

/// How a process ends.
namespace exit_code {
inline constexpr int done = 0, failed = 1, wrong_input = 2;
inline constexpr int clause_fails = 3;   ///< computed, and a clause that was asked for fails (vsi assess --fail-on)
inline constexpr int interrupted = 130;  ///< by Ctrl-C; the same command goes on
}  // namespace exit_code

/// Writes a message to standard error, bytes that are no printable characters as \xNN. That it cannot be written there
/// (a full disk) changes nothing else.
void print_message(std::string_view text) noexcept;

/// The same to standard output. run_process() says where it could not be written.
void print_text(std::string_view text) noexcept;

/// Runs all of a command, `program` in its messages on standard error, and says how the process ends: what `command`
/// returns; 2 for InputError and names that the system rejects; 1 for any other exception and where standard output
/// could not be written. A process that fails ends here, without the clean-up of libraries: HDF5 keeps open what it
/// could not write or read, crashes over it on a full disk and complains of damaged files; every file has been closed
/// as far as it can be. @return 0
int run_process(std::string_view program, const std::function<int()>& command);

}  // namespace railtab
