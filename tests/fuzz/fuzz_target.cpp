#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "mutation.hpp"
#include "readers.hpp"

namespace {

/// That of the environment variable RAILTAB_FUZZ_READER.
const railtab::fuzz::Reader& tested() {
  static const railtab::fuzz::Reader& reader = []() -> const railtab::fuzz::Reader& {
    const char* name = std::getenv("RAILTAB_FUZZ_READER");
    return railtab::fuzz::reader(name ? name : "");
  }();
  return reader;
}

}  // namespace

/// Before the search: writes the seed of a binary format into the folder of the corpus, the first argument without a
/// dash. Without arguments the readers' names are printed.
extern "C" int LLVMFuzzerInitialize(const int* count, char*** arguments) {
  if (*count == 1) {
    for (const railtab::fuzz::Reader& reader : railtab::fuzz::readers()) std::puts(reader.name.c_str());
    std::exit(0);
  }
  for (int i = 1; i < *count && tested().write_seed; ++i) {
    const std::filesystem::path folder = (*arguments)[i];
    if (!std::filesystem::is_directory(folder)) continue;
    if (!std::filesystem::exists(folder / "seed")) tested().write_seed(folder / "seed");
    break;
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Every other time libFuzzer's own mutations, else those that know of lines and numbers.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  if (seed % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::mt19937_64 random(seed);
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  static const std::string vocabulary = tested().vocabulary ? tested().vocabulary() : std::string();
  const std::string result = railtab::fuzz::mutated(bytes, vocabulary.empty() ? bytes : vocabulary, random);
  const std::size_t length = std::min(result.size(), max_size);
  std::copy_n(result.begin(), length, data);
  return length;
}

/// libFuzzer's entry.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  railtab::fuzz::accepts(tested(), {reinterpret_cast<const char*>(data), size});
  return 0;
}
