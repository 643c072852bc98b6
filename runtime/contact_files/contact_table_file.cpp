#include "railtab/runtime/contact_files/contact_table_file.hpp"

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

}  // namespace railtab
