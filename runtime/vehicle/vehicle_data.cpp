#include "railtab/runtime/vehicle/vehicle_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"

namespace railtab {

namespace {

// A vehicle that stands on its joints states its mass alone.
std::vector<ClosingCheck> checks_of_mass(const VehicleData& data) {
  double mass = 0.0;
  for (const RigidBody& body : data.parts.bodies) mass += body.mass;
  std::vector<ClosingCheck> checks;
  for (const StatedCheck& stated : data.checks) checks.push_back({stated, mass});
  return checks;
}

}  // namespace

VehicleModel build_vehicle(const VehicleData& data, MotionPlane plane, const VehicleWeight& weight,
                           ForceElementChoice choice) {
  const bool vertical_data = data.motion == MotionPlane::vertical;
  if (vertical_data && plane != MotionPlane::vertical) {
    throw input_error(fmt::format("{}: motion", data.place), "\"vertical\", and a model with lateral motion",
                      "a vertical model, or a file with the lateral values too");
  }
  if (data.stands_on_joints) {
    throw input_error(data.place, fmt::format("{} by itself, which stands on bogies of its joints", data.name),
                      "a train with its neighbours (train.consist)");
  }
  VehicleDescription parts = data.parts;
  parts.weight = weight;
  parts.force_elements = choice;
  parts.held_dofs = held_motions(parts, plane);
  if (vertical_data) {
    for (DofIndices& dof : parts.held_dofs) dof[0] = held;
  }
  VehicleModel vehicle = in_file(data.place, [&parts] { return assemble_vehicle(parts); });
  vehicle.top_speed = data.top_speed;
  const bool linear = choice == ForceElementChoice::linear;
  vehicle.linearised = linear ? data.linearised : data.stand_ins;
  if (linear) {
    vehicle.left_out = data.left_out;
  } else {
    vehicle.nonlinear = data.nonlinear;
  }
  return vehicle;
}

std::vector<ClosingCheck> closing_checks(const VehicleData& data) {
  if (data.checks.empty()) return {};
  if (data.stands_on_joints) return checks_of_mass(data);
  const VehicleModel vehicle = build_vehicle(data, data.motion);
  const VehicleSummary summary = summarise(vehicle, 0);
  const std::vector<VehicleMode> modes = natural_modes(vehicle, vehicle.dofs());
  std::vector<ClosingCheck> checks;
  for (const StatedCheck& stated : data.checks) {
    ClosingCheck& check = checks.emplace_back(ClosingCheck{stated, std::nullopt});
    if (stated.quantity == "mass") {
      check.found = summary.mass;
      continue;
    }
    for (std::size_t w = 0; w < summary.wheel_load.size(); ++w) {
      if (stated.quantity == fmt::format("axle load of wheelset-{}", w + 1)) {
        check.found = 2.0 * summary.wheel_load[w] / vehicle.gravity;
      }
    }
    if (check.found) continue;
    const auto mode = std::find_if(modes.begin(), modes.end(), [&](const VehicleMode& m) {
      return m.motion.starts_with(stated.quantity) && m.damping < 1.0;
    });
    if (mode != modes.end()) check.found = mode->frequency;
  }
  return checks;
}

void require_closing(const VehicleData& data) {
  for (const ClosingCheck& check : closing_checks(data)) {
    if (check.holds()) continue;
    throw input_error(
        fmt::format("{}: check: {}", data.place, check.stated.quantity),
        check.found ? fmt::format("{:.6g} {} by the file's own values", *check.found, check.stated.unit)
                    : std::string("no such motion"),
        fmt::format("{:.6g} to {:.6g} {}, as [check] states", check.stated.low, check.stated.high, check.stated.unit));
  }
}

}  // namespace railtab
