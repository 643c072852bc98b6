#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "mutation.hpp"
#include "readers.hpp"

namespace railtab::fuzz {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> seeds_of(const Reader& reader) {
  std::vector<std::string> seeds;
  if (reader.write_seed) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("railtab_seed_" + std::to_string(::getpid()) + reader.extension);
    reader.write_seed(file);
    seeds.push_back(contents(file));
    std::filesystem::remove(file);
    return seeds;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(RAILTAB_SOURCE_DIR "/tests/fuzz/seeds/" + reader.name)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) seeds.push_back(contents(file));
  return seeds;
}

/// Mutated inputs of each reader: RAILTAB_FUZZ_RUNS for a longer search.
int runs() {
  const char* text = std::getenv("RAILTAB_FUZZ_RUNS");
  return text == nullptr ? 250 : std::atoi(text);
}

class FuzzedReader : public ::testing::TestWithParam<Reader> {};

// Whatever the bytes are, a reader returns or throws InputError: no other exception, and under the sanitizers no fault.
TEST_P(FuzzedReader, AcceptsOrRejects) {
  const Reader& reader = GetParam();
  const std::vector<std::string> seeds = seeds_of(reader);
  ASSERT_FALSE(seeds.empty());
  int good = 0;
  for (const std::string& seed : seeds) good += accepts(reader, seed) ? 1 : 0;
  EXPECT_GT(good, 0) << "one seed at least is a good file";
  std::mt19937_64 random(20240131);
  int rejected = 0;
  for (int i = 0; i < runs(); ++i) {
    const auto any = [&] { return seeds[std::uniform_int_distribution<std::size_t>(0, seeds.size() - 1)(random)]; };
    const std::string other = reader.vocabulary && i % 2 == 0 ? reader.vocabulary() : any();
    const std::string bytes = mutated(any(), other, random);
    try {
      rejected += accepts(reader, bytes) ? 0 : 1;
    } catch (const std::exception& error) {
      const std::filesystem::path kept = std::filesystem::temp_directory_path() / ("railtab_fuzz_" + reader.name);
      std::ofstream(kept, std::ios::binary) << bytes;
      FAIL() << error.what() << "; the input is kept in " << kept;
    }
  }
  EXPECT_GT(rejected, runs() / 10);
}

/// docs/validation/fuzzing.csv has a row of every reader: tests/fuzz/run SECONDS READER adds one.
TEST(FuzzingRecord, NamesEveryReader) {
  const std::string record = contents(RAILTAB_SOURCE_DIR "/docs/validation/fuzzing.csv");
  for (const Reader& reader : readers()) {
    EXPECT_NE(record.find("\n" + reader.name + ","), std::string::npos) << reader.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, FuzzedReader, ::testing::ValuesIn(readers()),
                         [](const auto& value) { return value.param.name; });

}  // namespace
}  // namespace railtab::fuzz
