// Results with changed bytes: read as they were written, or rejected; resumed to the same bits, or rejected in time.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "result_fixture.hpp"

namespace railtab {
namespace {

class DamagedResults : public ResultFile {
 protected:
  void SetUp() override {
    header_.scene_text.resize(200);
    header_.input_files = {"irregularity.csv"};
    header_.input_checksums = {"0123456789abcdef"};
  }

  /// Changes one byte after the other and expects an InputError or what was there before; in steps, for speed.
  void expect_changes_found(std::size_t every) {
    const std::string whole = all_read(file_);
    std::string bytes;
    {
      std::ifstream stream(file_, std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::mt19937 random(7);
    std::uniform_int_distribution<int> mask(1, 255);
    long rejected = 0, tried = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      // what lies between the objects is zero and means nothing
      if (bytes[i] == 0 ? i % 49999 != 0 : i % every != 0) continue;
      const char was = bytes[i];
      std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
      stream.seekp(static_cast<std::streamoff>(i)).put(static_cast<char>(was ^ mask(random)));
      stream.close();
      ++tried;
      try {
        EXPECT_TRUE(all_read(file_) == whole) << "byte " << i << " was changed and believed";
      } catch (const InputError& error) {
        ++rejected;
        EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
      }
      stream.open(file_, std::ios::binary | std::ios::in | std::ios::out);
      stream.seekp(static_cast<std::streamoff>(i)).put(was);
    }
    EXPECT_GT(rejected, tried / 10) << "the others: room for rows that are not written";
    EXPECT_TRUE(all_read(file_) == whole);
  }
};

TEST_F(DamagedResults, OfAFinishedRunAreRejected) {
  {
    ResultWriter out(file_, header_, 3);
    for (long i = 0; i < 8; ++i) out.append(made_up_record(i, header_));
    out.finish(complete_summary());
  }
  expect_changes_found(97);
}

TEST_F(DamagedResults, OfAnEndedRunWithCheckpointsAreRejected) {
  {
    ResultWriter out(file_, header_, 3);
    for (long i = 0; i < 8; ++i) out.append(made_up_record(i, header_));
    out.checkpoint(made_up_state(8), 8);
  }
  expect_changes_found(293);
}

/// Whether a byte is to be damaged: some that mean something, or every n-th by RAILTAB_DAMAGE_EVERY=n, for a longer
/// search.
bool is_damaged(const std::string& bytes, std::size_t i) {
  if (const char* text = std::getenv("RAILTAB_DAMAGE_EVERY")) {
    return i % std::max<std::size_t>(1, std::strtoul(text, nullptr, 10)) == 0;
  }
  return bytes[i] != 0 && i % 3644 == 2733;  // two of which lie in the indices of chunks
}

class DamagedCheckpoint : public DamagedResults {
 protected:
  static constexpr long records = 24;

  void SetUp() override {
    header_ = made_up_header(false);  // without nodes the file is below 1 MB
    DamagedResults::SetUp();
  }

  [[nodiscard]] static std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// As vsi run --resume does.
  void resume() const {
    static_cast<void>(read_results(file_));
    const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(file_);
    if (!from) return;
    ResultWriter out = ResultWriter::resume(file_, *from, 5);
    for (long i = static_cast<long>(from->records); i < records; ++i) {
      out.append(made_up_record(i, header_));
      if (i % 7 == 6) out.checkpoint(made_up_state(i), i);
    }
    out.finish(complete_summary());
  }

  enum class End { same = 0, without_checkpoint, rejected, other_bits, neither };

  /// In a process of its own, which ends after 5 s at the latest.
  [[nodiscard]] End end_of_resume(const std::string& whole) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(5);
      End end = End::other_bits;
      try {
        resume();
        const bool finished = read_results(file_).summary.complete;
        end = !finished ? End::without_checkpoint : all_read(file_) == whole ? End::same : End::other_bits;
      } catch (const InputError&) {
        end = End::rejected;
      } catch (const ComputationError&) {
        end = End::rejected;
      }
      ::_exit(static_cast<int>(end));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? static_cast<End>(WEXITSTATUS(status)) : End::neither;
  }
};

TEST_F(DamagedCheckpoint, IsResumedToTheSameBitsOrRejectedInTime) {
  {
    ResultWriter out(file_, header_, 5);
    for (long i = 0; i < records / 2; ++i) {
      out.append(made_up_record(i, header_));
      if (i % 4 == 3) out.checkpoint(made_up_state(i), i);
    }
  }
  std::string bytes = bytes_of(file_);
  ASSERT_LE(bytes.size(), 1U << 20U);
  resume();
  const std::string whole = all_read(file_);
  std::mt19937 random(11);
  std::uniform_int_distribution<int> mask(1, 255);
  int same = 0, rejected = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (!is_damaged(bytes, i)) continue;
    std::string damaged = bytes;
    damaged[i] ^= static_cast<char>(mask(random));
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << damaged;
    const End end = end_of_resume(whole);
    EXPECT_LT(end, End::other_bits) << "byte " << i << (end == End::neither ? ": a crash, or no end" : ": other bits");
    same += end == End::same ? 1 : 0;
    rejected += end == End::rejected ? 1 : 0;
  }
  EXPECT_GT(same, 0);
  EXPECT_GT(rejected, 0);
}

}  // namespace
}  // namespace railtab
