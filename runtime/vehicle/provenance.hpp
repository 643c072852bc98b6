#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// How far a value of a vehicle can be trusted.
enum class Standing {
  verified,  ///< stands so in the source that is named
  assumed,   ///< chosen without a source
  suspect,   ///< another source contradicts it, or it is implausible
};
[[nodiscard]] constexpr std::string_view standing_name(Standing standing) noexcept {
  switch (standing) {
    case Standing::verified:
      return "verified";
    case Standing::suspect:
      return "suspect";
    case Standing::assumed:
      break;
  }
  return "assumed";
}

/// Where a value comes from.
struct Provenance {
  std::string source;  ///< publication or program; empty: not stated
  std::string date;    ///< of the source, as written; empty: not stated
  Standing standing = Standing::assumed;
  std::string note;  ///< why it is suspect, what was assumed
};

/// A number of a vehicle file.
struct SourcedValue {
  std::string key;   ///< "primary.kz", "connection[2].cx"
  std::string unit;  ///< SI, besides km/h of the top speed
  double value;
  Provenance provenance;
};

/// All numbers of a file in the order in which they are read, and what holds for each of its sections.
struct SourcedValues {
  std::vector<SourcedValue> values;
  std::map<std::string, Provenance> sections;
};

}  // namespace railtab
