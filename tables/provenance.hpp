#pragma once

#include <string>

namespace railtab {

/// What the offline side stored beside the numbers.
struct TableProvenance {
  std::string program_version;
  std::string command_line;
  std::string created;  ///< ISO 8601, UTC
};

}  // namespace railtab
