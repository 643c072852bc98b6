#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace railtab {

/// The user's input is wrong. Commands print the message and end with exit code 2.
/// The message names the place (file and line, or key), what was found and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A computation on valid input failed. Commands print the message and end with exit code 1.
class ComputationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "<place>: found <found>, expected <expected>".
/// `place` is a file with line ("wheel.prw:41"), a key ("scene.toml: track.gauge") or a dataset.
[[nodiscard]] InputError input_error(std::string_view place, std::string_view found, std::string_view expected);

}  // namespace railtab
