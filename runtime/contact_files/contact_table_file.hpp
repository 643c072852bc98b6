#pragma once

#include <filesystem>
#include <string>

#include "railtab/runtime/contact/contact_geometry.hpp"

namespace railtab {

/// A geometry table from its file, for patches, and as what forces come from: with the loaded part where the file has
/// one that is certified well enough (largest_certified_force_error).
struct ContactTable {
  TableContact patches;
  ContactGeometry geometry;
};

/// @throws InputError as read_geometry_table() and TableContact, naming the file
[[nodiscard]] ContactTable read_contact_table(const std::filesystem::path& file);

/// Why the loaded part of a geometry's table is not used, for warnings; empty where there is none or it is used.
[[nodiscard]] std::string unused_loaded_part(const ContactGeometry& geometry);

}  // namespace railtab
