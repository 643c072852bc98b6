#include "railtab/runtime/vehicle/joint_file.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/runtime/vehicle/vehicle_sections.hpp"

namespace railtab {

VehicleData parse_joint(const std::string& text, const std::filesystem::path& place) {
  check_toml_bounds(text, place);
  try {
    const toml::table table = toml::parse(text, place.string());
    SourcedValues sourced;
    TomlSection root(place, "", table, {}, sourced);
    VehicleData data;
    data.place = place.string();
    data.text = text;
    data.is_joint = true;
    read_heading(root, data);
    read_further_bodies(root, data);
    if (std::optional<TomlSection> wheelset = root.find_section("wheelset")) read_wheelsets(*wheelset, data);
    read_connections(root, data);
    root.reject_others();
    data.sourced = std::move(sourced);
    return data;
  } catch (const toml::parse_error& wrong) {
    throw InputError(fmt::format("{}:{}: {}", place.string(), wrong.source().begin.line, wrong.description()));
  }
}

VehicleData read_joint_file(const std::filesystem::path& file) {
  return parse_joint(read_toml_text(file, "a joint's TOML file"), file);
}

}  // namespace railtab
