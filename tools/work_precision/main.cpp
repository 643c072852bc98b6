// Error against run time: measures, and writes CSV, SVG and one HTML page.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "creep_figure.hpp"
#include "geometry_figure.hpp"
#include "html_page.hpp"
#include "html_text.hpp"
#include "log_figure.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tables/input_error.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab::work_precision {
namespace {

constexpr const char* usage =
    "work_precision [--quick] [--creep-table FILE.h5]... -o FOLDER\n"
    "Measures error against run time and writes, for each figure, FOLDER/<figure>.csv and .svg, and all of them in\n"
    "FOLDER/index.html. Figures: geometry, creep. --quick: fewer queries and settings.\n";

struct Options {
  bool quick = false;
  std::filesystem::path folder;
  std::vector<std::filesystem::path> creep_tables;
};

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
    } else if (argument == "--creep-table") {
      options.creep_tables.emplace_back(value());
    } else {
      throw input_error("work_precision", argument, "--quick, --creep-table FILE.h5 or -o FOLDER");
    }
  }
  if (options.folder.empty()) throw input_error("work_precision: -o", "nothing", "a folder for the figures");
  if (options.creep_tables.empty()) options.creep_tables.push_back(shipped_creep_table());
  return options;
}

std::string table_of(const WorkFigure& figure) {
  const std::vector<bool> front = pareto_front(figure);
  std::string rows =
      "<table><tr><th>method</th><th>setting</th><th>time per query</th><th>error</th><th>largest</th><th>"
      "Pareto front</th><th></th></tr>\n";
  for (std::size_t i = 0; i < figure.points.size(); ++i) {
    const WorkPoint& p = figure.points[i];
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.3g} ns</td><td>{:.2g}</td><td>{:.2g}</td><td>{}</td><td>{}</td></tr>\n",
        report::escaped(p.method), report::escaped(p.setting), p.time_ns, p.error, p.largest_error,
        front[i] ? "yes" : "", report::escaped(p.note));
  }
  return rows + "</table>\n";
}

int run(const std::vector<std::string>& arguments) {
  const Options options = parse(arguments);
  std::filesystem::create_directories(options.folder);
  std::string body;
  for (const auto& make : {+[](const Options& o) { return geometry_figure(o.quick); },
                           +[](const Options& o) { return creep_figure(o.creep_tables, o.quick); }}) {
    const WorkFigure figure = make(options);
    const std::string svg = log_figure(figure);
    write_text_file(options.folder / (figure.name + ".csv"), csv(figure));
    write_text_file(options.folder / (figure.name + ".svg"), svg);
    body +=
        report::html_section(figure.title, svg + table_of(figure) + "<p>" + report::escaped(figure.advice) + "</p>");
    fmt::print("{}: {} points\n", figure.name, figure.points.size());
  }
  write_text_file(options.folder / "index.html", report::html_page("Error against run time", body, RAILTAB_VERSION));
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
