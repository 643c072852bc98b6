#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "batch_list.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "geometry_request.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

enum class State { waiting, done, made, failed };

struct Job {
  BatchPair pair;
  State state = State::waiting;
  std::string message;
};

std::string_view state_name(State state) {
  switch (state) {
    case State::waiting:
      return "to do";
    case State::done:
      return "done before";
    case State::made:
      return "made";
    case State::failed:
      break;
  }
  return "failed";
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// The words of `text` that are not in `other`.
std::string words_beyond(const std::string& text, const std::string& other) {
  const std::vector<std::string> known = words(other);
  std::string beyond;
  for (const std::string& word : words(text)) {
    if (std::find(known.begin(), known.end(), word) == known.end()) beyond += (beyond.empty() ? "" : " ") + word;
  }
  return beyond.empty() ? text : beyond;
}

/// A name stays when the points behind it change: a file edited, another smoothing.
void require_profile(const BatchPair& pair, std::string_view kind, const ProfileKnots& of_table,
                     const ProfileKnots& wanted) {
  if (same_profile(of_table, wanted)) return;
  const bool renamed = of_table.name != wanted.name;
  throw input_error(pair.output.string(), fmt::format("a table made of the {} profile {}", kind, of_table.name),
                    fmt::format("{}{}; --overwrite makes it anew", wanted.name,
                                renamed ? "" : " with the points that it has now (file, smoothing, inclination)"));
}

/// The options that the table in a job's place was made with, where they are not what the job asks for; empty where
/// it is the job's own table. @throws InputError where the file is no geometry table of the job's profiles
std::string other_options(const BatchPair& pair, const GeometryRequest& request) {
  const GeometryTableData table = read_geometry_table(pair.output);
  require_profile(pair, "wheel", table.wheel, request.search.pair().wheel().knots());
  require_profile(pair, "rail", table.rail, request.search.pair().rail().knots());
  std::string found;
  try {
    found = geometry_options_text(words(table.provenance.command_line));
  } catch (const po::error&) {
    found = table.provenance.command_line;  // of a version with other options
  }
  if (found != geometry_options_text(pair.arguments)) return found;
  const bool same = difference_of_tables(geometry_heading(request.search, request.options), table).empty();
  return same ? "" : table.provenance.command_line;  // merged of shards, whose options it does not say
}

GeometryRequest request_of(const BatchPair& pair) {
  const TableCommandLine line("tablegen geometry", geometry_options(), {}, pair.arguments);
  require_options_of_profiles(line);
  return geometry_request(line);
}

/// Reads every pair before the first is made: what is wrong with the input is said at once.
std::vector<Job> read_jobs(const TableCommandLine& line) {
  std::vector<Job> jobs;
  for (BatchPair& pair : read_batch_list(line.required("list"))) {
    Job job{std::move(pair), State::waiting, ""};
    try {
      const GeometryRequest request = request_of(job.pair);
      if (!line.given("overwrite") && is_file(job.pair.output)) {
        const std::string found = other_options(job.pair, request);
        if (!found.empty()) {
          const std::string wanted = geometry_options_text(job.pair.arguments);
          throw input_error(job.pair.output.string(), "a table made with " + words_beyond(found, wanted),
                            words_beyond(wanted, found) + "; --overwrite makes it anew");
        }
        job.state = State::done;
      }
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: {}", job.pair.place, e.what()));
    }
    jobs.push_back(std::move(job));
  }
  if (!line.given("only")) return jobs;
  const TableShard part = line.shard("only");
  std::vector<Job> own;
  for (std::size_t i = static_cast<std::size_t>(part.index - 1); i < jobs.size();
       i += static_cast<std::size_t>(part.count)) {
    own.push_back(jobs[i]);
  }
  return own;
}

void make(Job& job, const std::string& title, const TableCommandLine& line) {
  try {
    const GeometryRequest request = request_of(job.pair);
    if (!line.quiet()) print_notes("geometry", request.search.pair());
    ProgressBar bar(title, !line.quiet());
    generate_geometry_table_file(request.search, request.options, provenance("geometry", job.pair.arguments),
                                 request.file, [&](double share) { bar.show(share); });
    job.state = State::made;
  } catch (const std::exception& e) {
    // the other tables do not need this one
    job.state = State::failed;
    job.message = e.what();
  }
}

void print_jobs(const std::vector<Job>& jobs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Job& job : jobs) {
    nlohmann::ordered_json j{
        {"place", job.pair.place}, {"file", job.pair.output.string()}, {"state", state_name(job.state)}};
    if (job.state == State::done || job.state == State::made) j["checksum"] = array_file_checksum(job.pair.output);
    if (!job.message.empty()) j["message"] = job.message;
    list.push_back(std::move(j));
  }
  print_json(nlohmann::ordered_json{{"kind", "batch"}, {"pairs", std::move(list)}});
}

po::options_description batch_options() {
  po::options_description own("Arguments");
  own.add_options()("list", po::value<std::string>()->value_name("LIST.toml"), "one [[pair]] per table, [defaults]")  //
      ("only", po::value<std::string>()->value_name("I/N"), "every N-th pair only, from the I-th on (job arrays)")    //
      ("overwrite", "make every table anew, also where one stands")                                                   //
      ("plan", "print what would be generated; generate nothing");
  return own;
}

}  // namespace

void batch_command(const std::vector<std::string>& arguments) {
  const TableCommandLine line("tablegen batch LIST.toml [--only I/N] [--overwrite] [--plan]", batch_options(), {"list"},
                              arguments);
  if (line.help_printed()) return;
  std::vector<Job> jobs = read_jobs(line);
  const bool text = !line.json() && !line.quiet();
  std::size_t failed = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    Job& job = jobs[i];
    if (job.state == State::waiting && !line.given("plan")) {
      make(job, fmt::format("table {} of {}", i + 1, jobs.size()), line);
    }
    if (text && job.state != State::failed)
      print_formatted("{}: {}\n", job.pair.output.string(), state_name(job.state));
    if (job.state != State::failed) continue;
    print_message(fmt::format("{}: {}: failed: {}\n", job.pair.place, job.pair.output.string(), job.message));
    ++failed;
  }
  if (line.json()) print_jobs(jobs);
  if (failed > 0) throw ComputationError(fmt::format("{} of {} tables failed", failed, jobs.size()));
}

}  // namespace railtab
