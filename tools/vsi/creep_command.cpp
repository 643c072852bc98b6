#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

/// "table", "polach" or, where the table fades into it, "blend"; the law's name for the others.
std::string_view source(const CreepLaw& law, double ratio, const Creepage& creepage) {
  const auto* table = std::get_if<TableCreep>(&law);
  if (!table) return creep_law_name(law);
  const double share = table->share(ratio, creepage);
  return share == 1.0 ? "table" : share == 0.0 ? "polach" : "blend";
}

constexpr const char* result_header = "fx,fy,mz,source\n";

struct Answer {
  std::string text = result_header;
  long outside = 0;  ///< queries that Polach answered for the table, wholly or in part
};

Answer answer(const CreepLaw& law, const NumberRows& queries) {
  Answer result;
  for (std::size_t i = 0; i < queries.rows.size(); ++i) {
    const std::vector<double>& q = queries.rows[i];
    constexpr double most = 1e6;
    if (!(q[0] > 0.0 && q[0] <= most && q[0] * most >= 1.0)) {
      throw input_error(queries.places[i], fmt::format("ratio = {}", q[0]), "a/b > 0, from 1e-06 to 1e+06");
    }
    const Creepage creepage{q[1], q[2], q[3]};
    const CreepForce force = creep_force(law, q[0], creepage);
    const std::string_view from = source(law, q[0], creepage);
    result.outside += from != creep_law_name(law);
    fmt::format_to(std::back_inserter(result.text), "{},{},{},{}\n", force.x, force.y, force.moment, from);
  }
  return result;
}

/// Poisson's ratio that was asked for, or the one of the table.
CreepLaw wanted_law(const CommandLine& line, const std::string& name) {
  const std::string table = line.given("table") ? line.text("table") : std::string();
  if (line.given("poisson")) {
    const double nu = line.number("poisson");
    if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("--poisson", fmt::format("{}", nu), "a number 0 to 0.5");
    return creep_law(name, nu, table);
  }
  if (name == "table" && !table.empty()) {
    return in_file(table, [&table] { return TableCreep{std::make_shared<const CreepTable>(read_creep_table(table))}; });
  }
  return creep_law(name, 0.28);
}

}  // namespace

int creep_command(const Arguments& arguments) {
  po::options_description own("Options");
  own.add_options()("table", text_value()->value_name("TABLE.h5"), "a creep table; the shipped one without it")  //
      ("query", text_value()->value_name("Q.csv"), "columns ratio,ux,uy,phi: a/b and normalised creepages")      //
      ("output,o", text_value()->value_name("R.csv"), "columns fx,fy,mz,source")                                 //
      ("law", text_value("table")->value_name("table|polach|fastsim|linear"), "the creep law")                   //
      ("poisson", text_value()->value_name("NU"),
       "Poisson's ratio of wheel and rail (0.28, or the table's where one is named)");
  const CommandLine line("vsi creep [TABLE.h5] --query Q.csv -o R.csv [--law table|polach|fastsim|linear]", own,
                         {"table"}, arguments);
  if (line.help_printed()) return 0;
  const std::string name = line.text("law");
  const std::vector<std::string> laws{"table", "polach", "fastsim", "linear"};
  if (std::find(laws.begin(), laws.end(), name) == laws.end()) {
    throw input_error("--law", name, "table, polach, fastsim or linear");
  }
  const std::string query = line.required("query"), output = line.required("output");
  require_writable_place(output, "-o");
  require_no_input(output, {query});
  if (line.given("table")) require_no_input(output, {line.text("table")});
  if (line.given("table") && name != "table") {
    throw input_error("--law " + name, "with the creep table " + line.text("table"), "--law table, or no table");
  }
  require_replaceable_text(output, result_header);
  const CreepLaw law = wanted_law(line, name);
  const NumberRows queries = read_number_rows(query, {"ratio", "ux", "uy", "phi"});
  const Answer result = answer(law, queries);
  write_text_file(output, result.text);
  if (line.json()) {
    print_json_line(
        {{"queries", queries.rows.size()}, {"law", name}, {"outside_table", result.outside}, {"output", output}});
  } else if (!line.quiet()) {
    print_formatted("{} queries by {}: {}\n", queries.rows.size(), name, output);
    if (result.outside > 0)
      print_formatted("{} of them outside the table or at its border, answered by Polach\n", result.outside);
  }
  return 0;
}

}  // namespace railtab::vsi
