#include "command_line.hpp"

#include <unistd.h>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {

namespace po = boost::program_options;

namespace {

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

CommandLine::CommandLine(std::string usage, const po::options_description& own,
                         const std::vector<std::string>& positional, const std::vector<std::string>& arguments)
    : usage_(std::move(usage)) {
  po::options_description shared("All commands");
  shared.add_options()("help,h", "print this help")                                              //
      ("version", "print the version")                                                           //
      ("threads", po::value<std::string>()->value_name("N"), "threads to use (all processors)")  //
      ("quiet,q", "no progress bar and no text on success")                                      //
      ("json", "print one JSON object on stdout");
  all_.add(own).add(shared);
  po::positional_options_description places;
  for (const std::string& name : positional) {
    const bool all_left = name.ends_with("...");
    places.add(name.substr(0, name.size() - (all_left ? 3 : 0)).c_str(), all_left ? -1 : 1);
  }
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  try {
    po::store(po::command_line_parser(arguments).options(all_).positional(places).style(style).run(), values_);
  } catch (const po::error& e) {
    throw InputError(fmt::format("{}; see --help", e.what()));
  }
  if (given("threads")) omp_set_num_threads(static_cast<int>(whole_number("threads", 1, 4096)));
}

bool CommandLine::help_printed() const {
  if (given("version")) {
    fmt::print("railtab {}\n", RAILTAB_VERSION);
    return true;
  }
  if (!given("help")) return false;
  std::cout << "Usage: " << usage_ << "\n\n" << all_;
  return true;
}

std::string CommandLine::required(const std::string& name) const {
  if (!given(name)) throw InputError(fmt::format("{} is missing; usage: {}", name, usage_));
  return text(name);
}

std::vector<std::string> CommandLine::required_many(const std::string& name) const {
  if (!given(name)) throw InputError(fmt::format("{} is missing; usage: {}", name, usage_));
  return values_[name].as<std::vector<std::string>>();
}

double CommandLine::number(const std::string& name) const {
  const std::optional<double> value = parse_number(text(name));
  if (!value) throw input_error("--" + name, fmt::format("\"{}\"", text(name)), "a number");
  return *value;
}

long long CommandLine::whole_number(const std::string& name, long long low, long long high) const {
  const double value = number(name);
  if (value != std::floor(value) || value < static_cast<double>(low) || value > static_cast<double>(high)) {
    throw input_error("--" + name, text(name), fmt::format("a whole number in {}..{}", low, high));
  }
  return static_cast<long long>(value);
}

Interval CommandLine::interval(const std::string& name) const {
  const std::string found = text(name);
  const std::size_t colon = found.find(':');
  if (colon != std::string::npos) {
    const std::string_view view = found;
    const std::optional<double> low = parse_number(view.substr(0, colon));
    const std::optional<double> high = parse_number(view.substr(colon + 1));
    if (low && high && *low <= *high) return {*low, *high};
  }
  throw input_error("--" + name, fmt::format("\"{}\"", found), "LO:HI, two numbers in SI units with LO not above HI");
}

TableShard CommandLine::shard(const std::string& name) const {
  const std::string found = text(name);
  const std::size_t stroke = found.find('/');
  if (stroke != std::string::npos) {
    const std::string_view view = found;
    const std::optional<double> index = parse_number(view.substr(0, stroke));
    const std::optional<double> count = parse_number(view.substr(stroke + 1));
    if (index && count && *index == std::floor(*index) && *count == std::floor(*count) && *count <= 1e5 &&
        *index >= 1 && *index <= *count) {
      return {static_cast<int>(*index), static_cast<int>(*count)};
    }
  }
  throw input_error("--" + name, fmt::format("\"{}\"", found), "I/N, whole numbers with 1 <= I <= N <= 100000");
}

double CommandLine::slope(const std::string& name) const {
  const std::string found = text(name);
  const std::size_t colon = found.find(':');
  const std::string_view view = found;
  if (colon == std::string::npos) {
    if (const std::optional<double> value = parse_number(view)) return *value;
  } else {
    const std::optional<double> rise = parse_number(view.substr(0, colon));
    const std::optional<double> run = parse_number(view.substr(colon + 1));
    if (rise && run && *run != 0) return *rise / *run;
  }
  throw input_error("--" + name, fmt::format("\"{}\"", found), "a slope such as 1:40 or 0.025");
}

TableProvenance provenance(const std::string& command, const std::vector<std::string>& arguments) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {RAILTAB_VERSION, fmt::format("tablegen {} {}", command, fmt::join(arguments, " ")),
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))};
}

void require_output(const std::string& output, std::initializer_list<std::string_view> filetypes) {
  const std::filesystem::path folder = std::filesystem::absolute(output).parent_path();
  std::error_code refused;
  if (!std::filesystem::is_directory(folder, refused)) {
    throw input_error("--output " + output, "no folder " + folder.string(), "a file in an existing folder");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw input_error("--output " + output, "no right to write in " + folder.string(), "a folder that can be written");
  }
  if (std::filesystem::is_directory(output, refused)) throw input_error("--output " + output, "a folder", "a file");
  if (refused && refused != std::errc::no_such_file_or_directory) {
    throw input_error("--output " + output, refused.message(), "a name that a file can have");
  }
  require_replaceable(output, filetypes);
}

}  // namespace railtab
