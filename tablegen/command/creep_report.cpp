#include "creep_report.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab {

namespace {

nlohmann::ordered_json numbers(const ErrorStatistics& errors) {
  nlohmann::ordered_json j;
  for (const auto& [name, value] : errors.named()) j[std::string(name)] = value;
  return j;
}

std::string line(std::string_view name, std::string_view quantity, const ErrorStatistics& errors) {
  std::string out = fmt::format("{:18}{:8}", name, quantity);
  for (const auto& [statistic, value] : errors.named()) out += fmt::format("{:10.5f}", value);
  return out + '\n';
}

std::array<std::string_view, 4> axis_names(CreepTableLayout layout) {
  if (layout == CreepTableLayout::smooth) return {"ratio", "t", "alpha", "beta"};
  return {"ratio", "x", "y", "spin"};
}

}  // namespace

bool is_creep_table(const std::string& file) {
  const std::string type = array_file_type(file);
  if (type == creep_shard_filetype || type == creep_partial_filetype) {
    throw input_error(file, type == creep_shard_filetype ? "a shard of a creep table" : "an unfinished creep table",
                      "a whole table: merge all its shards, or end the command that makes it");
  }
  return type == creep_table_filetype;
}

nlohmann::ordered_json verification_description(const CreepVerification& v) {
  nlohmann::ordered_json j;
  j["kind"] = "creep";
  j["samples"] = v.samples;
  j["outside"] = v.outside;
  j["exact"] = {
      {"worst_residual", v.worst_residual}, {"safe_method", v.safe_method}, {"extrapolated_p99", v.extrapolated_p99}};
  j["error"] = {{"force", numbers(v.table.force)}, {"moment", numbers(v.table.moment)}};
  j["time_ns"] = {{"table", v.table.time_ns}, {"table_trajectory", v.time_trajectory_ns}, {"exact", v.time_exact_ns}};
  for (const CreepLawErrors& law : v.laws) {
    j["law"][std::string(law.name)] = {{"force", numbers(law.force)}, {"moment", numbers(law.moment)}};
    j["time_ns"][std::string(law.name)] = law.time_ns;
  }
  j["bytes"] = v.bytes;
  return j;
}

std::string verification_text(const CreepVerification& v) {
  std::string out = fmt::format(
      "{} random cases against exact rolling contact (largest residual {:.1e}, {} by the safe method); {} outside the "
      "table or at its border\nerrors in units of mu F_n and mu F_n "
      "sqrt(ab)\n\n{:26}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
      v.samples, v.worst_residual, v.safe_method, v.outside, "", "mean", "p50", "p95", "p99", "p99.9", "max");
  out += line("table", "force", v.table.force) + line("", "moment", v.table.moment);
  for (const CreepLawErrors& law : v.laws) out += line(law.name, "force", law.force) + line("", "moment", law.moment);
  out += fmt::format("\ntime per case [ns]: table with derivatives {:.0f} (along a trajectory {:.0f})", v.table.time_ns,
                     v.time_trajectory_ns);
  for (const CreepLawErrors& law : v.laws) out += fmt::format(", {} {:.0f}", law.name, law.time_ns);
  return out + fmt::format(", exact {:.0f}\n", v.time_exact_ns);
}

nlohmann::ordered_json table_description(const CreepTableData& table, const std::string& file) {
  nlohmann::ordered_json j;
  j["kind"] = "creep";
  j["file"] = file;
  j["layout"] = creep_table_layout_name(table.layout);
  j["poisson"] = table.poisson;
  j["elements"] = table.elements;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double>& nodes = table.nodes[i];
    j["axes"][std::string(axis_names(table.layout)[i])] = {
        {"low", nodes.front()}, {"high", nodes.back()}, {"nodes", nodes.size()}};
  }
  j["bytes"] = in_file(file, [&table] { return CreepTable(table).bytes(); });
  j["file_bytes"] = std::filesystem::file_size(file);
  for (const auto& [name, value] : table.statistics) j["statistics"][name] = value;
  j["provenance"] = {{"program_version", table.provenance.program_version},
                     {"command_line", table.provenance.command_line},
                     {"created", table.provenance.created}};
  return j;
}

std::string table_text(const CreepTableData& table, const std::string& file) {
  std::string text = fmt::format("{}: creep forces of exact rolling contact, layout {}\n", file,
                                 creep_table_layout_name(table.layout));
  text += fmt::format("  solution     Poisson's ratio {}, {} x {} elements\n", table.poisson, table.elements,
                      table.elements);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double>& nodes = table.nodes[i];
    text += fmt::format("  {:12} {:.4g} .. {:.4g}, {} nodes\n", axis_names(table.layout)[i], nodes.front(),
                        nodes.back(), nodes.size());
  }
  text += fmt::format("  size         {:.2f} MiB on disk, {:.2f} MiB in memory\n",
                      static_cast<double>(std::filesystem::file_size(file)) / 1048576.0,
                      in_file(file, [&table] { return static_cast<double>(CreepTable(table).bytes()); }) / 1048576.0);
  for (const auto& [name, value] : table.statistics) text += fmt::format("  {:36} {:.4g}\n", name, value);
  text += fmt::format("  generated    {} by version {}: {}\n", table.provenance.created,
                      table.provenance.program_version, table.provenance.command_line);
  return text;
}

}  // namespace railtab
