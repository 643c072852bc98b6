#pragma once

#include <string>
#include <string_view>

namespace railtab::report {

/// Text as HTML content or attribute value: & < > and quotes escaped, \xNN for bytes that are no printable characters.
[[nodiscard]] std::string escaped(std::string_view text);

/// A number as a reader wants it: `digits` significant digits, no exponent between 1e-4 and 1e7, a true minus sign.
[[nodiscard]] std::string shown(double value, int digits = 3);

}  // namespace railtab::report
