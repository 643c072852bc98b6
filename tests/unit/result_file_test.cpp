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

namespace railtab {
namespace {

ResultHeader made_up_header(bool with_nodes = true) {
  ResultHeader header;
  header.scene_name = "made-up scene";
  header.scene_text = "[train]\nspeed = 55.5\n" + std::string(100000, '#');  // more than an HDF5 attribute holds
  header.program_version = "0.1.0";
  header.speed = 55.5;
  header.wheel_x = {0.0, 0.0, -2.5, -2.5};
  header.static_wheel_load = {5e4, 5.1e4, 5.2e4, 5.3e4};
  header.body_names = {"coach-1/car-body", "coach-1/bogie-1", "coach-1/wheelset-1"};
  if (with_nodes) {
    header.node_names = {"midspan", "quarter span"};
    header.node_x = {15.0, 7.5};
  }
  header.wheel_profile = "S1002";
  header.rail_profile = "60E1";
  header.wheel_y = {-0.03, 0.0, 0.03};
  header.wheel_z = {0.02, 0.0, -0.001};
  header.rail_y = {-0.03, 0.03};
  header.rail_z = {0.01, 0.012};
  return header;
}

/// A record whose every number is different, and a function of its index alone.
StepRecord made_up_record(long index, const ResultHeader& header) {
  StepRecord record;
  int k = 0;
  const auto next = [&] { return std::sin(static_cast<double>(++k)) + static_cast<double>(index); };
  record.time = next();
  record.position = next();
  for (std::size_t i = 0; i < header.wheel_x.size(); ++i) {
    WheelRecord w;
    w.patches = static_cast<int>((index + static_cast<long>(i)) % 3);
    for (double* value : {&w.Q, &w.Y, &w.X, &w.y_rail, &w.y_wheel, &w.angle, &w.rolling_radius, &w.normal_force,
                          &w.penetration, &w.second_y_rail, &w.second_normal_force}) {
      *value = next();
    }
    record.wheels.push_back(w);
  }
  const auto motion = [&] {
    MotionRecord m;
    for (auto* values : {&m.displacement, &m.velocity, &m.acceleration}) {
      for (double& value : *values) value = next();
    }
    return m;
  };
  for (std::size_t i = 0; i < header.body_names.size(); ++i) record.bodies.push_back(motion());
  for (std::size_t i = 0; i < header.node_names.size(); ++i) record.nodes.push_back(motion());
  record.newton_iterations = static_cast<int>(index % 7);
  return record;
}

/// All numbers of a record in one list.
std::vector<double> numbers_of(const StepRecord& r) {
  std::vector<double> n{r.time, r.position, static_cast<double>(r.newton_iterations)};
  for (const WheelRecord& w : r.wheels) {
    n.insert(n.end(), {w.Q, w.Y, w.X, static_cast<double>(w.patches), w.y_rail, w.y_wheel, w.angle, w.rolling_radius,
                       w.normal_force, w.penetration, w.second_y_rail, w.second_normal_force});
  }
  for (const auto* motions : {&r.bodies, &r.nodes}) {
    for (const MotionRecord& m : *motions) {
      n.insert(n.end(), m.displacement, m.displacement + 6);
      n.insert(n.end(), m.velocity, m.velocity + 6);
      n.insert(n.end(), m.acceleration, m.acceleration + 6);
    }
  }
  return n;
}

void expect_made_up_records(const RunResults& results, const ResultHeader& header) {
  for (std::size_t i = 0; i < results.steps.size(); ++i) {
    const std::vector<double> found = numbers_of(results.steps[i]);
    const std::vector<double> expected = numbers_of(made_up_record(static_cast<long>(i), header));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k], expected[k]) << "number " << k << " of record " << i << " of " << results.steps.size();
    }
  }
}

RunSummary complete_summary() {
  RunSummary summary;
  summary.complete = true;
  return summary;
}

std::vector<double> made_up_state(long step) {
  std::vector<double> state(5000);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = static_cast<double>(step) + 1e-3 * static_cast<double>(i);
  return state;
}

class ResultFile : public ::testing::Test {
 protected:
  ~ResultFile() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("railtab_results_" + std::to_string(::getpid()) + ".h5");
  ResultHeader header_ = made_up_header();
};

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
  for (double* value :
       {&summary.seconds_total, &summary.seconds_setup, &summary.seconds_lookup, &summary.seconds_contact,
        &summary.seconds_structure, &summary.seconds_vehicle, &summary.seconds_output}) {
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
  EXPECT_EQ((std::vector<double>{s.seconds_total, s.seconds_setup, s.seconds_lookup, s.seconds_contact,
                                 s.seconds_structure, s.seconds_vehicle, s.seconds_output}),
            (std::vector<double>{12 / 3.0, 13 / 3.0, 14 / 3.0, 15 / 3.0, 16 / 3.0, 17 / 3.0, 18 / 3.0}));
  ASSERT_TRUE(s.contact_energy.has_value());
  const ContactEnergy& e = *s.contact_energy;
  EXPECT_EQ(e.impacts, 5);
  EXPECT_EQ((std::vector<double>{e.gain, e.stiffness_work, e.largest_step, e.largest_step_time, e.largest_impact,
                                 e.largest_impact_time, e.largest_impact_stored}),
            (std::vector<double>{1.5, -2.5, 3.5, 4.5, -6.5, 7.5, 8.5}));
  const auto numbers = [](const WheelExtreme& x) { return std::array{x.value, x.time, double(x.wheel)}; };
  EXPECT_EQ(numbers(s.wheel_extremes.largest_Q), (std::array{1e5, 0.1, 0.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.smallest_Q), (std::array{2e4, 0.2, 1.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.derailment), (std::array{0.8, 0.3, 2.0}));
  EXPECT_EQ(numbers(s.wheel_extremes.unloading), (std::array{0.6, 0.4, 3.0}));
}

TEST_F(ResultFile, RefusesTheExtremeOfAWheelThatTheRunDoesNotHave) {
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

/// Everything that a reader returns, as bytes.
std::string all_read(const std::filesystem::path& file) {
  const RunResults r = read_results(file);
  std::string all = r.header.scene_text + r.header.scene_name + r.header.program_version + r.header.wheel_profile +
                    r.header.rail_profile + r.summary.message + r.summary.contact_mode;
  for (const auto* names :
       {&r.header.body_names, &r.header.node_names, &r.header.input_files, &r.header.input_checksums}) {
    for (const std::string& name : *names) all += name + '\n';
  }
  std::vector<double> numbers{r.header.speed, r.summary.complete ? 1.0 : 0.0, static_cast<double>(r.summary.steps),
                              r.summary.seconds_total};
  for (const auto* values : {&r.header.wheel_x, &r.header.static_wheel_load, &r.header.node_x, &r.header.wheel_y,
                             &r.header.wheel_z, &r.header.rail_y, &r.header.rail_z}) {
    numbers.insert(numbers.end(), values->begin(), values->end());
  }
  for (const StepRecord& step : r.steps) {
    const std::vector<double> more = numbers_of(step);
    numbers.insert(numbers.end(), more.begin(), more.end());
  }
  return all + std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

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
    long refused = 0, tried = 0;
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
        ++refused;
        EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
      }
      stream.open(file_, std::ios::binary | std::ios::in | std::ios::out);
      stream.seekp(static_cast<std::streamoff>(i)).put(was);
    }
    EXPECT_GT(refused, tried / 10) << "the others: room for rows that are not written";
    EXPECT_TRUE(all_read(file_) == whole);
  }
};

TEST_F(DamagedResults, OfAFinishedRunAreRefused) {
  {
    ResultWriter out(file_, header_, 3);
    for (long i = 0; i < 8; ++i) out.append(made_up_record(i, header_));
    out.finish(complete_summary());
  }
  expect_changes_found(97);
}

TEST_F(DamagedResults, OfAnEndedRunWithCheckpointsAreRefused) {
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
  int refused = 0;
  for (std::uintmax_t length = std::filesystem::file_size(file_); length > 4999; length -= 4999) {
    std::filesystem::resize_file(file_, length);
    try {
      const RunResults read = read_results(file_);
      EXPECT_EQ(read.steps.size(), records);
      expect_made_up_records(read, header_);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
}

TEST_F(KilledRun, ASecondWriterIsRefused) {
  ResultWriter out(file_, header_, 1);
  out.append(made_up_record(0, header_));
  EXPECT_THROW(ResultWriter(file_, header_), InputError);
  EXPECT_THROW(static_cast<void>(ResultWriter::resume(file_, {})), InputError);
}

}  // namespace
}  // namespace railtab
