#pragma once

#include <string_view>

namespace railtab {

/// Checks of one user parameter; `key` names it as the user wrote it ("track.sleeper_spacing"), `unit` is for the
/// message.
/// @throws InputError with the key, the value found and the range expected; a value that is not finite never passes.
void require_positive(std::string_view key, double value, std::string_view unit);
void require_not_negative(std::string_view key, double value, std::string_view unit);
void require_between(std::string_view key, double value, double low, double high, std::string_view unit);

}  // namespace railtab
