#include "command_line.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

po::options_description common_options() {
  po::options_description options("All commands");
  options.add_options()("help,h", "this text")("version", "version of railtab")(
      "threads", po::value<int>()->default_value(0)->value_name("N"),
      "threads to use, 0: all; all commands but sweep use one")("quiet,q", "no progress and no text, errors apart")(
      "json", "one JSON object on stdout");
  return options;
}

}  // namespace

std::optional<po::variables_map> parse_command_line(const CommandSyntax& syntax,
                                                    const std::vector<std::string>& arguments) {
  po::options_description visible;
  visible.add(syntax.options).add(common_options());
  po::options_description all;
  all.add(visible);
  all.add_options()(syntax.positional.c_str(), po::value<std::string>());
  po::positional_options_description positional;
  positional.add(syntax.positional.c_str(), 1);
  po::variables_map values;
  try {
    // no guessing: an abbreviated option would change its meaning with the next option added
    const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(arguments).options(all).positional(positional).style(style).run(), values);
    if (values.contains("help")) {
      std::ostringstream text;
      text << visible;
      fmt::print("{}\n{}", syntax.usage, text.str());
      return std::nullopt;
    }
    if (values.contains("version")) {
      fmt::print("railtab {}\n", RAILTAB_VERSION);
      return std::nullopt;
    }
    po::notify(values);
  } catch (const po::error& wrong) {
    throw InputError(fmt::format("{}\nusage: {}", wrong.what(), syntax.usage));
  }
  if (syntax.positional_required && !values.contains(syntax.positional)) {
    throw InputError(fmt::format("the argument {} is missing\nusage: {}", syntax.positional, syntax.usage));
  }
  if (values["threads"].as<int>() < 0) {
    throw input_error("--threads", std::to_string(values["threads"].as<int>()), "a number >= 0");
  }
  return values;
}

void require_writable_place(const std::string& file, const std::string& option) {
  const std::filesystem::path path(file);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code failed;
  if (!std::filesystem::is_directory(folder, failed)) {
    throw input_error(option, fmt::format("no folder {}", folder.string()), "a file in an existing folder");
  }
  if (std::filesystem::is_directory(path, failed)) {
    throw input_error(option, fmt::format("the folder {}", file), "a file");
  }
  static_cast<void>(output_file(path));
}

}  // namespace railtab::vsi
