#include "railtab/runtime/vehicle/vehicle_file.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/vehicle/series_damper.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/runtime/vehicle/vehicle_import.hpp"
#include "railtab/runtime/vehicle/vehicle_sections.hpp"

namespace railtab {

namespace {

// How a vehicle on joints loads its wheelsets and moves depends on its neighbours.
void require_own_check(TomlSection& check, const VehicleData& data, std::string_view key) {
  if (!data.stands_on_joints) return;
  throw check.error(key, "a check of a vehicle that stands on joints",
                    "mass alone: the rest depends on its neighbours");
}

void state_masses(TomlSection& check, VehicleData& data) {
  const double tolerance = check.number("tolerance", ratio_kind, 0.005);
  const auto state = [&](std::string quantity, double value) {
    data.checks.push_back({std::move(quantity), "kg", value * (1.0 - tolerance), value * (1.0 + tolerance)});
  };
  if (check.has("mass")) state("mass", check.number("mass", mass_kind));
  if (!check.has("axle_load")) return;
  require_own_check(check, data, "axle_load");
  const std::vector<double> loads = check.numbers("axle_load", mass_kind);
  const std::size_t wheelsets = data.parts.wheelsets.size();
  if (loads.size() != 1 && loads.size() != wheelsets) {
    throw check.error("axle_load", fmt::format("{} axle loads", loads.size()),
                      fmt::format("one for all or {}, from the front [kg]", wheelsets));
  }
  for (std::size_t w = 0; w < wheelsets; ++w) {
    state(fmt::format("axle load of wheelset-{}", w + 1), loads[loads.size() == 1 ? 0 : w]);
  }
}

void read_checks(TomlSection& root, VehicleData& data) {
  std::optional<TomlSection> check = root.find_section("check");
  if (!check) return;
  state_masses(*check, data);
  constexpr std::pair<std::string_view, std::string_view> motions[] = {
      {"bounce", "car body bounce"},         {"pitch", "car body pitch"},           {"yaw", "car body yaw"},
      {"lower_sway", "car body lower sway"}, {"upper_sway", "car body upper sway"}, {"bogie_bounce", "bogie bounce"}};
  for (const auto& [key, motion] : motions) {
    if (!check->has(key)) continue;
    require_own_check(*check, data, key);
    const auto [low, high] = check->interval(key, frequency_kind);
    data.checks.push_back({std::string(motion), "Hz", low, high});
  }
  check->reject_others();
}

void check_length(const TomlSection& root, const VehicleData& data) {
  const VehicleDescription& parts = data.parts;
  if (parts.wheelsets.empty()) return;
  const auto x = [&](int body) { return parts.bodies[static_cast<std::size_t>(body)].position.x(); };
  const double reach = x(parts.wheelsets.front()) - x(parts.wheelsets.back());
  if (parts.length > reach) return;
  throw root.error("length", fmt::format("{} m", parts.length),
                   fmt::format("more than the distance of the outer wheelsets, {:.6g} m", reach));
}

void check_size(const TomlSection& root, const VehicleData& data) {
  const std::size_t rows =
      6 * data.parts.bodies.size() + static_cast<std::size_t>(count_series_dampers(data.parts.suspension));
  if (rows <= static_cast<std::size_t>(most_vehicle_rows)) return;
  throw root.error("name", fmt::format("a vehicle of {} degrees of freedom", rows),
                   fmt::format("at most {}", most_vehicle_rows));
}

// Files relative to the vehicle's.
void read_joints(TomlSection& root, const std::filesystem::path& place, VehicleData& data) {
  const auto read = [&](std::string_view key, std::filesystem::path& joint) {
    if (!root.has(key)) return;
    joint = place.parent_path() / root.text(key);
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(joint, unreadable)) return;
    throw root.error(key, fmt::format("no file {}", joint.string()), "a joint's TOML file, relative to the vehicle's");
  };
  read("joint_front", data.joint_front);
  read("joint_rear", data.joint_rear);
  data.stands_on_joints = root.flag("stands_on_joints");
  if (data.stands_on_joints && data.joint_front.empty() && data.joint_rear.empty()) {
    throw root.error("stands_on_joints", "true without joints", "joint_front, joint_rear or both");
  }
}

VehicleData read_root(TomlSection& root, const std::string& text, const std::filesystem::path& place) {
  VehicleData data;
  data.place = place.string();
  data.text = text;
  read_heading(root, data);
  read_joints(root, place, data);
  if (!root.has("length")) {
    throw root.error("length", "nothing", "a length [m]; a file without one is a joint, for joint_front or joint_rear");
  }
  data.parts.length = root.number("length", distance_kind);
  data.top_speed = root.number("top_speed_kmh", speed_kind, 0.0) / 3.6;
  if (root.has("template")) {
    static_cast<void>(root.text_of("template", {"two-bogie"}));
    read_two_bogie(root, data);
  } else {
    read_bodies(root, data);
  }
  read_connections(root, data);
  read_checks(root, data);
  root.reject_others();
  check_length(root, data);
  check_size(root, data);
  return data;
}

}  // namespace

VehicleData parse_vehicle(const std::string& text, const std::filesystem::path& place) {
  const toml::table table = parse_toml(text, place);
  check_toml_kind(table, place, TomlKind::vehicle);
  SourcedValues sourced;
  TomlSection root(place, "", table, {}, sourced);
  VehicleData data = read_root(root, text, place);
  data.sourced = std::move(sourced);
  return data;
}

VehicleData read_vehicle_file(const std::filesystem::path& file) {
  return parse_vehicle(read_toml_text(file, "a vehicle's TOML file"), file);
}

}  // namespace railtab
