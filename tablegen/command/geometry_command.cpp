#include <fmt/format.h>

#include "command_line.hpp"
#include "commands.hpp"
#include "geometry_request.hpp"
#include "progress_bar.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

void geometry_command(const std::vector<std::string>& arguments) {
  const CommandLine line("tablegen geometry --wheel P --rail P [options] -o FILE.h5", geometry_options(), {},
                         arguments);
  if (line.help_printed()) return;
  const GeometryRequest request = geometry_request(line);
  if (!line.quiet()) print_notes(request);
  ProgressBar bar("geometry table", !line.quiet());
  generate_geometry_table_file(request.search, request.options, provenance("geometry", arguments), request.file,
                               [&](double share) { bar.show(share); });
  if (line.quiet() && !line.json()) return;
  const GeometryTableData table = read_geometry_table(request.file);
  if (line.json()) {
    fmt::print("{}\n", table_description(table, request.file).dump(2));
  } else {
    fmt::print("{}", table_text(table, request.file));
  }
}

}  // namespace railtab
