#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "command/command_line.hpp"
#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// The arguments of a tablegen command; --threads holds for all that it computes.
class TableCommandLine : public CommandLine {
 public:
  /// See CommandLine.
  TableCommandLine(std::string usage, const boost::program_options::options_description& own,
                   const std::vector<std::string>& positional, const std::vector<std::string>& arguments);

  /// "LO:HI". @throws InputError
  [[nodiscard]] Interval interval(const std::string& name) const;
  /// "I/N" with 1 <= I <= N. @throws InputError
  [[nodiscard]] TableShard shard(const std::string& name) const;
};

/// Where, when and by which command a table is made.
[[nodiscard]] TableProvenance provenance(const std::string& command, const std::vector<std::string>& arguments);

/// @throws InputError where the folder of an output file is not there, or the file is there and of none of these types.
void require_output(const std::string& output, std::initializer_list<std::string_view> filetypes);

}  // namespace railtab
