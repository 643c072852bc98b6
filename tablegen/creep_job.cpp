#include "railtab/tablegen/creep_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_shard_file.hpp"
#include "railtab/tablegen/creep_table_of.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kFlushEvery = std::chrono::milliseconds(100);

CreepSweepOptions sweep_options(const CreepJob& job) {
  return {job.layout.poisson, job.layout.elements, job.tolerance};
}

/// The file of the interrupted job, cut back to whole lines, or a new one. @param done number of whole lines in it
ArrayFileWriter open_partial(const std::filesystem::path& partial, const CreepShardHeader& header,
                             std::span<const CreepLine> own, std::size_t& done, std::vector<SolvedCreepCase>& solved) {
  done = 0;
  if (!std::filesystem::exists(partial)) return create_creep_partial(partial, header);
  CreepShard found = read_creep_shard(partial, creep_partial_filetype);
  require_same_job(found.header, partial, header,
                   "requested now; delete the file to begin again, or choose another output", true);
  std::size_t rows = 0;
  while (done < own.size() && rows + own[done].count <= found.solved.size()) rows += own[done++].count;
  auto out = ArrayFileWriter::reopen(partial, creep_partial_filetype, creep_shard_format_version);
  out.truncate(rows);
  found.solved.resize(rows);
  solved = std::move(found.solved);
  return out;
}

}  // namespace

void CreepJob::validate() const {
  layout.validate();
  sweep_options(*this).validate();
  if (shard && !shard->valid()) {
    throw input_error("shard", fmt::format("{}/{}", shard->index, shard->count), "I/N with 1 <= I <= N <= 100000");
  }
}

CreepJobOutcome run_creep_job(const CreepJob& job, const std::filesystem::path& file, const TableProvenance& provenance,
                              const Progress& progress) {
  job.validate();
  const std::vector<CreepCase> cases = creep_cases(job.layout);
  const std::vector<CreepLine> lines = creep_lines(cases);
  const std::vector<CreepLine> own = job.shard ? shard_lines(lines, job.shard->index, job.shard->count) : lines;
  const CreepShardHeader header = creep_shard_header(job, cases, own, provenance.program_version);

  std::filesystem::path partial = file;
  partial += ".partial";
  std::vector<SolvedCreepCase> solved;
  std::size_t done = 0;
  ArrayFileWriter out = open_partial(partial, header, own, done, solved);
  CreepJobOutcome outcome;
  outcome.cases = static_cast<std::size_t>(header.cases);
  outcome.resumed = solved.size();
  const Clock::time_point start = Clock::now();
  Clock::time_point flushed = start;
  sweep_creep(cases, std::span(own).subspan(done), sweep_options(job), [&](std::span<const SolvedCreepCase> line) {
    append(out, line);
    solved.insert(solved.end(), line.begin(), line.end());
    const Clock::time_point now = Clock::now();
    if (now - flushed > kFlushEvery) {
      out.flush();
      flushed = now;
    }
    if (progress) {
      // of what this run has to do, so that the time left is right after a resume
      progress(static_cast<double>(solved.size() - outcome.resumed) /
               static_cast<double>(outcome.cases - outcome.resumed));
    }
  });
  out.close();
  outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  for (const SolvedCreepCase& c : solved) {
    outcome.worst_residual = std::max(outcome.worst_residual, c.residual);
    outcome.safe_method += c.safe_method ? 1 : 0;
  }
  if (job.shard) {
    write_creep_shard(file, header, solved);
  } else {
    CreepTableData table = creep_table_of(job, solved);
    table.provenance = provenance;
    write_creep_table(file, table);
  }
  std::filesystem::remove(partial);
  return outcome;
}

}  // namespace railtab
