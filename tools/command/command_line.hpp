#pragma once

#include <boost/program_options.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// "LO:HI"
struct NumberRange {
  double low = 0.0, high = 0.0;
};

/// "I/N", one of N parts, counted from 1.
struct PartOf {
  int index = 1, count = 1;
};

/// One subcommand's arguments, parsed: its own options and those that all commands have: --help, --version, --threads,
/// --quiet, --json and --json-usage. Flags must be written out in full, so that a new flag never changes what a script
/// means.
///
/// Options take texts; the functions below say what a text must be. Where one is wrong they throw InputError, which
/// names the option, what was found and what was expected.
class CommandLine {
 public:
  /// @param usage first line of the help, as "vsi report RESULTS.h5 -o REPORT.html"
  /// @param own options of the subcommand
  /// @param positional names of options that stand without a flag, in order; "NAME..." takes all that are left
  /// @throws InputError naming the argument that is wrong
  CommandLine(std::string usage, const boost::program_options::options_description& own,
              const std::vector<std::string>& positional, const std::vector<std::string>& arguments);

  /// Prints the help if --help was given, the version for --version, the options as JSON for --json-usage. Call before
  /// required().
  [[nodiscard]] bool help_printed() const;

  [[nodiscard]] bool given(const std::string& name) const { return values_.count(name) > 0; }
  /// Whether the arguments have the option: given() and no default.
  [[nodiscard]] bool chosen(const std::string& name) const { return given(name) && !values_[name].defaulted(); }
  /// @throws InputError where one of the options is chosen that are not allowed, with what is expected in its place
  void reject(std::initializer_list<const char*> options, std::string_view expected) const;
  /// @throws InputError where the option is missing
  [[nodiscard]] std::string required(const std::string& name) const;
  /// All values of an option that may be given many times. @throws InputError where there is none
  [[nodiscard]] std::vector<std::string> required_many(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const { return values_[name].as<std::string>(); }
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] long long whole_number(const std::string& name, long long low, long long high) const;
  [[nodiscard]] NumberRange range(const std::string& name) const;
  [[nodiscard]] PartOf part(const std::string& name) const;
  /// A slope as a fraction "1:40" or a number.
  [[nodiscard]] double slope(const std::string& name) const;

  /// --threads; none where all processors are to be used.
  [[nodiscard]] std::optional<int> threads() const { return threads_; }
  /// threads(), or the number of processors.
  [[nodiscard]] int workers() const;
  [[nodiscard]] bool json() const { return given("json"); }
  [[nodiscard]] bool quiet() const { return given("quiet"); }
  /// "vsi report: warning: …" on standard error, unless quiet.
  void warn(std::string_view warning) const;

 private:
  /// @throws InputError where the option is missing
  void require(const std::string& name) const;
  /// Usage, places without a flag and options as one JSON object.
  void print_interface() const;

  std::string usage_;
  std::vector<std::string> positional_;
  boost::program_options::options_description all_;
  std::size_t own_options_ = 0;  ///< the first of all_; those of all commands follow
  boost::program_options::variables_map values_;
  std::optional<int> threads_;
};

/// The whole text as a finite number.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// An option that takes a text, without and with a default.
[[nodiscard]] inline boost::program_options::typed_value<std::string>* text_value() {
  return boost::program_options::value<std::string>();
}
[[nodiscard]] inline boost::program_options::typed_value<std::string>* text_value(const std::string& standard) {
  return boost::program_options::value<std::string>()->default_value(standard);
}

}  // namespace railtab
