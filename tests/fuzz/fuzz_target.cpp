#include <cstddef>
#include <cstdint>

#include <filesystem>

#include "readers.hpp"

/// Before the search: writes the seed of a binary format into the folder of the corpus, the first argument without a
/// dash.
extern "C" int LLVMFuzzerInitialize(const int* count, char*** arguments) {
  const railtab::fuzz::Reader& reader = railtab::fuzz::reader(RAILTAB_FUZZ_READER);
  for (int i = 1; i < *count && reader.write_seed; ++i) {
    const std::filesystem::path folder = (*arguments)[i];
    if (!std::filesystem::is_directory(folder)) continue;
    if (!std::filesystem::exists(folder / "seed")) reader.write_seed(folder / "seed");
    break;
  }
  return 0;
}

/// libFuzzer's entry: one program for each reader, named by RAILTAB_FUZZ_READER.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const railtab::fuzz::Reader& reader = railtab::fuzz::reader(RAILTAB_FUZZ_READER);
  railtab::fuzz::accepts(reader, {reinterpret_cast<const char*>(data), size});
  return 0;
}
