#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "report_page.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;

int report_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("results", text_value()->value_name("RESULTS.h5"), "results of a run")  //
      ("output,o", text_value()->value_name("REPORT.html"), "the report: one page that needs no other file");
  const CommandLine line("vsi report RESULTS.h5 -o REPORT.html", own, {"results"}, arguments);
  if (line.help_printed()) return 0;
  const std::string results = line.required("results"), output = line.required("output");
  require_writable_place(output, "-o");
  require_no_input(output, {results});
  require_replaceable_text(output, report::html_first_line(report::page_kind));
  report::write_report(output, read_results(results));
  if (line.json()) {
    print_json_line({{"report", output}});
  } else if (!line.quiet()) {
    print_formatted("Report: {}\n", output);
  }
  return 0;
}

}  // namespace railtab::vsi
