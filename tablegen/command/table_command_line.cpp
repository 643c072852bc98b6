#include "table_command_line.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <chrono>
#include <ctime>

#include "command/output_place.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {

TableCommandLine::TableCommandLine(std::string usage, const boost::program_options::options_description& own,
                                   const std::vector<std::string>& positional,
                                   const std::vector<std::string>& arguments)
    : CommandLine(std::move(usage), own, positional, arguments) {
  if (threads()) omp_set_num_threads(*threads());
}

Interval TableCommandLine::interval(const std::string& name) const {
  const NumberRange found = range(name);
  return {found.low, found.high};
}

TableShard TableCommandLine::shard(const std::string& name) const {
  const PartOf found = part(name);
  return {found.index, found.count};
}

TableProvenance provenance(const std::string& command, const std::vector<std::string>& arguments) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {version(), fmt::format("tablegen {} {}", command, fmt::join(arguments, " ")),
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))};
}

void require_output(const std::string& output, std::initializer_list<std::string_view> filetypes) {
  require_writable_place(output, "--output");
  require_replaceable(output, filetypes);
}

}  // namespace railtab
