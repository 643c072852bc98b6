#include <fmt/format.h>

#include <functional>
#include <map>

#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"

namespace railtab {

namespace {

constexpr const char* usage = R"(Usage: tablegen COMMAND [options]

  geometry   make a contact geometry table of a wheel and a rail profile
  batch      make the geometry tables of a list of wheel and rail pairs
  creep      make a table of creep forces by exact rolling contact, or one shard of it
  merge      combine the shards of a table
  contact    solve one contact of a wheel on its rail, or one exact rolling contact of an ellipse
  conicity   rolling radius difference and equivalent conicity (EN 15302)
  loaded     add the loaded contact (half-space solutions over all poses) to a geometry table
  info       print the contents of a table
  verify     compare a table with the online search: errors, share of fallback, time per query

tablegen COMMAND --help lists the options, tablegen --version prints the version.
Exit code: 0 done, 1 the computation failed, 2 the input is wrong.
)";

int run(const std::vector<std::string>& arguments) {
  const std::map<std::string, std::function<void(const std::vector<std::string>&)>> commands{
      {"batch", batch_command},   {"conicity", conicity_command}, {"contact", contact_command},
      {"creep", creep_command},   {"geometry", geometry_command}, {"info", info_command},
      {"loaded", loaded_command}, {"merge", merge_command},       {"verify", verify_command}};
  if (arguments.empty()) throw InputError(fmt::format("no command\n\n{}", usage));
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    print_formatted("{}", usage);
    return 0;
  }
  if (arguments[0] == "--version") {
    print_formatted("railtab {}\n", RAILTAB_VERSION);
    return 0;
  }
  const auto command = commands.find(arguments[0]);
  if (command == commands.end()) {
    throw input_error("command", fmt::format("\"{}\"", arguments[0]),
                      "geometry, batch, creep, merge, contact, conicity, loaded, info or verify");
  }
  command->second({arguments.begin() + 1, arguments.end()});
  return 0;
}

}  // namespace

}  // namespace railtab

int main(int argc, char** argv) {
  return railtab::run_process("tablegen", [&] { return railtab::run({argv + 1, argv + argc}); });
}
