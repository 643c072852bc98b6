#include "railtab/runtime/vehicle/coach.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/joined_groups.hpp"
#include "railtab/runtime/base/parameter_range.hpp"

namespace railtab {
namespace {

void check_inertia(const std::string& place, const BodyInertia& body) {
  require_positive(place + ".mass", body.mass, "kg");
  require_positive(place + ".Jx", body.Jx, "kg m²");
  require_positive(place + ".Jy", body.Jy, "kg m²");
  require_positive(place + ".Jz", body.Jz, "kg m²");
}

void check_unit(const std::string& place, const SuspensionUnit& unit) {
  require_not_negative(place + ".kx", unit.kx, "N/m");
  require_not_negative(place + ".ky", unit.ky, "N/m");
  require_positive(place + ".kz", unit.kz, "N/m");
  require_not_negative(place + ".cx", unit.cx, "N s/m");
  require_not_negative(place + ".cy", unit.cy, "N s/m");
  require_not_negative(place + ".cz", unit.cz, "N s/m");
  require_not_negative(place + ".series_kx", unit.series_kx, "N/m");
  require_not_negative(place + ".series_ky", unit.series_ky, "N/m");
  require_not_negative(place + ".series_kz", unit.series_kz, "N/m");
}

RigidBody make_body(std::string name, const BodyInertia& inertia, double x, double height) {
  return {std::move(name), inertia.mass, {inertia.Jx, inertia.Jy, inertia.Jz}, {x, 0.0, -height}};
}

Suspension make_unit(std::string name, int body_a, int body_b, const Eigen::Vector3d& point,
                     const SuspensionUnit& unit) {
  Suspension result{body_a, body_b, point, {unit.kx, unit.ky, unit.kz}, {unit.cx, unit.cy, unit.cz}};
  result.series_stiffness = {unit.series_kx, unit.series_ky, unit.series_kz};
  result.couple_share = unit.couple_share;
  result.name = std::move(name);
  result.nonlinear = unit.nonlinear;
  return result;
}

// Of each body the first of those that springs along x join it to.
std::vector<int> joined_along_x(const VehicleDescription& parts) {
  JoinedGroups groups(parts.bodies.size());
  for (const Suspension& unit : parts.suspension) {
    if (unit.stiffness.x() != 0.0) groups.join(unit.body_a, unit.body_b);
  }
  std::vector<int> first;
  for (std::size_t b = 0; b < parts.bodies.size(); ++b) first.push_back(groups.first(static_cast<int>(b)));
  return first;
}

}  // namespace

void CoachParameters::validate() const {
  check_inertia("vehicle.wheelset", wheelset);
  check_inertia("vehicle.bogie", bogie);
  check_inertia("vehicle.car_body", car_body);
  check_unit("vehicle.primary", primary);
  check_unit("vehicle.secondary", secondary);
  require_not_negative("vehicle.secondary_bending", secondary_bending, "N m/rad");
  require_not_negative("vehicle.roll_bar", roll_bar, "N m/rad");
  require_positive("vehicle.half_wheelbase", half_wheelbase, "m");
  require_positive("vehicle.half_bogie_distance", half_bogie_distance, "m");
  require_positive("vehicle.primary_half_distance", primary_half_distance, "m");
  require_positive("vehicle.secondary_half_distance", secondary_half_distance, "m");
  require_positive("vehicle.car_body_height", car_body_height, "m");
  require_positive("vehicle.secondary_height", secondary_height, "m");
  require_positive("vehicle.bogie_height", bogie_height, "m");
  require_positive("vehicle.nominal_radius", nominal_radius, "m");
  require_positive("vehicle.length", length, "m");
  require_between("vehicle.axles_per_bogie", axles_per_bogie, 2, 3, "");
  const double wheelset_reach = half_bogie_distance + half_wheelbase;
  if (half_wheelbase >= half_bogie_distance) {
    throw input_error("vehicle.half_wheelbase", fmt::format("{}", half_wheelbase),
                      fmt::format("less than half_bogie_distance = {} [m]", half_bogie_distance));
  }
  if (length <= 2 * wheelset_reach) {
    throw input_error("vehicle.length", fmt::format("{}", length),
                      fmt::format("more than the distance of the outer wheelsets, {} [m]", 2 * wheelset_reach));
  }
}

VehicleDescription describe_coach(const CoachParameters& p) {
  p.validate();
  constexpr int car = 0;
  VehicleDescription parts;
  parts.name = p.name;
  parts.nominal_radius = p.nominal_radius;
  parts.length = p.length;
  parts.bodies.push_back(make_body("car-body", p.car_body, 0.0, p.car_body_height));
  const double bogie_x[] = {p.half_bogie_distance, -p.half_bogie_distance};
  for (int b = 0; b < 2; ++b) {
    parts.bodies.push_back(make_body(fmt::format("bogie-{}", b + 1), p.bogie, bogie_x[b], p.bogie_height));
  }
  for (int w = 0; w < 2 * p.axles_per_bogie; ++w) {
    const int bogie = 1 + w / p.axles_per_bogie, axle = w % p.axles_per_bogie;
    const int wheelset = static_cast<int>(parts.bodies.size());
    const double offset = axle == 0 ? p.half_wheelbase : axle == p.axles_per_bogie - 1 ? -p.half_wheelbase : 0.0;
    const double x = bogie_x[bogie - 1] + offset;
    parts.bodies.push_back(make_body(fmt::format("wheelset-{}", w + 1), p.wheelset, x, p.nominal_radius));
    parts.wheelsets.push_back(wheelset);
    // at axle height, so that the wheelset's rotation about its axle is free of the springs
    for (const double y : {-p.primary_half_distance, p.primary_half_distance}) {
      parts.suspension.push_back(
          make_unit("primary suspension", wheelset, bogie, {x, y, -p.nominal_radius}, p.primary));
    }
  }
  for (int b = 0; b < 2; ++b) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d point{bogie_x[b], side * p.secondary_half_distance, -p.secondary_height};
      parts.suspension.push_back(make_unit("secondary suspension", 1 + b, car, point, p.secondary));
      parts.suspension.back().rotational_stiffness = {p.secondary_bending + 0.5 * p.roll_bar, p.secondary_bending, 0.0};
    }
  }
  return parts;
}

std::vector<DofIndices> held_motions(const VehicleDescription& parts, MotionPlane plane) {
  std::vector<DofIndices> dofs(parts.bodies.size(), DofIndices{0, 0, 0, 0, 0, 0});
  const std::vector<int> joined = joined_along_x(parts);
  std::vector<bool> is_held(dofs.size(), false);
  for (std::size_t b = 0; b < dofs.size(); ++b) {
    if (parts.bodies[b].name != "car-body" || is_held[static_cast<std::size_t>(joined[b])]) continue;
    dofs[b][0] = held;
    is_held[static_cast<std::size_t>(joined[b])] = true;
  }
  if (plane == MotionPlane::vertical) {
    for (DofIndices& dof : dofs) dof[1] = dof[3] = dof[5] = held;
    for (const int wheelset : parts.wheelsets) dofs[static_cast<std::size_t>(wheelset)][4] = held;
  }
  return dofs;
}

VehicleModel build_coach(const CoachParameters& parameters, MotionPlane plane, const VehicleWeight& weight) {
  VehicleDescription parts = describe_coach(parameters);
  parts.held_dofs = held_motions(parts, plane);
  parts.weight = weight;
  parts.force_elements = ForceElementChoice::linear;
  return assemble_vehicle(parts);
}

}  // namespace railtab
