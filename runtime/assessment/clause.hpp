#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab {

/// A limit in the measure's unit: constant + factor · quantity^exponent, at most `at_most`; quantities are those that a
/// measured value carries (MeasuredValue::quantities).
struct ClauseLimit {
  double constant = 0.0, factor = 0.0, exponent = 1.0;
  std::string of;  ///< empty: the constant alone
  std::optional<double> at_most;
  bool lower = false;  ///< the value must be at least the limit, not at most
};

/// Where the number of a limit was read.
enum class ReadIn {
  nothing,           ///< unverified: it is still to be read
  secondary_source,  ///< in what another program or publication says of the standard
  standard,          ///< in the standard itself, or in a national annex that makes it normative
};
[[nodiscard]] std::string_view read_in_name(ReadIn read_in) noexcept;  ///< "nothing", "secondary source", "standard"

/// A requirement of a standard, or one that a user adds.
struct Clause {
  std::string id;       ///< unique; a later file's replaces an earlier one's
  std::string edition;  ///< "EN 1990:2002/A1:2005"
  std::string clause;   ///< its number there
  std::string title;
  std::string measure;  ///< a name of measure_kinds()
  std::string unit;
  ClauseLimit limit;
  std::string consequence;  ///< what follows where the limit is not met, if that is no failure; empty: a failure
  std::string source;       ///< what was read, or why nothing was
  std::string note;
  ReadIn read_in = ReadIn::nothing;
  /// Its number was read in the standard.
  [[nodiscard]] bool verified() const noexcept { return read_in == ReadIn::standard; }

  // Applies where all of these hold that are there:
  std::string rules;                                ///< whose they are: "Europe", "China", …
  std::string track;                                ///< "ballasted" or "direct"
  std::optional<std::array<double, 2>> line_speed;  ///< above the first, up to the second [km/h]
  std::optional<std::array<double, 2>> span;        ///< likewise [m]
};

/// The clauses that come with railtab (runtime/assessment/library).
[[nodiscard]] std::vector<Clause> library_clauses();

/// Those and the clauses of files, each file's before the next; a clause with the id of an earlier one replaces it.
/// @throws InputError with file and line
[[nodiscard]] std::vector<Clause> clauses_with(const std::vector<std::filesystem::path>& files);

/// The library as it is compiled in: names of files without ".toml", and texts.
[[nodiscard]] const std::vector<LibraryFile>& clause_library_files();

}  // namespace railtab
