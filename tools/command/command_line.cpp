#include "command/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <thread>

#include "command/json_text.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/base/version.hpp"

namespace railtab {

namespace po = boost::program_options;

namespace {

/// Both numbers around a separator.
struct Pair {
  double first = 0.0, second = 0.0;
};

std::optional<Pair> parse_pair(std::string_view text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  const std::optional<double> first = parse_number(text.substr(0, at)), second = parse_number(text.substr(at + 1));
  if (!first || !second) return std::nullopt;
  return Pair{*first, *second};
}

bool is_whole(double value) { return value == std::floor(value); }

/// "o" of "-o [ --output ]", which is all that Boost says of it; none of "--plan".
std::string short_name(const po::option_description& option) {
  const std::string names = option.format_name();
  return names[1] == '-' ? "" : names.substr(1, 1);
}

/// What the usage calls an argument: "SCENE.toml" where it stands without an option, "-o DIR", "--rail P".
InputError missing(const po::option_description& option, bool positional, const std::string& usage) {
  const std::string letter = short_name(option);
  const std::string flag = letter.empty() ? "--" + option.long_name() : "-" + letter;
  return InputError(
      fmt::format("found no {}{}\nusage: {}", positional ? "" : flag + " ", option.format_parameter(), usage));
}

/// Boost writes a default behind the value's name: "N (=40)".
nlohmann::ordered_json option_json(const po::option_description& option) {
  nlohmann::ordered_json json{{"name", option.long_name()}};
  if (const std::string letter = short_name(option); !letter.empty()) json["short"] = letter;
  if (option.semantic()->max_tokens() > 0) {
    const std::string parameter = option.format_parameter();
    json["value"] = parameter.substr(0, parameter.find(" (="));
  }
  if (boost::any standard; option.semantic()->apply_default(standard)) {
    json["default"] = boost::any_cast<std::string>(standard);
  }
  json["description"] = option.description();
  return json;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  return parse(text, value) ? std::optional(value) : std::nullopt;
}

CommandLine::CommandLine(std::string usage, const po::options_description& own,
                         const std::vector<std::string>& positional, const std::vector<std::string>& arguments)
    : usage_(std::move(usage)), positional_(positional), own_options_(own.options().size()) {
  po::options_description shared("All commands");
  shared.add_options()("help,h", "print this help")                                                                  //
      ("version", "print the version")                                                                               //
      ("threads", text_value("0")->value_name("N"), "threads of commands that share their work, 0: all processors")  //
      ("quiet,q", "no progress bar, notes, warnings and summaries")                                                  //
      ("json", "print one JSON object on stdout")                                                                    //
      ("json-usage", "print this help as JSON");
  all_.add(own).add(shared);
  po::positional_options_description places;
  for (const std::string& name : positional) {
    const bool all_left = name.ends_with("...");
    places.add(name.substr(0, name.size() - (all_left ? 3 : 0)).c_str(), all_left ? -1 : 1);
  }
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  try {
    po::store(po::command_line_parser(arguments).options(all_).positional(places).style(style).run(), values_);
  } catch (const po::error& wrong) {
    throw InputError(fmt::format("{}\nusage: {}", wrong.what(), usage_));
  }
  constexpr int most_threads = 4096;
  if (const auto threads = static_cast<int>(whole_number("threads", 0, most_threads)); threads > 0) threads_ = threads;
}

void CommandLine::warn(std::string_view warning) const {
  if (quiet()) return;
  const std::string command = usage_.substr(0, usage_.find(' ', usage_.find(' ') + 1));
  print_message(fmt::format("{}: warning: {}\n", command, warning));
}

bool CommandLine::help_printed() const {
  if (given("help")) {
    std::ostringstream text;
    text << all_;
    print_text(fmt::format("Usage: {}\n{}", usage_, text.str()));
    return true;
  }
  if (given("version")) print_text(fmt::format("railtab {}\n", version()));
  if (given("json-usage")) print_interface();
  return given("version") || given("json-usage");
}

void CommandLine::print_interface() const {
  nlohmann::ordered_json json{{"usage", usage_},
                              {"positional", positional_},
                              {"options", nlohmann::json::array()},
                              {"shared_options", nlohmann::json::array()}};
  for (std::size_t i = 0; i < all_.options().size(); ++i) {
    json[i < own_options_ ? "options" : "shared_options"].push_back(option_json(*all_.options()[i]));
  }
  print_json(json);
}

void CommandLine::require(const std::string& name) const {
  if (given(name)) return;
  const bool positional = std::any_of(positional_.begin(), positional_.end(),
                                      [&](const std::string& place) { return place == name || place == name + "..."; });
  throw missing(all_.find(name, false), positional, usage_);
}

void CommandLine::reject(std::initializer_list<const char*> options, std::string_view expected) const {
  for (const char* option : options) {
    if (chosen(option)) throw input_error(fmt::format("--{}", option), text(option), expected);
  }
}

std::string CommandLine::required(const std::string& name) const {
  require(name);
  return text(name);
}

std::vector<std::string> CommandLine::required_many(const std::string& name) const {
  require(name);
  return values_[name].as<std::vector<std::string>>();
}

double CommandLine::number(const std::string& name) const {
  const std::optional<double> value = parse_number(text(name));
  if (!value) throw input_error("--" + name, fmt::format("\"{}\"", text(name)), "a number");
  return *value;
}

long long CommandLine::whole_number(const std::string& name, long long low, long long high) const {
  const double value = number(name);
  if (!is_whole(value) || value < static_cast<double>(low) || value > static_cast<double>(high)) {
    throw input_error("--" + name, text(name), fmt::format("a whole number in {}..{}", low, high));
  }
  return static_cast<long long>(value);
}

NumberRange CommandLine::range(const std::string& name) const {
  const std::optional<Pair> ends = parse_pair(text(name), ':');
  if (ends && ends->first <= ends->second) return {ends->first, ends->second};
  throw input_error("--" + name, fmt::format("\"{}\"", text(name)),
                    "LO:HI, two numbers in SI units with LO not above HI");
}

PartOf CommandLine::part(const std::string& name) const {
  constexpr double most = 100000;
  const std::optional<Pair> part = parse_pair(text(name), '/');
  if (part && is_whole(part->first) && is_whole(part->second) && part->first >= 1 && part->first <= part->second &&
      part->second <= most) {
    return {static_cast<int>(part->first), static_cast<int>(part->second)};
  }
  throw input_error("--" + name, fmt::format("\"{}\"", text(name)),
                    fmt::format("I/N, whole numbers with 1 <= I <= N <= {}", most));
}

double CommandLine::slope(const std::string& name) const {
  if (const std::optional<double> value = parse_number(text(name))) return *value;
  const std::optional<Pair> fraction = parse_pair(text(name), ':');
  if (fraction && fraction->second != 0.0) return fraction->first / fraction->second;
  throw input_error("--" + name, fmt::format("\"{}\"", text(name)), "a slope such as 1:40 or 0.025");
}

int CommandLine::workers() const {
  return threads_.value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

}  // namespace railtab
