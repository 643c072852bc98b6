#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "commands.hpp"
#include "csv_table.hpp"
#include "json_object.hpp"
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

struct Answer {
  std::string text = "fx,fy,mz,source\n";
  long outside = 0;  ///< queries that Polach answered for the table, wholly or in part
};

Answer answer(const CreepLaw& law, const CsvTable& queries, const std::string& file) {
  Answer result;
  for (std::size_t i = 0; i < queries.rows.size(); ++i) {
    const std::vector<double>& q = queries.rows[i];
    constexpr double most = 1e6;
    if (!(q[0] > 0.0 && q[0] <= most && q[0] * most >= 1.0)) {
      throw input_error(fmt::format("{}:{}", file, queries.line[i]), fmt::format("ratio = {}", q[0]),
                        "a/b > 0, from 1e-06 to 1e+06");
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
CreepLaw wanted_law(const po::variables_map& values, const std::string& name) {
  const std::string table = values.contains("table") ? values["table"].as<std::string>() : std::string();
  if (values.contains("poisson")) {
    const double nu = values["poisson"].as<double>();
    if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("--poisson", fmt::format("{}", nu), "a number 0 to 0.5");
    return creep_law(name, nu, table);
  }
  if (name == "table" && !table.empty()) {
    return TableCreep{std::make_shared<const CreepTable>(read_creep_table(table))};
  }
  return creep_law(name, 0.28);
}

}  // namespace

int creep_command(const Arguments& arguments) {
  CommandSyntax syntax{
      "vsi creep [TABLE.h5] --query Q.csv -o R.csv [--law table|polach|fastsim|linear]", "table", false, {}};
  syntax.options.add_options()("query", po::value<std::string>()->required()->value_name("Q.csv"),
                               "columns ratio,ux,uy,phi: a/b and normalised creepages")(
      "output,o", po::value<std::string>()->required()->value_name("R.csv"), "columns fx,fy,mz,source")(
      "law", po::value<std::string>()->default_value("table")->value_name("LAW"), "table, polach, fastsim or linear")(
      "poisson", po::value<double>()->value_name("NU"),
      "Poisson's ratio of wheel and rail (0.28, or the table's where one is named)");
  const auto values = parse_command_line(syntax, arguments);
  if (!values) return 0;
  const std::string name = (*values)["law"].as<std::string>();
  const std::vector<std::string> laws{"table", "polach", "fastsim", "linear"};
  if (std::find(laws.begin(), laws.end(), name) == laws.end()) {
    throw input_error("--law", name, "table, polach, fastsim or linear");
  }
  const std::string query_file = (*values)["query"].as<std::string>();
  const std::string output = (*values)["output"].as<std::string>();
  require_writable_place(output, "-o");
  require_no_input(output, {query_file});
  if (values->contains("table")) require_no_input(output, {(*values)["table"].as<std::string>()});
  if (values->contains("table") && name != "table") {
    throw input_error("--law " + name, "with the creep table " + (*values)["table"].as<std::string>(),
                      "--law table, or no table");
  }
  const CreepLaw law = wanted_law(*values, name);
  const CsvTable queries = read_csv(query_file, {"ratio", "ux", "uy", "phi"});
  const Answer result = answer(law, queries, query_file);
  write_text_file(output, result.text);
  const auto count = static_cast<long>(queries.rows.size());
  if (values->contains("json")) {
    fmt::print("{}\n", JsonObject()
                           .add("queries", count)
                           .add("law", name)
                           .add("outside_table", result.outside)
                           .add("output", output)
                           .text());
  } else if (!values->contains("quiet")) {
    fmt::print("{} queries by {}: {}\n", count, name, output);
    if (result.outside > 0)
      fmt::print("{} of them outside the table or at its border, answered by Polach\n", result.outside);
  }
  return 0;
}

}  // namespace railtab::vsi
