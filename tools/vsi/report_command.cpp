#include <fmt/format.h>

#include "command_line.hpp"
#include "commands.hpp"
#include "json_object.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "report_page.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;

int report_command(const Arguments& arguments) {
  CommandSyntax syntax{"vsi report RESULTS.h5 -o REPORT.html", "results", true, {}};
  syntax.options.add_options()("output,o", po::value<std::string>()->required()->value_name("REPORT.html"),
                               "the report: one page that needs no other file");
  const auto values = parse_command_line(syntax, arguments);
  if (!values) return 0;
  const std::string output = (*values)["output"].as<std::string>();
  require_writable_place(output, "-o");
  require_no_input(output, {(*values)["results"].as<std::string>()});
  report::write_report(output, read_results((*values)["results"].as<std::string>()));
  if (values->contains("json")) {
    fmt::print("{}\n", JsonObject().add("report", output).text());
  } else if (!values->contains("quiet")) {
    fmt::print("Report: {}\n", output);
  }
  return 0;
}

}  // namespace railtab::vsi
