#include <fmt/format.h>

#include <iterator>

#include "command_line.hpp"
#include "commands.hpp"
#include "csv_table.hpp"
#include "json_object.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tables/input_error.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

std::string answer(const CreepLaw& law, std::string_view name, const CsvTable& queries, const std::string& file) {
  std::string text = "fx,fy,mz,source\n";
  for (std::size_t i = 0; i < queries.rows.size(); ++i) {
    const std::vector<double>& q = queries.rows[i];
    if (!(q[0] > 0.0)) {
      throw input_error(fmt::format("{}:{}", file, queries.line[i]), fmt::format("ratio = {}", q[0]), "a/b > 0");
    }
    const CreepForce force = creep_force(law, q[0], {q[1], q[2], q[3]});
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", force.x, force.y, force.moment, name);
  }
  return text;
}

}  // namespace

int creep_command(const Arguments& arguments) {
  CommandSyntax syntax{
      "vsi creep [TABLE.h5] --query Q.csv -o R.csv [--law table|polach|fastsim|linear]", "table", false, {}};
  syntax.options.add_options()("query", po::value<std::string>()->required()->value_name("Q.csv"),
                               "columns ratio,ux,uy,phi: a/b and normalised creepages")(
      "output,o", po::value<std::string>()->required()->value_name("R.csv"), "columns fx,fy,mz,source")(
      "law", po::value<std::string>()->default_value("table")->value_name("LAW"), "table, polach, fastsim or linear")(
      "poisson", po::value<double>()->default_value(0.28)->value_name("NU"), "Poisson's ratio of wheel and rail");
  const auto values = parse_command_line(syntax, arguments);
  if (!values) return 0;
  const std::string name = (*values)["law"].as<std::string>();
  if (name == "table") {
    throw input_error("--law", "table, but this version of railtab has no creep table", "polach, fastsim or linear");
  }
  const double nu = (*values)["poisson"].as<double>();
  if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("--poisson", fmt::format("{}", nu), "a number 0 to 0.5");
  const std::string query_file = (*values)["query"].as<std::string>();
  const std::string output = (*values)["output"].as<std::string>();
  require_writable_place(output, "-o");
  require_no_input(output, {query_file});
  const CreepLaw law = creep_law(name, nu);
  const CsvTable queries = read_csv(query_file, {"ratio", "ux", "uy", "phi"});
  write_text_file(output, answer(law, name, queries, query_file));
  const auto count = static_cast<long>(queries.rows.size());
  if (values->contains("json")) {
    fmt::print("{}\n", JsonObject().add("queries", count).add("law", name).add("output", output).text());
  } else if (!values->contains("quiet")) {
    fmt::print("{} queries by {}: {}\n", count, name, output);
  }
  return 0;
}

}  // namespace railtab::vsi
