#include "command/command_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command/print.hpp"
#include "railtab/runtime/base/edit_distance.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/version.hpp"

namespace railtab {

namespace {

std::string usage(const CommandTable& table) {
  const std::string_view program = table.program;
  std::string text =
      fmt::format("Usage: {} COMMAND [OPTIONS]; {} COMMAND --help lists the options\n", program, program);
  if (!table.file_form.empty()) text += fmt::format("       {} FILE: {}\n", program, table.file_form);
  std::size_t name_width = 0, arguments_width = 0;
  for (const Subcommand& command : table.subcommands) {
    name_width = std::max(name_width, command.name.size());
    arguments_width = std::max(arguments_width, command.arguments.size());
  }
  text += "\n";
  for (const Subcommand& command : table.subcommands) {
    text += fmt::format("  {:<{}}  {:<{}}  {}\n", command.name, name_width, command.arguments, arguments_width,
                        command.summary);
  }
  text += "\nExit code:\n";
  for (const ExitCode& exit : table.exit_codes) text += fmt::format("  {:>3}  {}\n", exit.code, exit.meaning);
  return text;
}

std::string quoted(std::string_view text) { return nlohmann::json(text).dump(); }

/// "; did you mean 'run'?" where a subcommand has nearly this name.
std::string suggestion(const CommandTable& table, std::string_view name) {
  constexpr std::size_t near = 2;
  const auto distance = [&](const Subcommand& command) { return edit_distance(command.name, name); };
  const auto nearest = std::ranges::min_element(table.subcommands, {}, distance);
  const bool alike = distance(*nearest) <= near && distance(*nearest) < nearest->name.size();
  return alike ? fmt::format("; did you mean '{}'?", nearest->name) : "";
}

/// Each subcommand prints its own interface, in its place in the program's.
int print_interface(const CommandTable& table) {
  print_formatted("{{\"program\": {}, \"purpose\": {}, \"version\": {}, \"file_form\": {}, \"exit_codes\": [",
                  quoted(table.program), quoted(table.purpose), quoted(version()), quoted(table.file_form));
  const char* separator = "";
  for (const ExitCode& exit : table.exit_codes) {
    print_formatted("{}{{\"code\": {}, \"meaning\": {}}}", separator, exit.code, quoted(exit.meaning));
    separator = ", ";
  }
  print_text("], \"commands\": [\n");
  separator = "";
  for (const Subcommand& command : table.subcommands) {
    print_formatted("{}{{\"name\": {}, \"summary\": {}, \"interface\": ", separator, quoted(command.name),
                    quoted(command.summary));
    if (const int code = command.run({"--json-usage"}); code != exit_code::done) return code;
    print_text("}");
    separator = ",\n";
  }
  print_text("\n]}\n");
  return exit_code::done;
}

}  // namespace

const Subcommand* CommandTable::find(std::string_view name) const {
  const auto found = std::find_if(subcommands.begin(), subcommands.end(),
                                  [&](const Subcommand& command) { return command.name == name; });
  return found == subcommands.end() ? nullptr : &*found;
}

int run_command_table(const CommandTable& table, const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw InputError(fmt::format("no command\n{}", usage(table)));
  const std::string& first = arguments.front();
  if (const Subcommand* command = table.find(first)) return command->run({arguments.begin() + 1, arguments.end()});
  if (first == "--json-usage") return print_interface(table);
  const Subcommand* topic = first == "help" && arguments.size() > 1 ? table.find(arguments[1]) : nullptr;
  if (topic) return topic->run({"--help"});
  if (first == "--help" || first == "-h" || (first == "help" && arguments.size() == 1)) {
    print_text(usage(table));
    return exit_code::done;
  }
  if (first == "--version") {
    print_formatted("railtab {}\n", version());
    return exit_code::done;
  }
  const std::string& unknown = first == "help" ? arguments[1] : first;
  throw InputError(fmt::format("unknown command '{}'{}\n{} --help lists the commands", unknown,
                               suggestion(table, unknown), table.program));
}

}  // namespace railtab
