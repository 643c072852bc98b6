#pragma once

#include <string>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

/// What `use` returns: a value made from the numbers of a file, whose code does not know the file.
/// @throws InputError as `use` does, with `file` in front of a message that does not name it
template <class Use>
auto in_file(const std::string& file, const Use& use) {
  try {
    return use();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.find(file) != std::string::npos) throw;
    throw InputError(file + ": " + message);
  }
}

}  // namespace railtab
