#pragma once

#include <string_view>

namespace railtab {

/// What files begin with.
inline constexpr std::string_view hdf5_signature("\x89HDF\r\n\x1a\n", 8);
inline constexpr std::string_view sealed_file_signature = "railtab\n";  ///< tables: array_file_seal.hpp
inline constexpr std::string_view zip_signature("PK\x03\x04", 4);
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  ///< of texts of Windows programs, UTF-8

}  // namespace railtab
