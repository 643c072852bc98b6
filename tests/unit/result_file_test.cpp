#include "railtab/runtime/results/result_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "result_fixture.hpp"

namespace railtab {
namespace {

TEST_F(ResultFile, ReturnsHeaderRecordsAndSummary) {
  RunSummary summary;
  summary.complete = true;
  summary.message = "none";
  long count = 0;
  for (long* value :
       {&summary.steps, &summary.newton_iterations, &summary.halved_steps, &summary.impact_steps,
        &summary.back_substitutions, &summary.contact_queries, &summary.table_queries, &summary.outside_creep_table,
        &summary.structure_dofs, &summary.vehicle_dofs, &summary.counted_from}) {
    *value = ++count;
  }
  for (double* value : {&summary.seconds_total, &summary.seconds_setup, &summary.seconds_pre_roll,
                        &summary.seconds_lookup, &summary.seconds_contact, &summary.seconds_structure,
                        &summary.seconds_vehicle, &summary.seconds_output, &summary.window_error}) {
    *value = static_cast<double>(++count) / 3.0;
  }
  summary.contact_mode = "table";
  summary.contact_energy = {.gain = 1.5,
                            .stiffness_work = -2.5,
                            .largest_step = 3.5,
                            .largest_step_time = 4.5,
                            .impacts = 5,
                            .largest_impact = -6.5,
                            .largest_impact_time = 7.5,
                            .largest_impact_stored = 8.5};
  summary.stops = {"coach-1: stop, left", "coach-2: stop, right", 0.25, 8e3, 0.5};
  summary.wheel_extremes = {
      .largest_Q = {1e5, 0.1, 0}, .smallest_Q = {2e4, 0.2, 1}, .derailment = {0.8, 0.3, 2}, .unloading = {0.6, 0.4, 3}};
  {
    ResultWriter out(file_, header_, 7);
    for (long i = 0; i < 500; ++i) out.append(made_up_record(i, header_));
    out.finish(summary);
  }
  const RunResults read = read_results(file_);
  ASSERT_EQ(read.steps.size(), 500U);
  expect_made_up_records(read, header_);

  EXPECT_EQ(read.header.scene_name, header_.scene_name);
  EXPECT_EQ(read.header.scene_text, header_.scene_text);
  EXPECT_EQ(read.header.program_version, header_.program_version);
  EXPECT_EQ(read.header.speed, header_.speed);
  EXPECT_EQ(read.header.wheel_x, header_.wheel_x);
  EXPECT_EQ(read.header.static_wheel_load, header_.static_wheel_load);
  EXPECT_EQ(read.header.body_names, header_.body_names);
  EXPECT_EQ(read.header.body_x, header_.body_x);
  EXPECT_EQ(read.header.span_from, header_.span_from);
  EXPECT_EQ(read.header.span_to, header_.span_to);
  EXPECT_EQ(read.header.built, header_.built);
  EXPECT_TRUE(read.header.left_out.empty());
  EXPECT_EQ(read.header.warnings, header_.warnings);
  EXPECT_EQ(read.header.node_names, header_.node_names);
  EXPECT_EQ(read.header.node_x, header_.node_x);
  EXPECT_EQ(read.header.wheel_profile, header_.wheel_profile);
  EXPECT_EQ(read.header.rail_profile, header_.rail_profile);
  EXPECT_EQ(read.header.wheel_y, header_.wheel_y);
  EXPECT_EQ(read.header.wheel_z, header_.wheel_z);
  EXPECT_EQ(read.header.rail_y, header_.rail_y);
  EXPECT_EQ(read.header.rail_z, header_.rail_z);

  const RunSummary& s = read.summary;
  EXPECT_TRUE(s.complete);
  EXPECT_EQ(s.message, "none");
  EXPECT_EQ(s.contact_mode, "table");
  EXPECT_EQ((std::vector<long>{s.steps, s.newton_iterations, s.halved_steps, s.impact_steps, s.back_substitutions,
                               s.contact_queries, s.table_queries, s.outside_creep_table, s.structure_dofs,
                               s.vehicle_dofs, s.counted_from}),
            (std::vector<long>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(
      (std::vector<double>{s.seconds_total, s.seconds_setup, s.seconds_pre_roll, s.seconds_lookup, s.seconds_contact,
                           s.seconds_structure, s.seconds_vehicle, s.seconds_output, s.window_error}),
      (std::vector<double>{12 / 3.0, 13 / 3.0, 14 / 3.0, 15 / 3.0, 16 / 3.0, 17 / 3.0, 18 / 3.0, 19 / 3.0, 20 / 3.0}));
  ASSERT_TRUE(s.contact_energy.has_value());
  const ContactEnergy& e = *s.contact_energy;
  EXPECT_EQ(e.impacts, 5);
  EXPECT_EQ((std::vector<double>{e.gain, e.stiffness_work, e.largest_step, e.largest_step_time, e.largest_impact,
                                 e.largest_impact_time, e.largest_impact_stored}),
            (std::vector<double>{1.5, -2.5, 3.5, 4.5, -6.5, 7.5, 8.5}));
  const auto numbers = [](const WheelExtreme& x) { return std::array{x.value, x.time, double(x.wheel)}; };
  ASSERT_TRUE(s.stops.has_value());
  EXPECT_EQ(s.stops->first_name, "coach-1: stop, left");
  EXPECT_EQ(s.stops->largest_name, "coach-2: stop, right");
  EXPECT_EQ((std::array{s.stops->first_time, s.stops->largest_force, s.stops->largest_time}),
            (std::array{0.25, 8e3, 0.5}));
  EXPECT_EQ(numbers(s.wheel_extremes.largest_Q), (std::array{1e5, 0.1, 0.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.smallest_Q), (std::array{2e4, 0.2, 1.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.derailment), (std::array{0.8, 0.3, 2.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.unloading), (std::array{0.6, 0.4, 3.0}));
}

TEST_F(ResultFile, RejectsTheExtremeOfAWheelThatTheRunDoesNotHave) {
  RunSummary summary = complete_summary();
  summary.wheel_extremes.largest_Q = {1e5, 0.1, static_cast<int>(header_.static_wheel_load.size())};
  {
    ResultWriter out(file_, header_);
    out.finish(summary);
  }
  EXPECT_THROW(static_cast<void>(read_results(file_)), InputError);
}

TEST_F(ResultFile, HasNoEnergyWhereNoneWasAccountedFor) {
  { ResultWriter(file_, header_, 7).finish({}); }
  EXPECT_FALSE(read_results(file_).summary.contact_energy.has_value());
  EXPECT_FALSE(read_results(file_).summary.stops.has_value());
}

TEST_F(ResultFile, ARunWithoutNodesOrRecordsIsReadable) {
  const ResultHeader header = made_up_header(false);
  ResultWriter(file_, header, 200).finish({});
  const RunResults read = read_results(file_);
  EXPECT_TRUE(read.steps.empty());
  EXPECT_TRUE(read.header.node_names.empty());
  EXPECT_EQ(read.header.body_names, header.body_names);
  EXPECT_FALSE(ResultWriter::read_checkpoint(file_).has_value());
}

TEST_F(ResultFile, IsIncompleteUntilItIsFinished) {
  {
    ResultWriter out(file_, header_, 10);
    for (long i = 0; i < 25; ++i) out.append(made_up_record(i, header_));
    const RunResults during = read_results(file_);
    EXPECT_EQ(during.steps.size(), 20U) << "up to the last flush";
    EXPECT_FALSE(during.summary.complete);
  }  // as where an exception ends the run
  const RunResults after = read_results(file_);
  EXPECT_EQ(after.steps.size(), 25U);
  EXPECT_FALSE(after.summary.complete);
  EXPECT_FALSE(after.summary.message.empty());
  expect_made_up_records(after, header_);
}

TEST_F(ResultFile, ResumesFromTheNewestWholeCheckpoint) {
  {
    ResultWriter out(file_, header_, 10);
    for (long i = 0; i < 95; ++i) {
      out.append(made_up_record(i, header_));
      if (i == 30 || i == 61) out.checkpoint(made_up_state(i), i);
    }
  }
  const std::optional<Checkpoint> last = ResultWriter::read_checkpoint(file_);
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->step, 61);
  EXPECT_EQ(last->records, 62U);
  EXPECT_EQ(last->state, made_up_state(61));
  {
    ResultWriter out = ResultWriter::resume(file_, *last, 10);
    EXPECT_EQ(read_results(file_).steps.size(), 62U);
    out.append(made_up_record(62, header_));
    out.checkpoint(made_up_state(62), 62);
    for (long i = 63; i < 80; ++i) out.append(made_up_record(i, header_));
    out.finish(complete_summary());
  }
  const RunResults read = read_results(file_);
  EXPECT_TRUE(read.summary.complete);
  ASSERT_EQ(read.steps.size(), 80U);
  expect_made_up_records(read, header_);
  EXPECT_EQ(ResultWriter::read_checkpoint(file_)->step, 62);
}

TEST_F(ResultFile, ADamagedCheckpointGivesTheOneBefore) {
  {
    ResultWriter out(file_, header_, 10);
    out.append(made_up_record(0, header_));
    out.checkpoint(made_up_state(1111), 1111);
    out.append(made_up_record(1, header_));
    out.checkpoint(made_up_state(2222), 2222);
    out.finish({});
  }
  ASSERT_EQ(ResultWriter::read_checkpoint(file_)->step, 2222);
  std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const double inside = made_up_state(2222)[4000];  // the second slot alone holds this number
  const std::size_t at = bytes.find(std::string_view(reinterpret_cast<const char*>(&inside), sizeof inside));
  ASSERT_NE(at, std::string::npos);
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(bytes[at] ^ 1));
  stream.close();
  const std::optional<Checkpoint> left = ResultWriter::read_checkpoint(file_);
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(left->step, 1111);
  EXPECT_EQ(left->records, 1U);
}

TEST_F(ResultFile, ACutOrForeignFileIsAnInputError) {
  {
    ResultWriter out(file_, header_, 10);
    for (long i = 0; i < 500; ++i) out.append(made_up_record(i, header_));
    out.finish({});
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file_);
  for (std::uintmax_t length = bytes - 1; length > 9973; length -= 9973) {
    std::filesystem::resize_file(file_, length);
    EXPECT_THROW(static_cast<void>(read_results(file_)), InputError) << length << " of " << bytes;
    EXPECT_THROW(static_cast<void>(ResultWriter::resume(file_, {})), InputError) << length;
  }
  ArrayFileWriter other(file_, "railtab-geometry-table", 1);
  other.close();
  EXPECT_THROW(static_cast<void>(read_results(file_)), InputError);
  std::filesystem::remove(file_);
  EXPECT_THROW(static_cast<void>(read_results(file_)), InputError);
}

/// Number of kills; more for a longer search: RAILTAB_KILLS=1000.
int kills() {
  const char* text = std::getenv("RAILTAB_KILLS");
  return text == nullptr ? 25 : std::atoi(text);
}

class KilledRun : public ResultFile {
 protected:
  static constexpr long checkpoint_every = 37;

  /// Runs without end in a child process, from the last checkpoint where there is one, and reports each flushed number
  /// of records through the pipe.
  [[noreturn]] void run_for_ever(int pipe) const {
    const std::optional<Checkpoint> from =
        std::filesystem::exists(file_) ? ResultWriter::read_checkpoint(file_) : std::nullopt;
    ResultWriter out = from ? ResultWriter::resume(file_, *from, 5) : ResultWriter(file_, header_, 5);
    for (long i = from ? static_cast<long>(from->records) : 0;; ++i) {
      out.append(made_up_record(i, header_));
      if ((i + 1) % checkpoint_every == 0) out.checkpoint(made_up_state(i), i);
      const long flushed = (i + 1) % checkpoint_every == 0 ? i + 1 : 0;
      if (flushed > 0 && ::write(pipe, &flushed, sizeof flushed) != sizeof flushed) ::_exit(1);
    }
  }

  /// Kills such a child after `microseconds` of its first report; returns the last number of records it reported.
  long kill_after(long microseconds) const {
    int ends[2];
    if (::pipe(ends) != 0) return -1;
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        run_for_ever(ends[1]);
      } catch (const std::exception& error) {
        std::fprintf(stderr, "child: %s\n", error.what());
        ::_exit(1);
      }
    }
    ::close(ends[1]);
    long last = 0, flushed = 0;
    bool alive = ::read(ends[0], &last, sizeof last) == sizeof last;
    EXPECT_TRUE(alive) << "the child did not write";
    std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    while (::read(ends[0], &flushed, sizeof flushed) == sizeof flushed) last = flushed;
    ::close(ends[0]);
    return last;
  }
};

TEST_F(KilledRun, LeavesEveryFlushedRecordAndCanBeResumed) {
  std::mt19937 random(20240131);
  std::uniform_int_distribution<long> pause(0, 30000);
  for (int n = 0; n < kills(); ++n) {
    if (n % 5 == 0) std::filesystem::remove(file_);  // else the next child resumes what the last one left
    const long reported = kill_after(pause(random));
    const RunResults left = read_results(file_);
    EXPECT_FALSE(left.summary.complete);
    EXPECT_GE(static_cast<long>(left.steps.size()), reported) << "kill " << n;
    expect_made_up_records(left, header_);
    const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(file_);
    ASSERT_TRUE(from.has_value()) << "kill " << n;
    EXPECT_GE(from->step + 1, reported);
    EXPECT_EQ(static_cast<long>(from->records), from->step + 1);
    EXPECT_EQ(from->state, made_up_state(from->step));
    if (HasFailure()) FAIL() << "at kill " << n;
  }
  const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(file_);
  const long end = static_cast<long>(from->records) + 100;
  ResultWriter out = ResultWriter::resume(file_, *from);
  for (long i = static_cast<long>(from->records); i < end; ++i) out.append(made_up_record(i, header_));
  out.finish(complete_summary());
  const RunResults whole = read_results(file_);
  EXPECT_TRUE(whole.summary.complete);
  EXPECT_EQ(static_cast<long>(whole.steps.size()), end);
  expect_made_up_records(whole, header_);
}

TEST_F(KilledRun, ACutFileOfAKilledRunIsNeverReadAsZeros) {
  kill_after(20000);
  const std::size_t records = read_results(file_).steps.size();
  int rejected = 0;
  for (std::uintmax_t length = std::filesystem::file_size(file_); length > 4999; length -= 4999) {
    std::filesystem::resize_file(file_, length);
    try {
      const RunResults read = read_results(file_);
      EXPECT_EQ(read.steps.size(), records);
      expect_made_up_records(read, header_);
    } catch (const InputError&) {
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 5);
}

TEST_F(KilledRun, ASecondWriterIsRejected) {
  ResultWriter out(file_, header_, 1);
  out.append(made_up_record(0, header_));
  EXPECT_THROW(ResultWriter(file_, header_), InputError);
  EXPECT_THROW(static_cast<void>(ResultWriter::resume(file_, {})), InputError);
}

}  // namespace
}  // namespace railtab
