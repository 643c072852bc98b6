#include <fmt/format.h>

#include <filesystem>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

using Files = std::vector<std::filesystem::path>;

/// The file type that all shards have. @throws InputError
std::string shard_type(const Files& shards) {
  std::string type;
  for (const std::filesystem::path& shard : shards) {
    const std::string found = array_file_type(shard);
    if (found == creep_partial_filetype) {
      throw input_error(shard.string(), "an unfinished shard", "a finished one; run its tablegen command again");
    }
    if (found != creep_shard_filetype && found != geometry_table_filetype) {
      throw input_error(shard.string(), found, "a shard of a table");
    }
    if (type.empty()) type = found;
    if (type != found) throw input_error(shard.string(), found, type + ", as " + shards.front().string());
  }
  return type;
}

/// "a.h5, b.h5", in the order of the command line.
std::string names_of(const Files& files) {
  std::string names;
  for (const std::filesystem::path& file : files) names += (names.empty() ? "" : ", ") + file.string();
  return names;
}

void merge_creep(const Files& shards, const std::string& file, const TableProvenance& provenance) {
  CreepTableData table = merge_creep_shards(shards);
  table.provenance = provenance;
  write_creep_table(file, table);
}

void merge_geometry(const Files& shards, const std::string& file, const TableProvenance& provenance) {
  std::vector<GeometryTableData> parts;
  for (const std::filesystem::path& shard : shards) {
    parts.push_back(read_geometry_table(shard));
    if (parts.back().shard.whole()) throw input_error(shard.string(), "a whole table", "shards; it needs no merge");
  }
  GeometryTableData table = in_file(names_of(shards), [&] {
    GeometryTableData whole = merge_geometry_tables(std::move(parts));
    try {
      certify_merged_geometry_table(whole);
    } catch (const ComputationError& e) {
      throw ComputationError(fmt::format("{}: not written: {}", file, e.what()));
    }
    return whole;
  });
  table.provenance = provenance;
  write_geometry_table(file, table);
}

}  // namespace

void merge_command(const std::vector<std::string>& arguments) {
  namespace po = boost::program_options;
  po::options_description own("Arguments");
  own.add_options()("shard", po::value<std::vector<std::string>>()->value_name("SHARD.h5"), "all shards of a table")  //
      ("output,o", po::value<std::string>()->value_name("FILE.h5"), "the table");
  const TableCommandLine line("tablegen merge SHARD.h5... -o FILE.h5", own, {"shard..."}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("output");
  const std::vector<std::string> names = line.required_many("shard");
  const Files shards(names.begin(), names.end());
  for (const std::filesystem::path& shard : shards) require_no_input(file, {shard});
  const bool geometry = shard_type(shards) == geometry_table_filetype;
  require_output(file, {geometry ? geometry_table_filetype : creep_table_filetype});
  (geometry ? merge_geometry : merge_creep)(shards, file, provenance("merge", arguments));
  if (line.json()) {
    const nlohmann::ordered_json j{{"kind", geometry ? "geometry" : "creep"},
                                   {"file", file},
                                   {"shards", shards.size()},
                                   {"checksum", array_file_checksum(file)},
                                   {"file_bytes", std::filesystem::file_size(file)}};
    print_json(j);
  } else if (!line.quiet()) {
    print_formatted("{}: merged from {} shards\n", file, shards.size());
  }
}

}  // namespace railtab
