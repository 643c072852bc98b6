#pragma once

#include <string>

namespace railtab {

/// What the offline side stored beside the numbers.
struct TableProvenance {
  std::string program_version;
  std::string command_line;
  std::string created;  ///< ISO 8601, UTC
};

/// One of `count` equal parts of a table, made by a job of its own; counted from 1.
struct TableShard {
  static constexpr int most = 100000;

  int index = 1;  ///< 1..count
  int count = 1;  ///< 1..most
  [[nodiscard]] bool whole() const noexcept { return count == 1; }
  [[nodiscard]] bool valid() const noexcept { return 1 <= index && index <= count && count <= most; }
  bool operator==(const TableShard&) const = default;
};

}  // namespace railtab
