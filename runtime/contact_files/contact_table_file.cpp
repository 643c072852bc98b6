#include "railtab/runtime/contact_files/contact_table_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

ContactTable read_contact_table(const std::filesystem::path& file) {
  GeometryTableData data = read_geometry_table(file);
  std::shared_ptr<const LoadedTable> loaded;
  double unused_error = 0.0;
  if (data.loaded && data.loaded->certified_force_error() > largest_certified_force_error) {
    unused_error = data.loaded->certified_force_error();
  } else if (data.loaded) {
    loaded = std::make_shared<const LoadedTable>(std::move(*data.loaded));
  }
  data.loaded.reset();
  TableContact patches = in_file(file.string(), [&] { return TableContact(GeometryTable(std::move(data))); });
  ContactGeometry geometry(patches, std::move(loaded), unused_error);
  return {std::move(patches), std::move(geometry)};
}

std::string unused_loaded_part(const ContactGeometry& geometry) {
  if (geometry.unused_loaded_error() == 0.0) return {};
  return fmt::format(
      "the loaded part of the table of {} on {} is off by {:.2g} % of the force (99 % of its check), more than {:.0f} "
      "%, and is not used: forces are those of an ellipse per patch",
      geometry.pair().wheel().knots().name, geometry.pair().rail().knots().name, 100.0 * geometry.unused_loaded_error(),
      100.0 * largest_certified_force_error);
}

}  // namespace railtab
