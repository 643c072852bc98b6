#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "report_page.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

/// Names of runs that are compared: those of their files, with the folders where names are equal.
std::vector<std::string> run_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) names.push_back(std::filesystem::path(file).stem().string());
  return std::set<std::string>(names.begin(), names.end()).size() == files.size() ? names : files;
}

void require_different(const std::vector<std::string>& files) {
  constexpr std::size_t most = 8;  // lines that can be told apart
  if (files.size() > most) {
    throw input_error("vsi report", fmt::format("{} results", files.size()),
                      fmt::format("at most {} that one page can compare", most));
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (std::find(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i), files[i]) !=
        files.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw input_error("vsi report", fmt::format("{} twice", files[i]), "results of different runs");
    }
  }
}

}  // namespace

int report_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("results", po::value<std::vector<std::string>>()->value_name("RESULTS.h5"),
                    "results of a run, or of several to compare")  //
      ("output,o", text_value()->value_name("REPORT.html"), "the report: one page that needs no other file");
  const CommandLine line("vsi report RESULTS.h5... -o REPORT.html", own, {"results..."}, arguments);
  if (line.help_printed()) return 0;
  const std::vector<std::string> files = line.required_many("results");
  const std::string output = line.required("output");
  require_different(files);
  require_writable_place(output, "-o");
  for (const std::string& file : files) require_no_input(output, {file});
  require_replaceable_text(output, report::html_first_line(report::page_kind));
  require_fitting_name(output, "-o", "an HTML page, which a browser prints as PDF", {".html", ".htm"});
  std::vector<RunResults> runs;
  for (const std::string& file : files) runs.push_back(read_results(file));
  write_text_file(
      output, runs.size() == 1 ? report::report_page(runs.front()) : report::comparison_page(runs, run_names(files)));
  if (line.json()) {
    print_json_line({{"report", output}});
  } else if (!line.quiet()) {
    print_formatted("Report: {}\n", output);
  }
  return 0;
}

}  // namespace railtab::vsi
