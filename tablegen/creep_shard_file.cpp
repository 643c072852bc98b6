#include "railtab/tablegen/creep_shard_file.hpp"

#include <fmt/format.h>

#include <functional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/file_fields.hpp"

namespace railtab {

namespace {

/// One number of a solved case, and the dataset that holds it.
struct ShardColumn {
  std::string_view path, description;
  std::function<double(const SolvedCreepCase&)> get;
  std::function<void(SolvedCreepCase&, double)> set;
};

ShardColumn member(std::string_view path, std::string_view description, double SolvedCreepCase::*m) {
  return {path, description, [m](const SolvedCreepCase& c) { return c.*m; },
          [m](SolvedCreepCase& c, double value) { c.*m = value; }};
}
ShardColumn member(std::string_view path, std::string_view description, double CreepForce::*m) {
  return {path, description, [m](const SolvedCreepCase& c) { return c.force.*m; },
          [m](SolvedCreepCase& c, double value) { c.force.*m = value; }};
}

const std::vector<ShardColumn>& columns() {
  static const std::vector<ShardColumn> all{
      member("force_x", "F_x/(mu F_n) on the wheel", &CreepForce::x),
      member("force_y", "F_y/(mu F_n) on the wheel", &CreepForce::y),
      member("moment", "M_z/(mu F_n sqrt(ab)) on the wheel", &CreepForce::moment),
      member("residual", "of the friction law, relative to zero traction", &SolvedCreepCase::residual),
      member("bound_excess", "largest |p|/(mu p_n) - 1", &SolvedCreepCase::bound_excess),
      member("slip_deviation", "sum(|p||s| + p.s)/sum|p||s| of slipping elements", &SolvedCreepCase::slip_deviation),
      member("grid_difference", "|force on the fine grid - on the coarse one|/(mu F_n)",
             &SolvedCreepCase::grid_difference),
      {"safe_method", "1 where Newton's method failed and the slow one was used",
       [](const SolvedCreepCase& c) { return c.safe_method ? 1.0 : 0.0; },
       [](SolvedCreepCase& c, double value) { c.safe_method = value != 0.0; }}};
  return all;
}

Field field_of(const ShardColumn& column, const char* dimension) {
  return {std::string(column.path), {dimension}, "1", std::string(column.description)};
}

std::vector<double> column_of(const ShardColumn& column, std::span<const SolvedCreepCase> solved) {
  std::vector<double> values;
  values.reserve(solved.size());
  for (const SolvedCreepCase& c : solved) values.push_back(column.get(c));
  return values;
}

void write_header(ArrayFileWriter& file, const CreepShardHeader& header, std::string_view description) {
  const CreepJob& job = header.job;
  file.attribute("", "description", description);
  file.attribute("options", "layout", creep_table_layout_name(job.layout.layout));
  for (std::size_t i = 0; i < job.layout.nodes.size(); ++i) {
    file.attribute("options", fmt::format("nodes_{}", i + 1), std::int64_t{job.layout.nodes[i]});
  }
  file.attribute("options", "poisson", job.layout.poisson);
  file.attribute("options", "elements", std::int64_t{job.layout.elements});
  file.attribute("options", "tolerance", job.tolerance);
  file.attribute("options", "shard", std::int64_t{job.shard ? job.shard->index : 0});
  file.attribute("options", "shards", std::int64_t{job.shard ? job.shard->count : 0});
  file.attribute("options", "cases", header.cases);
  file.attribute("options", "case_list", header.case_list);
  file.attribute("provenance", "program_version", header.program_version);
}

CreepShardHeader read_header(const ArrayFileReader& file, const std::filesystem::path& name) {
  CreepShardHeader header;
  CreepJob& job = header.job;
  constexpr int most = 1'000'000;
  const auto whole = [&](const std::string& key) {
    return static_cast<int>(file.whole_number("options", key, 0, most));
  };
  job.layout.layout = creep_table_layout(file.text("options", "layout"));
  for (std::size_t i = 0; i < job.layout.nodes.size(); ++i) job.layout.nodes[i] = whole(fmt::format("nodes_{}", i + 1));
  const FieldReader options(file);
  job.layout.poisson = options.number("options", "poisson");
  job.layout.elements = whole("elements");
  job.tolerance = options.number("options", "tolerance");
  if (whole("shards") > 0) job.shard = TableShard{whole("shard"), whole("shards")};
  if (job.shard && !job.shard->valid()) {
    throw input_error(name.string() + ": options", fmt::format("shard {}/{}", job.shard->index, job.shard->count),
                      "shard I/N with 1 <= I <= N <= 100000");
  }
  constexpr std::int64_t most_cases = 1'000'000'000'000;
  header.cases = file.whole_number("options", "cases", 0, most_cases);
  header.case_list = file.text("options", "case_list");
  header.program_version = file.text("provenance", "program_version");
  return header;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> CreepShardHeader::named() const {
  const CreepLayoutOptions& layout = job.layout;
  return {{"layout", std::string(creep_table_layout_name(layout.layout))},
          {"nodes", fmt::format("{},{},{},{}", layout.nodes[0], layout.nodes[1], layout.nodes[2], layout.nodes[3])},
          {"poisson", fmt::format("{}", layout.poisson)},
          {"elements", fmt::format("{}", layout.elements)},
          {"tolerance", fmt::format("{}", job.tolerance)},
          {"number of shards", job.shard ? fmt::format("{}", job.shard->count) : "none"},
          {"program version", program_version},
          {"list of cases", case_list}};
}

CreepShardHeader creep_shard_header(const CreepJob& job, std::span<const CreepCase> cases,
                                    std::span<const CreepLine> own, std::string program_version) {
  CreepShardHeader header{job, std::move(program_version), "", 0};
  std::uint64_t sum = checksum({});
  for (const CreepCase& c : cases) {
    const double numbers[]{c.ratio, c.creepage.x, c.creepage.y, c.creepage.spin};
    sum = checksum(numbers, sum);
  }
  header.case_list = fmt::format("{:016x}", sum);
  for (const CreepLine& line : own) header.cases += static_cast<std::int64_t>(line.count);
  return header;
}

void require_same_job(const CreepShardHeader& found, const std::filesystem::path& file,
                      const CreepShardHeader& expected, std::string_view other, bool shard) {
  auto mine = found.named(), theirs = expected.named();
  if (shard) {
    const auto number = [](const CreepJob& job) { return job.shard ? fmt::format("{}", job.shard->index) : "none"; };
    mine.emplace_back("shard", number(found.job));
    theirs.emplace_back("shard", number(expected.job));
  }
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].second == theirs[i].second) continue;
    throw input_error(fmt::format("{}: {}", file.string(), mine[i].first), mine[i].second,
                      fmt::format("{} as {}", theirs[i].second, other));
  }
}

ArrayFileWriter create_creep_partial(const std::filesystem::path& file, const CreepShardHeader& header) {
  ArrayFileWriter out(file, creep_partial_filetype, creep_shard_format_version, ArrayFileWriter::Mode::growing);
  write_header(
      out, header,
      "An unfinished creep table: the cases solved so far. The same tablegen creep command goes on from here.");
  FieldWriter histories(out);
  for (const ShardColumn& column : columns()) histories.create_growing(field_of(column, "records"));
  out.flush();
  return out;
}

void append(ArrayFileWriter& partial, std::span<const SolvedCreepCase> solved) {
  for (const ShardColumn& column : columns()) partial.append(column.path, column_of(column, solved));
}

void write_creep_shard(const std::filesystem::path& file, const CreepShardHeader& header,
                       std::span<const SolvedCreepCase> solved) {
  ArrayFileWriter out(file, creep_shard_filetype, creep_shard_format_version);
  write_header(out, header, "One shard of a creep table, for tablegen merge.");
  FieldWriter arrays(out);
  for (const ShardColumn& column : columns()) arrays.write(field_of(column, "cases"), column_of(column, solved));
  out.close();
}

CreepShard read_creep_shard(const std::filesystem::path& file, std::string_view filetype) {
  const ArrayFileReader in(file, filetype, creep_shard_format_version);
  CreepShard shard{read_header(in, file), {}};
  const bool partial = filetype == creep_partial_filetype;
  const std::size_t rows = partial ? in.records() : static_cast<std::size_t>(shard.header.cases);
  if (rows > static_cast<std::size_t>(shard.header.cases)) {
    throw input_error(file.string(), fmt::format("{} cases", rows), fmt::format("at most {}", shard.header.cases));
  }
  const char* const dimension = partial ? "records" : "cases";
  FieldReader arrays(in);
  arrays.set(dimension, rows, partial ? "" : "options");
  for (const ShardColumn& column : columns()) {
    const std::vector<double> values = arrays.numbers(field_of(column, dimension));
    shard.solved.resize(values.size());  // only now is it sure that the file has so many
    for (std::size_t i = 0; i < values.size(); ++i) column.set(shard.solved[i], values[i]);
  }
  return shard;
}

}  // namespace railtab
