#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace railtab {

/// Bytes of the printable character that a text begins with: of ASCII, of UTF-8, or a line feed. 0 where there is none:
/// a control character, which could change what a terminal shows, or bytes that are no UTF-8.
[[nodiscard]] std::size_t printable_bytes(std::string_view text) noexcept;

/// Text from a file as it may be shown on a terminal or a page: \xNN in place of each byte that belongs to no printable
/// character.
[[nodiscard]] std::string printable(std::string_view text);

/// The same; where the text has such bytes, no more than the first `longest`.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest);

}  // namespace railtab
