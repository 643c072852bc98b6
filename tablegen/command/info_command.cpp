#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "creep_report.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"
#include "table_page.hpp"
#include "wheelset_functions.hpp"

namespace railtab {

namespace {

/// Leaves that send some queries to the online search by the height of the wheel alone.
long limited_leaves(const GeometryTableData& table) {
  const auto most = std::max_element(table.trusted_lowering.begin(), table.trusted_lowering.end());
  return std::count_if(table.trusted_lowering.begin(), table.trusted_lowering.end(),
                       [&](float height) { return height < *most; });
}

std::size_t branches_of(const GeometryTableData& table) {
  return std::accumulate(table.leaf_branch.begin(), table.leaf_branch.end(), std::size_t{0});
}

double statistic(const std::vector<std::pair<std::string, double>>& statistics, std::string_view name) {
  for (const auto& [key, value] : statistics) {
    if (key == name) return value;
  }
  return std::nan("");
}

nlohmann::ordered_json loaded_description(const LoadedTableData& loaded) {
  nlohmann::ordered_json j;
  j["lateral"] = {{"low", loaded.lateral.front()}, {"high", loaded.lateral.back()}, {"nodes", loaded.lateral.size()}};
  j["roll"] = {{"low", loaded.roll.front()}, {"high", loaded.roll.back()}, {"nodes", loaded.roll.size()}};
  j["climb"] = loaded.climb;
  j["yaw"] = {{"high", std::sqrt(loaded.yaw_squared.back())}, {"nodes", loaded.yaw_squared.size()}};
  j["levels"] = loaded.levels;
  j["largest_energy"] = std::pow(loaded.largest_level, 5);
  j["contact_modulus"] = loaded.contact_modulus;
  j["parts"] = loaded.parts();
  j["bytes"] = LoadedTable(loaded).bytes();
  for (const auto& [name, value] : loaded.statistics) j["statistics"][name] = value;
  return j;
}

std::string loaded_text(const LoadedTableData& loaded) {
  const auto percent = [&](const char* name) { return 100.0 * statistic(loaded.statistics, name); };
  std::string text = fmt::format(
      "  loaded part  {:.3f} .. {:.3f} mm in {} nodes, roll {:.2f} .. {:.2f} mrad{}, yaw up to {:.2f} mrad, {} levels "
      "up to {:.3g} J, {:.1f} MiB\n",
      1e3 * loaded.lateral.front(), 1e3 * loaded.lateral.back(), loaded.lateral.size(), 1e3 * loaded.roll.front(),
      1e3 * loaded.roll.back(), loaded.climb == 0.0 ? "" : fmt::format(" less {:.3g} rad/m of shift", loaded.climb),
      1e3 * std::sqrt(loaded.yaw_squared.back()), loaded.levels, std::pow(loaded.largest_level, 5),
      static_cast<double>(LoadedTable(loaded).bytes()) / 1048576.0);
  text += fmt::format(
      "               force above 5 kN off by {:.2f} % (99 %), {:.2f} % (largest); from 1 to 5 kN {:.2f} %, {:.2f} %\n",
      percent("certified.error.force.p99"), percent("certified.error.force.max"),
      percent("certified.error.light_force.p99"), percent("certified.error.light_force.max"));
  return text;
}

/// What was done to the points of both profile files.
std::vector<std::string> profile_notes(const GeometryTableData& table) {
  std::vector<std::string> notes = table.wheel.notes;
  notes.insert(notes.end(), table.rail.notes.begin(), table.rail.notes.end());
  return notes;
}

}  // namespace

nlohmann::ordered_json table_description(const GeometryTableData& table, const std::string& file) {
  const auto axis = [](const TableAxis& a) {
    return nlohmann::ordered_json{{"low", a.low}, {"high", a.high}, {"root_cells", a.cells}};
  };
  nlohmann::ordered_json j;
  j["kind"] = "geometry";
  j["file"] = file;
  j["wheel"] = table.wheel.name;
  j["rail"] = table.rail.name;
  if (!table.rail.inclination.empty()) j["rail_inclination"] = table.rail.inclination;
  j["track_gauge"] = table.track_gauge;
  j["gauge_height"] = table.gauge_height;
  j["flange_back"] = table.flange_back;
  j["nominal_radius"] = table.nominal_radius;
  j["axes"] = {{"lateral", axis(table.lateral)}, {"yaw_squared", axis(table.yaw_squared)}, {"roll", axis(table.roll)}};
  j["shard"] = {{"index", table.shard.index}, {"count", table.shard.count}};
  j["leaves"] = table.leaf_branch.size();
  j["leaves_limited"] = limited_leaves(table);
  j["branches"] = branches_of(table);
  if (table.shard.whole()) j["bytes"] = GeometryTable::bytes_of(table);
  j["file_bytes"] = std::filesystem::file_size(file);
  j["tolerance"] = table.tolerance;
  for (const auto& [name, value] : table.statistics) j["statistics"][name] = value;
  if (table.loaded) j["loaded"] = loaded_description(*table.loaded);
  j["provenance"] = {{"program_version", table.provenance.program_version},
                     {"command_line", table.provenance.command_line},
                     {"created", table.provenance.created},
                     {"profile_notes", profile_notes(table)}};
  return j;
}

std::string table_text(const GeometryTableData& table, const std::string& file) {
  const auto milliradians = [&](double square) { return 1e3 * std::sqrt(square); };
  std::string text =
      fmt::format("{}: contact geometry of {} on {}\n", file, table.wheel.name, profile_in_words(table.rail));
  text += fmt::format("  pair         gauge {:.4f} m at {:.1f} mm, flange backs {:.4f} m, nominal radius {:.4f} m\n",
                      table.track_gauge, 1e3 * table.gauge_height, table.flange_back, table.nominal_radius);
  text += fmt::format("  lateral      {:.3f} .. {:.3f} mm, {} root cells (y - R0 roll)\n", 1e3 * table.lateral.low,
                      1e3 * table.lateral.high, table.lateral.cells);
  text +=
      fmt::format("  yaw          {:.3f} .. {:.3f} mrad to either side, {} root cells\n",
                  milliradians(table.yaw_squared.low), milliradians(table.yaw_squared.high), table.yaw_squared.cells);
  text += fmt::format("  roll         {:.3f} .. {:.3f} mrad, {} root cells\n", 1e3 * table.roll.low,
                      1e3 * table.roll.high, table.roll.cells);
  text += fmt::format("  leaves       {}, with {} branches; {} valid for a smaller lowering than the others\n",
                      table.leaf_branch.size(), branches_of(table), limited_leaves(table));
  text += fmt::format("  size         {:.2f} MiB on disk\n",
                      static_cast<double>(std::filesystem::file_size(file)) / 1048576.0);
  if (!table.shard.whole()) {
    text +=
        fmt::format("  part         {} of {}: to be merged with the others\n", table.shard.index, table.shard.count);
    return text;
  }
  text += fmt::format(
      "  verified     on {:.0f} queries: fallback {:.2f} %, missing or additional patches {:.3f} %,\n"
      "               penetration error {:.2g} m (99.9 %), {:.2g} m (largest); tolerance {:.2g} m\n",
      statistic(table.statistics, "certified.samples"), 100 * statistic(table.statistics, "certified.fallback_share"),
      100 * statistic(table.statistics, "certified.patch_mismatch_share"),
      statistic(table.statistics, "certified.error.penetration.p999"),
      statistic(table.statistics, "certified.error.penetration.max"), table.tolerance);
  if (const double poses = statistic(table.statistics, "certified.outlines.poses"); poses > 0.0) {
    text += fmt::format(
        "               by the exact overlap of the outlines at {:.0f} poses of all leaves: contacts missed at {:.0f}, "
        "whose leaves are valid for a smaller lowering\n",
        poses, statistic(table.statistics, "certified.outlines.mismatches"));
  }
  text += table.loaded ? loaded_text(*table.loaded)
                       : "  loaded part  none: contact forces are those of an ellipse per patch (tablegen loaded)\n";
  text += fmt::format("  generated    {} by version {}: {}\n", table.provenance.created,
                      table.provenance.program_version, table.provenance.command_line);
  for (const std::string& note : profile_notes(table)) text += fmt::format("  profile      {}\n", note);
  return text;
}

namespace {

void geometry_info(const TableCommandLine& line, const std::string& file) {
  GeometryTableData read = read_geometry_table(file);
  if (line.given("html")) {
    require_no_input(line.text("html"), {file});
    require_replaceable_text(line.text("html"), report::html_first_line(table_page_kind));
  }
  if (!read.shard.whole()) {
    if (line.given("html")) throw input_error(file, "a part of a table", "a whole one: merge the parts first");
    return line.json() ? print_json(table_description(read, file)) : print_text(table_text(read, file));
  }
  const TableContact table = in_file(file, [&] { return TableContact(GeometryTable(std::move(read))); });
  const GeometryTableData& data = table.table().data();
  const std::string text = line.json() && !line.given("html") ? "" : table_text(data, file);
  const std::optional<WheelsetFunctions> functions = in_file(file, [&] { return wheelset_functions(table); });
  if (line.given("html")) {
    if (!functions)
      throw ComputationError(file + ": the centred wheelset does not touch both rails in the table's range");
    write_text_file(line.text("html"), table_page(table.search().pair(), data, *functions, text));
  }
  if (line.json()) {
    nlohmann::ordered_json description = table_description(data, file);
    if (functions) {
      description["wheelset"] = functions_json(*functions, conicity_amplitudes(functions->radius_difference));
    }
    print_json(description);
  } else {
    print_text(text);
    if (functions) print_text(functions_text(*functions, conicity_amplitudes(functions->radius_difference)));
  }
}

}  // namespace

void info_command(const std::vector<std::string>& arguments) {
  namespace po = boost::program_options;
  po::options_description own("Options");
  own.add_options()("file", po::value<std::string>()->value_name("FILE.h5"), "a table")  //
      ("html", po::value<std::string>()->value_name("PAGE.html"),
       "write a page with contact points, rolling radius difference, contact angle and conicity");
  const TableCommandLine line("tablegen info FILE.h5 [--html PAGE.html] [--json]", own, {"file"}, arguments);
  if (line.help_printed()) return;
  const std::string file = line.required("file");
  if (is_creep_table(file)) {
    if (line.given("html")) throw input_error("--html", "on a creep table", "a geometry table, or no --html");
    const CreepTableData table = read_creep_table(file);
    if (line.json()) {
      print_json(table_description(table, file));
    } else {
      print_formatted("{}", table_text(table, file));
    }
    return;
  }
  geometry_info(line, file);
}

}  // namespace railtab
