#pragma once

#include <boost/program_options.hpp>
#include <string>
#include <vector>

#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// One subcommand's arguments, parsed: its own options and the ones that all share.
///
/// Flags must be written out in full, so that a new flag never changes what a script means.
class CommandLine {
 public:
  /// @param usage first line of the help, as "tablegen info FILE.h5 [--json]"
  /// @param own options of the subcommand
  /// @param positional names of options that stand without a flag, in order; "NAME..." takes all that are left
  /// @throws InputError naming the argument that is wrong.
  CommandLine(std::string usage, const boost::program_options::options_description& own,
              const std::vector<std::string>& positional, const std::vector<std::string>& arguments);

  /// Prints the help if --help was given, the version for --version. Call before required().
  [[nodiscard]] bool help_printed() const;

  [[nodiscard]] bool given(const std::string& name) const { return values_.count(name) > 0; }
  /// @throws InputError where the option is missing.
  [[nodiscard]] std::string required(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const { return values_[name].as<std::string>(); }
  /// All values of an option that may be given many times. @throws InputError where there is none.
  [[nodiscard]] std::vector<std::string> required_many(const std::string& name) const;
  /// Number of an option in SI units. @throws InputError naming the option, what was found and what was expected.
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] long long whole_number(const std::string& name, long long low, long long high) const;
  /// "LO:HI". @throws InputError
  [[nodiscard]] Interval interval(const std::string& name) const;
  /// "I/N" with 1 <= I <= N. @throws InputError
  [[nodiscard]] TableShard shard(const std::string& name) const;
  /// A slope as a fraction "1:40" or a number. @throws InputError
  [[nodiscard]] double slope(const std::string& name) const;

  [[nodiscard]] bool json() const { return given("json"); }
  [[nodiscard]] bool quiet() const { return given("quiet"); }

 private:
  std::string usage_;
  boost::program_options::options_description all_;
  boost::program_options::variables_map values_;
};

/// Where, when and by which command a table is made.
[[nodiscard]] TableProvenance provenance(const std::string& command, const std::vector<std::string>& arguments);

/// @throws InputError where the folder of an output file is not there, or the file is there and of none of these types.
void require_output(const std::string& output, std::initializer_list<std::string_view> filetypes);

/// A flag that takes a text, checked by CommandLine's functions where it is used.
[[nodiscard]] inline boost::program_options::typed_value<std::string>* text_value(const std::string& standard) {
  return boost::program_options::value<std::string>()->default_value(standard);
}

}  // namespace railtab
