#include "railtab/runtime/vehicle/joint_file.hpp"

#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/runtime/vehicle/vehicle_sections.hpp"

namespace railtab {

VehicleData parse_joint(const std::string& text, const std::filesystem::path& place) {
  const toml::table table = parse_toml(text, place);
  check_toml_kind(table, place, TomlKind::vehicle);
  SourcedValues sourced;
  TomlSection root(place, "", table, {}, sourced);
  VehicleData data;
  data.place = place.string();
  data.text = text;
  data.is_joint = true;
  if (root.has("length")) {
    throw root.error("length", "a vehicle, which has one", "a joint: bodies, wheelsets, connections");
  }
  read_heading(root, data);
  read_further_bodies(root, data);
  if (std::optional<TomlSection> wheelset = root.find_section("wheelset")) read_wheelsets(*wheelset, data);
  read_connections(root, data);
  root.reject_others();
  data.sourced = std::move(sourced);
  return data;
}

VehicleData read_joint_file(const std::filesystem::path& file) {
  return parse_joint(read_toml_text(file, "a joint's TOML file"), file);
}

}  // namespace railtab
