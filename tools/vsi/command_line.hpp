#pragma once

#include <boost/program_options.hpp>
#include <optional>
#include <string>
#include <vector>

namespace railtab::vsi {

/// How a subcommand is called: its usage line, its one positional argument and its own options. Every command has
/// --help, --version, --threads, --quiet and --json besides.
struct CommandSyntax {
  std::string usage;       ///< "vsi run SCENE.toml [-o RESULTS.h5]"
  std::string positional;  ///< name of the positional argument: "scene"
  bool positional_required = true;
  boost::program_options::options_description options;
};

/// Parsed options, or nothing where --help or --version was asked for and answered.
/// @throws InputError naming the option that is unknown, repeated, without its value or missing.
[[nodiscard]] std::optional<boost::program_options::variables_map> parse_command_line(
    const CommandSyntax& syntax, const std::vector<std::string>& arguments);

/// @throws InputError where `file` could not be created: its folder does not exist, or it is a folder.
void require_writable_place(const std::string& file, const std::string& option);

}  // namespace railtab::vsi
