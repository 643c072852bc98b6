#include <fmt/format.h>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "geometry_request.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "table_command_line.hpp"

namespace railtab {

void geometry_command(const std::vector<std::string>& arguments) {
  const TableCommandLine line("tablegen geometry --wheel P --rail P [options] -o FILE.h5", geometry_options(), {},
                              arguments);
  if (line.help_printed()) return;
  require_options_of_profiles(line);
  const GeometryRequest request = geometry_request(line);
  if (!line.quiet()) {
    print_notes("geometry", request.search.pair());
    print_effect_of_smoothing(line, request.search.pair());
  }
  ProgressBar bar("geometry table", !line.quiet());
  generate_geometry_table_file(request.search, request.options, provenance("geometry", arguments), request.file,
                               [&](double share) { bar.show(share); });
  if (line.quiet() && !line.json()) return;
  const GeometryTableData table = read_geometry_table(request.file);
  if (line.json()) {
    print_json(table_description(table, request.file));
  } else {
    print_formatted("{}", table_text(table, request.file));
  }
}

}  // namespace railtab
