#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_shard_file.hpp"
#include "railtab/tablegen/creep_table_of.hpp"

namespace railtab {

namespace {

using Files = std::vector<std::filesystem::path>;

std::vector<CreepShard> read_shards(const Files& files) {
  std::vector<CreepShard> found;
  for (const std::filesystem::path& file : files) {
    found.push_back(read_creep_shard(file, creep_shard_filetype));
    if (!found.back().header.job.shard) throw input_error(file.string(), "shard 0", "one of the shards of a table");
    require_same_job(found.back().header, file, found.front().header, "in " + files.front().string(), false);
  }
  return found;
}

/// For each shard of the table, its place in the list. @throws InputError where one is missing or there twice
std::vector<std::size_t> places(const std::vector<CreepShard>& found, const Files& files) {
  const int count = found.front().header.job.shard->count;
  std::vector<std::size_t> place(static_cast<std::size_t>(count), files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::size_t& own = place[static_cast<std::size_t>(found[i].header.job.shard->index - 1)];
    if (own != files.size()) {
      throw input_error(files[i].string(), fmt::format("shard {}/{}", found[i].header.job.shard->index, count),
                        fmt::format("one that is not in {} already", files[own].string()));
    }
    own = i;
  }
  std::string missing;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == files.size()) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", i + 1);
  }
  if (!missing.empty()) {
    throw input_error("shards of the table", fmt::format("none with number {}", missing),
                      fmt::format("all from 1 to {}", count));
  }
  return place;
}

/// Puts the cases of one shard where they stand in the table.
void put(const CreepShard& shard, const std::filesystem::path& file, std::span<const CreepLine> own,
         std::vector<SolvedCreepCase>& solved) {
  std::size_t expected = 0;
  for (const CreepLine& line : own) expected += line.count;
  if (shard.solved.size() != expected) {
    throw input_error(file.string(), fmt::format("{} cases", shard.solved.size()), fmt::format("{}", expected));
  }
  auto from = shard.solved.begin();
  for (const CreepLine& line : own) {
    const auto end = from + static_cast<std::ptrdiff_t>(line.count);
    std::copy(from, end, solved.begin() + static_cast<std::ptrdiff_t>(line.first));
    from = end;
  }
}

}  // namespace

CreepTableData merge_creep_shards(const Files& files) {
  if (files.empty()) throw input_error("shards of the table", "none", "all of them");
  const std::vector<CreepShard> found = read_shards(files);
  const std::vector<std::size_t> place = places(found, files);
  const CreepShardHeader& first = found.front().header;
  CreepJob job = first.job;
  const std::vector<CreepCase> cases = creep_cases(job.layout);
  const std::vector<CreepLine> lines = creep_lines(cases);
  require_same_job(first, files.front(), creep_shard_header(job, cases, lines, first.program_version),
                   "this program makes it", false);
  std::vector<SolvedCreepCase> solved(cases.size());
  const int count = job.shard->count;
  for (int i = 1; i <= count; ++i) {
    const std::size_t at = place[static_cast<std::size_t>(i - 1)];
    put(found[at], files[at], shard_lines(lines, i, count), solved);
  }
  job.shard.reset();
  return creep_table_of(job, solved);
}

}  // namespace railtab
