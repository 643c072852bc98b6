#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// A subcommand of a program.
struct Subcommand {
  std::string_view name;
  std::string_view arguments;  ///< behind the name in the program's --help: the usual ones
  std::string_view summary;    ///< what it does, without a full stop
  /// Runs it with the arguments after its name. @return the exit code
  std::function<int(const std::vector<std::string>&)> run;
};

struct ExitCode {
  int code = 0;
  std::string_view meaning;
};

/// A program of subcommands: what --help, man pages and completions are made from.
struct CommandTable {
  std::string_view program;
  std::string_view purpose;    ///< in one line, as the name line of a man page
  std::string_view file_form;  ///< what `program FILE` does; empty where there is no such form
  std::vector<Subcommand> subcommands;
  std::vector<ExitCode> exit_codes;

  /// Null where there is none of this name.
  [[nodiscard]] const Subcommand* find(std::string_view name) const;
};

/// Runs what the arguments of the program ask for: a subcommand, --help, help with or without the name of one,
/// --version, or --json-usage, the whole interface as JSON. @return the exit code. @throws InputError where the first
/// argument is none of these, with the subcommand of a similar name
int run_command_table(const CommandTable& table, const std::vector<std::string>& arguments);

}  // namespace railtab
