#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "fmu_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "study_output.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

/// What a file is, what is in it, and commands that take it.
struct Description {
  std::string kind;
  std::vector<std::string> facts, commands;
};

Description of_results(const std::string& file) {
  const RunResults results = read_results(file);
  const ResultHeader& header = results.header;
  Description d{"results of a run", {}, {}};
  d.facts.push_back(fmt::format("{}: {}", printable(header.scene_name),
                                results.summary.complete ? "complete" : "not complete, " + results.summary.message));
  d.facts.push_back(fmt::format("{} records up to t = {:.6g} s, {} wheels, {} bodies, {} nodes", results.steps.size(),
                                results.steps.empty() ? 0.0 : results.steps.back().time, header.wheel_x.size(),
                                header.body_names.size(), header.node_names.size()));
  d.commands = {fmt::format("vsi report {} -o report.html", file),
                fmt::format("vsi report {} OTHER.h5 -o both.html", file),
                fmt::format("vsi export {} -o run.pvd", file)};
  if (!results.summary.complete) d.commands.push_back(fmt::format("vsi run SCENE.toml -o {} --resume", file));
  return d;
}

Description of_array_file(const std::string& file) {
  const std::string type = array_file_type(file);
  if (type == results_filetype) return of_results(file);
  if (type == geometry_table_filetype) {
    return {"a contact geometry table",
            {},
            {fmt::format("tablegen info {}", file), fmt::format("tablegen conicity {}", file),
             fmt::format("tablegen verify {}", file), fmt::format("tablegen loaded {}", file),
             fmt::format("vsi contact {} --query Q.csv -o R.csv", file),
             fmt::format("a scene's contact.table = \"{}\"", file)}};
  }
  if (type == creep_table_filetype) {
    return {"a creep table",
            {},
            {fmt::format("tablegen info {}", file), fmt::format("tablegen verify {}", file),
             fmt::format("a scene's contact.creep_table = \"{}\"", file)}};
  }
  // Those of tablegen, on which this program does not depend.
  if (type == "railtab-creep-shard") {
    return {"a shard of a creep table", {}, {fmt::format("tablegen merge {} OTHER.h5 -o table.h5", file)}};
  }
  if (type == "railtab-creep-partial" || type == "railtab-loaded-partial") {
    return {"what an interrupted command has computed", {}, {"the same command of tablegen goes on from it"}};
  }
  if (type == study_filetype) return {"results of a study of many runs, one value per run in each array", {}, {}};
  return {fmt::format("a file of the kind {}", type), {}, {}};
}

Description of_toml(const std::string& file) {
  const toml::table table = read_toml(file, "a TOML file");
  const TomlKind kind = toml_kind(table);
  Description d{std::string(kind_name(kind)), {}, {}};
  if (const auto name = table["name"].value<std::string>()) d.facts.push_back(printable(*name));
  switch (kind) {
    case TomlKind::scene:
      d.commands = {fmt::format("vsi check {}", file), fmt::format("vsi run {} --plan", file),
                    fmt::format("vsi run {}", file), fmt::format("vsi sweep {} --speed LO:HI:STEP -o DIR", file),
                    fmt::format("vsi critical-speed {}", file)};
      if (table.contains("bridge") || table.contains("structure")) {
        d.commands.push_back(fmt::format("vsi assess {}", file));
        d.commands.push_back(fmt::format("vsi structure {}", file));
        d.commands.push_back(fmt::format("vsi moving-load {} --speed LO:HI", file));
        d.commands.push_back(fmt::format("vsi fmu {} -o track.fmu", file));
      }
      break;
    case TomlKind::study_plan:
      d.commands = {fmt::format("vsi study {} --count", file), fmt::format("vsi study {} -o DIR", file)};
      break;
    case TomlKind::vehicle:
      if (!table.contains("length")) {  // which every vehicle has
        d.kind = "a joint of vehicles";
        d.commands = {fmt::format("a vehicle's joint_front or joint_rear = \"{}\"", file)};
      } else {
        d.commands = {fmt::format("vsi vehicle {}", file), fmt::format("a scene's train.vehicle = \"{}\"", file)};
      }
      break;
    case TomlKind::pair_list:
      d.commands = {fmt::format("tablegen batch {}", file)};
      break;
    case TomlKind::clauses:
      d.commands = {fmt::format("vsi assess SCENE.toml --clauses {}", file)};
      break;
    case TomlKind::unknown:
      for (const auto& [key, value] : table) d.facts.emplace_back(key.str());
      break;
  }
  return d;
}

/// "run report" from the first line of a page of railtab; empty for other files.
std::string kind_of_page(std::string_view first) {
  constexpr std::string_view end = "\">";
  const std::string nameless = report::html_first_line("");
  const std::string_view begin = std::string_view(nameless).substr(0, nameless.rfind(end));
  if (!first.starts_with(begin) || !first.ends_with(end)) return "";
  return std::string(first.substr(begin.size(), first.size() - begin.size() - end.size()));
}

/// The first line that is neither blank nor a comment of a CSV file or a profile; empty: none.
std::string first_content(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.remove_suffix(1);
    if (!line.empty() && line.front() != '#' && line.front() != '!') return std::string(line);
  }
  return {};
}

/// Whether a line is two numbers, as of a profile's point.
bool is_point(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream in(line);
  double y = 0.0, z = 0.0;
  return in >> y >> z && (in >> std::ws).eof();
}

/// @param text the file's beginning
Description of_text(const std::string& file, std::string_view text, const std::string& ending) {
  const std::string first(text.substr(0, text.find('\n'))), content = first_content(text);
  static const std::map<std::string, std::string> profiles{
      {".prw", "wheel"}, {".whl", "wheel"}, {".prr", "rail"}, {".ban", "rail"}};
  const auto profile = profiles.find(ending);
  if (profile != profiles.end()) {
    const bool wheel = profile->second == "wheel";
    return {fmt::format("a {} profile", profile->second),
            {},
            {wheel ? fmt::format("tablegen geometry --wheel {} --rail 60E1 -o table.h5", file)
                   : fmt::format("tablegen geometry --wheel S1002 --rail {} -o table.h5", file)}};
  }
  if (first.starts_with("%%MatrixMarket")) {
    return {"a sparse matrix (Matrix Market)",
            {printable(first)},
            {fmt::format("a scene's structure.stiffness, structure.mass or structure.damping = \"{}\"", file)}};
  }
  if (ending == ".mtx") {
    return {"a matrix, of Abaqus if it is by *MATRIX OUTPUT",
            {printable(first)},
            {fmt::format("a scene's structure.stiffness, structure.mass or structure.damping = \"{}\", with "
                         "structure.format = \"abaqus\"",
                         file)}};
  }
  if (const std::string kind = kind_of_page(first); !kind.empty()) {
    return {fmt::format("a page of railtab: {}", printable(kind)), {}, {"open it in a browser"}};
  }
  if (first.starts_with("<svg ")) return {"a picture (SVG)", {}, {"open it in a browser"}};
  if (ending == ".pvd") return {"instants of a run for ParaView", {}, {fmt::format("paraview {}", file)}};
  if (ending == ".json" && content.starts_with('{')) return {"values of a command (JSON)", {}, {}};
  if (is_point(content)) {
    return {"points of two columns, as of a profile",
            {"begins with: " + printable(content)},
            {fmt::format("tablegen geometry --wheel {} --rail 60E1 -o table.h5", file),
             fmt::format("tablegen geometry --wheel S1002 --rail {} -o table.h5", file)}};
  }
  if (ending == ".csv") {
    if (content.starts_with("ratio,")) {
      return {"queries of creep forces", {printable(content)}, {fmt::format("vsi creep --query {} -o R.csv", file)}};
    }
    if (content.starts_with("y,")) {
      return {"queries of the contact",
              {printable(content)},
              {fmt::format("vsi contact TABLE.h5 --query {} -o R.csv", file)}};
    }
    if (content.starts_with("mode,")) {
      const bool table = content.find("frequency") != std::string::npos;
      return {table ? "natural modes of a structure" : "shapes of natural modes",
              {"columns: " + printable(content)},
              {fmt::format("a scene's structure.{} = \"{}\"", table ? "mode_table" : "mode_shapes", file)}};
    }
    return {
        "columns of numbers (CSV)", {"columns: " + printable(content)}, {"docs/file_formats says what scenes read"}};
  }
  throw input_error(file,
                    first.empty() ? "an empty file" : fmt::format("a file that begins with '{}'", printable(first, 40)),
                    "a scene, a vehicle, a table, results, a profile, a matrix or a CSV; or a command: vsi --help");
}

Description describe(const std::string& file) {
  if (is_array_file(file)) return of_array_file(file);
  if (fmu::is_fmu(file)) {
    return {"track and bridges as an FMU (FMI 2.0, co-simulation)", {}, {"docs/guide/fmu.md says how to drive it"}};
  }
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".toml") return of_toml(file);
  std::ifstream in(file);
  std::string text(4096, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad() || !in.is_open()) {
    throw input_error(file, "a file that cannot be read", "a readable file");
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  return of_text(file, text, ending);
}

}  // namespace

int describe_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("file", text_value()->value_name("FILE"), "any file");
  const CommandLine line("vsi FILE", own, {"file"}, arguments);
  if (line.help_printed()) return 0;
  const std::string file = line.required("file");
  const Description description = describe(file);
  if (line.json()) {
    print_json_line(
        {{"file", file}, {"kind", description.kind}, {"facts", description.facts}, {"commands", description.commands}});
    return 0;
  }
  print_formatted("{}: {}\n", file, description.kind);
  for (const std::string& fact : description.facts) print_formatted("  {}\n", fact);
  for (const std::string& command : description.commands) print_formatted("  > {}\n", command);
  return 0;
}

}  // namespace railtab::vsi
