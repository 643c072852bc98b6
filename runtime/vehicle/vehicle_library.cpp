#include "railtab/runtime/vehicle/vehicle_library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vehicle/vehicle_file.hpp"

namespace railtab {

std::vector<std::string> vehicle_names() {
  std::vector<std::string> names;
  for (const LibraryFile& file : library_files()) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

VehicleData library_vehicle(std::string_view name) {
  for (const LibraryFile& file : library_files()) {
    if (file.name == name) return parse_vehicle(std::string(file.text), fmt::format("library/{}.toml", name));
  }
  const std::vector<std::string> names = vehicle_names();
  throw input_error("vehicle", fmt::format("'{}'", name),
                    fmt::format("a file that ends with .toml, or one of {}", fmt::join(names, ", ")));
}

VehicleData find_vehicle(const std::string& name) {
  return name.ends_with(".toml") ? read_vehicle_file(name) : library_vehicle(name);
}

CoachParameters coach_parameters(std::string_view name) {
  const VehicleData data = library_vehicle(name);
  if (data.coach) return *data.coach;
  throw input_error("vehicle", fmt::format("'{}'", name), "a vehicle with template = \"two-bogie\"");
}

}  // namespace railtab
