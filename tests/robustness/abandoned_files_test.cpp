// What a killed writer leaves under its temporary name goes when its output is next written; what a living one writes
// stays.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;
using Mode = ArrayFileWriter::Mode;

/// A process that has begun a file and waits.
class Writer {
 public:
  Writer(const fs::path& file, Mode mode) {
    EXPECT_EQ(::pipe(begun_.data()), 0);
    EXPECT_EQ(::pipe(go_on_.data()), 0);
    process_ = ::fork();
    if (process_ != 0) {
      char byte = 0;
      EXPECT_EQ(::read(begun_[0], &byte, 1), 1);
      return;
    }
    char byte = 0;
    ArrayFileWriter out(file, "test-file", 1, mode);
    out.write("values", std::vector<double>(1000, 1.0), {1000}, "1", "values");
    if (::write(begun_[1], &byte, 1) != 1 || ::read(go_on_[0], &byte, 1) != 1) ::_exit(1);
    out.close();
    ::_exit(0);
  }
  ~Writer() {
    if (process_ > 0) kill();
    for (const int end : {begun_[0], begun_[1], go_on_[0], go_on_[1]}) ::close(end);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Kills it and waits for its end, without taking its number away.
  void end_unseen() {
    ::kill(process_, SIGKILL);
    siginfo_t ended{};
    EXPECT_EQ(::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOWAIT), 0);
  }
  void kill() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  [[nodiscard]] int finish() {
    char byte = 0;
    EXPECT_EQ(::write(go_on_[1], &byte, 1), 1);
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::array<int, 2> begun_{}, go_on_{};
  pid_t process_ = 0;
};

class AbandonedFiles : public testing::InFolder, public ::testing::WithParamInterface<Mode> {
 protected:
  [[nodiscard]] std::vector<fs::path> temporaries() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (entry.path().filename().string().find(".part-") != std::string::npos) found.push_back(entry.path());
    }
    return found;
  }
  void write_array(const std::string& name) const {
    ArrayFileWriter out(folder_ / name, "test-file", 1, GetParam());
    out.write("values", std::vector<double>{2.0}, {1}, "1", "values");
    out.close();
  }
  [[nodiscard]] double first_value() const {
    return ArrayFileReader(folder_ / "a.h5", "test-file", 1).read("values").values.at(0);
  }
};

TEST_P(AbandonedFiles, OfAKilledWriterGo) {
  for (int killed = 0; killed < 2; ++killed) Writer(folder_ / "a.h5", GetParam()).kill();
  EXPECT_EQ(temporaries().size(), 1U) << "the second took the first one's away";
  EXPECT_FALSE(fs::exists(folder_ / "a.h5"));
  write_array("b.h5");
  EXPECT_EQ(temporaries().size(), 1U) << "another output's";
  write_array("a.h5");
  EXPECT_EQ(temporaries().size(), 0U);
  EXPECT_EQ(first_value(), 2.0);
}

TEST_P(AbandonedFiles, OfALivingWriterStay) {
  Writer living(folder_ / "a.h5", GetParam());
  write_array("a.h5");
  EXPECT_EQ(temporaries().size(), 1U);
  EXPECT_EQ(first_value(), 2.0);
  EXPECT_EQ(living.finish(), 0);
  EXPECT_EQ(temporaries().size(), 0U);
  EXPECT_EQ(first_value(), 1.0) << "the last that was finished";
}

// The lock counts, not the name: whatever process it is that holds it.
TEST_P(AbandonedFiles, LockedOnesStay) {
  Writer living(folder_ / "a.h5", GetParam());
  const fs::path elsewhere = folder_ / "a.h5.part-aaaaaaaaaaaa";
  fs::rename(temporaries().at(0), elsewhere);
  write_array("a.h5");
  EXPECT_TRUE(fs::exists(elsewhere));
  living.kill();
  write_array("a.h5");
  EXPECT_FALSE(fs::exists(elsewhere));
}

// A process that has ended and that nobody has asked about yet still has its number.
TEST_P(AbandonedFiles, OfAZombieGo) {
  Writer zombie(folder_ / "a.h5", GetParam());
  zombie.end_unseen();
  write_array("a.h5");
  EXPECT_EQ(temporaries().size(), 0U);
}

// Parts of a table and what only looks alike.
TEST_P(AbandonedFiles, OthersStay) {
  const std::vector<std::string> names{"a.h5.part-0-1",
                                       "a.h5.part-elsewhere.example-2147483646-0",
                                       "a.h5.part-",
                                       "a.h5.part",
                                       "a.h5.part-abcdefghijk",
                                       "a.h5.part-abcdefghijklm",
                                       "a.h5.part-ABCDEFGHIJKL",
                                       "b.h5.part-abcdefghijkl"};
  for (const std::string& name : names) write(name, "kept");
  write_array("a.h5");
  for (const std::string& name : names) EXPECT_TRUE(fs::exists(folder_ / name)) << name;
}

INSTANTIATE_TEST_SUITE_P(Modes, AbandonedFiles, ::testing::Values(Mode::whole_or_nothing, Mode::growing),
                         [](const auto& mode) {
                           return mode.param == Mode::growing ? std::string("Growing") : std::string("Whole");
                         });

}  // namespace
}  // namespace railtab
