#pragma once

#include <random>
#include <string>

namespace railtab::fuzz {

/// The bytes with one to four changes: bytes flipped, cut out, repeated or taken from `other`; lines left out,
/// repeated, exchanged or taken from `other`; numbers replaced by extreme ones.
[[nodiscard]] std::string mutated(std::string bytes, const std::string& other, std::mt19937_64& random);

}  // namespace railtab::fuzz
