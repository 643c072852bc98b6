// Error against run time: measures, and writes CSV, SVG and one HTML page.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "creep_figure.hpp"
#include "geometry_figure.hpp"
#include "integration_figure.hpp"
#include "log_figure.hpp"
#include "machine.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "scaling_figure.hpp"
#include "scene_figure.hpp"

namespace railtab::work_precision {
namespace {

constexpr const char* usage =
    "work_precision [--quick] [--figure NAME]... [--creep-table FILE.h5]... [--table FILE.h5] [--paper-creep FILE.h5] "
    "-o "
    "FOLDER\n"
    "Measures error against run time and writes, for each figure, FOLDER/<figure>.csv and .svg, and all of them in\n"
    "FOLDER/index.html. NAME: geometry, creep, integration, scene, scaling, threads; all of them where none is named.\n"
    "--table: geometry table of S1002 on 60E1 1:40 for scenes and scaling. --paper-creep: creep table in the "
    "published\n"
    "layout (tablegen creep --layout paper). --quick: fewer queries and settings.\n";

struct Options {
  bool quick = false;
  std::filesystem::path folder;
  std::vector<std::string> figures;
  std::vector<std::filesystem::path> creep_tables;
  SceneTables tables;
};

using Figures = std::vector<WorkFigure>;
struct Group {
  std::string_view name;
  Figures (*make)(const Options&);
};
constexpr std::array groups{
    Group{"geometry", [](const Options& o) { return Figures{geometry_figure(o.quick)}; }},
    Group{"creep", [](const Options& o) { return Figures{creep_figure(o.creep_tables, o.quick)}; }},
    Group{"integration", [](const Options& o) { return integration_figures(o.quick); }},
    Group{"scene", [](const Options& o) { return scene_figures(o.tables, o.quick); }},
    Group{"scaling", [](const Options& o) { return scaling_figures(o.tables.geometry, o.quick); }},
    Group{"threads", [](const Options& o) { return Figures{threads_figure(o.quick)}; }}};

Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 == arguments.size()) throw input_error(argument, "nothing", "a value");
      return arguments[++i];
    };
    if (argument == "--quick") {
      options.quick = true;
    } else if (argument == "-o") {
      options.folder = value();
    } else if (argument == "--figure") {
      options.figures.push_back(value());
      const std::string& name = options.figures.back();
      if (std::none_of(groups.begin(), groups.end(), [&](const Group& g) { return g.name == name; })) {
        throw input_error("work_precision: --figure", name, "geometry, creep, integration, scene, scaling or threads");
      }
    } else if (argument == "--creep-table") {
      options.creep_tables.emplace_back(value());
    } else if (argument == "--table") {
      options.tables.geometry = value();
    } else if (argument == "--paper-creep") {
      options.tables.paper_creep = value();
    } else {
      throw input_error("work_precision", argument,
                        "--quick, --figure, --creep-table, --table, --paper-creep or -o, see --help");
    }
  }
  if (options.folder.empty()) throw input_error("work_precision: -o", "nothing", "a folder for the figures");
  if (options.creep_tables.empty()) options.creep_tables.push_back(shipped_creep_table());
  return options;
}

std::string table_of(const WorkFigure& figure) {
  const std::vector<bool> front = pareto_front(figure);
  const bool over_size = figure.kind == FigureKind::time_over_size;
  std::string rows = fmt::format("<table><tr><th>method</th><th>setting</th><th>{}</th><th>{}</th>{}<th></th></tr>\n",
                                 report::escaped(figure.x_label), report::escaped(figure.y_label),
                                 over_size ? "" : "<th>largest</th><th>Pareto front</th>");
  for (std::size_t i = 0; i < figure.points.size(); ++i) {
    const WorkPoint& p = figure.points[i];
    rows += fmt::format("<tr><td>{}</td><td>{}{}</td><td>{}</td><td>{:.2g}</td>", report::escaped(p.method),
                        report::escaped(p.setting), p.standard ? " (default)" : "",
                        over_size ? fmt::format("{:g}", p.x) : time_name(p.x), p.y);
    if (!over_size) rows += fmt::format("<td>{:.2g}</td><td>{}</td>", p.largest_error, front[i] ? "yes" : "");
    rows += fmt::format("<td>{}</td></tr>\n", report::escaped(p.note));
  }
  return rows + "</table>\n";
}

int run(const std::vector<std::string>& arguments) {
  const Options options = parse(arguments);
  std::filesystem::create_directories(options.folder);
  const std::string origin = fmt::format("railtab {}, commit {}; {}{}", version(), source_commit(), machine_kind(),
                                         options.quick ? "; --quick" : "");
  std::string body = "<p>" + report::escaped(origin) + "</p>\n";
  for (const Group& group : groups) {
    if (!options.figures.empty() && std::none_of(options.figures.begin(), options.figures.end(),
                                                 [&](const std::string& name) { return name == group.name; })) {
      continue;
    }
    for (const WorkFigure& figure : group.make(options)) {
      if (figure.points.empty()) continue;
      const std::string svg = log_figure(figure);
      write_text_file(options.folder / (figure.name + ".csv"), "# " + origin + "\n" + csv(figure), "# railtab ");
      write_text_file(options.folder / (figure.name + ".svg"), svg);
      body +=
          report::html_section(figure.title, svg + table_of(figure) + "<p>" + report::escaped(figure.advice) + "</p>");
      fmt::print("{}: {} points\n", figure.name, figure.points.size());
      std::fflush(stdout);
    }
  }
  write_text_file(options.folder / "index.html",
                  report::html_page("error against run time", "Error against run time", body, version()));
  fmt::print("{}\n", (options.folder / "index.html").string());
  return 0;
}

}  // namespace
}  // namespace railtab::work_precision

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.empty() || arguments[0] == "--help") {
    std::fputs(railtab::work_precision::usage, stdout);
    return arguments.empty() ? 2 : 0;
  }
  try {
    return railtab::work_precision::run(arguments);
  } catch (const railtab::InputError& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 1;
  }
}
