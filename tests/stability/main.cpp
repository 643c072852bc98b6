// Stiff and extreme cases, each with its outcome: text on the screen and CSV for docs/validation.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "outcome_table.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "stability_case.hpp"

namespace railtab::stability {
namespace {

constexpr const char* usage =
    "stability [--quick] [--group WORDS] [-o FOLDER]\n"
    "Runs the matrix of stiff and extreme cases, prints the outcome of each and writes FOLDER/stability.csv.\n"
    "--quick: the reduced matrix of the tests. --group: only groups whose\n"
    "name has these words. Exit code 1 where an outcome is not the expected one.\n";

int run(const std::vector<std::string>& arguments) {
  bool quick = false;
  std::string group;
  std::filesystem::path folder;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 == arguments.size()) throw input_error(argument, "nothing", "a value");
      return arguments[++i];
    };
    if (argument == "--help") {
      fmt::print("{}", usage);
      return 0;
    }
    if (argument == "--quick")
      quick = true;
    else if (argument == "--group")
      group = value();
    else if (argument == "-o")
      folder = value();
    else
      throw input_error("stability", argument, "--quick, --group WORDS or -o FOLDER");
  }
  std::vector<Row> rows;
  int unexpected = 0;
  for (const StabilityCase& one : all_cases()) {
    if ((quick && !one.quick) || one.group.find(group) == std::string::npos) continue;
    rows.push_back({one, outcome_of(one)});
    fmt::print("{}", text_line(rows.back()));
    std::fflush(stdout);
    unexpected += !as_expected(one, rows.back().result);
  }
  fmt::print("{} cases, {} with another outcome than expected\n", rows.size(), unexpected);
  if (!folder.empty()) write_text_file(folder / "stability.csv", csv_text(rows));
  return unexpected == 0 ? 0 : 1;
}

}  // namespace
}  // namespace railtab::stability

int main(int argc, char** argv) {
  try {
    return railtab::stability::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "stability: {}\n", error.what());
    return 2;
  }
}
