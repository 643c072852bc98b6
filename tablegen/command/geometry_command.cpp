#include <fmt/format.h>

#include "command_line.hpp"
#include "commands.hpp"
#include "geometry_request.hpp"
#include "progress_bar.hpp"
#include "railtab/tables/geometry_table_file.hpp"

namespace railtab {

void geometry_command(const std::vector<std::string>& arguments) {
  const CommandLine line("tablegen geometry --wheel P --rail P [options] -o FILE.h5", geometry_options(), {},
                         arguments);
  if (line.help_printed()) return;
  const GeometryRequest request = geometry_request(line);
  if (!line.quiet()) print_notes(request);
  ProgressBar bar("geometry table", !line.quiet());
  GeometryTableData table =
      generate_geometry_table(request.search, request.options, [&](double share) { bar.show(share); });
  table.provenance = provenance("geometry", arguments);
  write_geometry_table(request.file, table);
  if (line.json()) {
    fmt::print("{}\n", table_description(table, request.file).dump(2));
  } else if (!line.quiet()) {
    fmt::print("{}", table_text(table, request.file));
  }
}

}  // namespace railtab
