#include <cstddef>
#include <cstdint>

#include "readers.hpp"

/// libFuzzer's entry: one program for each reader, named by RAILTAB_FUZZ_READER.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const railtab::fuzz::Reader& reader = railtab::fuzz::reader(RAILTAB_FUZZ_READER);
  railtab::fuzz::accepts(reader, {reinterpret_cast<const char*>(data), size});
  return 0;
}
