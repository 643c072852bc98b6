#include "railtab/runtime/vehicle/coach.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"

namespace railtab {
namespace {

/// High-speed car of an open vehicle–track program; sources and choices in docs/theory/vehicle.md.
CoachParameters chinese_high_speed_car() {
  CoachParameters car;
  car.name = "chinese-high-speed-car";
  car.wheelset = {1400.0, 915.0, 140.0, 915.0};
  car.bogie = {3000.0, 2260.0, 2710.0, 3160.0};
  car.car_body = {34000.0, 75060.0, 2.277e6, 2.086e6};
  car.primary = {10e6, 5e6, 0.55e6, 0.0, 0.0, 6e3};
  car.secondary = {0.15e6, 0.15e6, 0.40e6, 0.0, 60e3, 80e3};
  car.secondary_bending = 0.0;
  car.roll_bar = 0.0;
  car.half_wheelbase = 1.2;
  car.half_bogie_distance = 9.0;
  car.primary_half_distance = 0.978;
  car.secondary_half_distance = 0.978;
  car.nominal_radius = 0.4575;
  car.bogie_height = car.nominal_radius + 0.14;
  car.secondary_height = car.bogie_height - 0.081;
  car.car_body_height = car.secondary_height + 1.415;
  car.length = 25.0;
  return car;
}

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
}

RigidBody make_body(std::string name, const BodyInertia& inertia, double x, double height) {
  return {std::move(name), inertia.mass, {inertia.Jx, inertia.Jy, inertia.Jz}, {x, 0.0, -height}};
}

Suspension make_unit(int body_a, int body_b, const Eigen::Vector3d& point, const SuspensionUnit& unit) {
  return {body_a, body_b, point, {unit.kx, unit.ky, unit.kz}, {unit.cx, unit.cy, unit.cz}};
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

std::vector<std::string> vehicle_names() { return {CoachParameters{}.name, chinese_high_speed_car().name}; }

CoachParameters coach_parameters(std::string_view name) {
  for (CoachParameters coach : {CoachParameters{}, chinese_high_speed_car()}) {
    if (coach.name == name) return coach;
  }
  throw input_error("vehicle", fmt::format("'{}'", name), fmt::format("one of {}", fmt::join(vehicle_names(), ", ")));
}

VehicleModel build_coach(const CoachParameters& p, MotionPlane plane, const VehicleWeight& weight) {
  p.validate();
  constexpr int car = 0;
  std::vector<RigidBody> bodies{make_body("car-body", p.car_body, 0.0, p.car_body_height)};
  const double bogie_x[] = {p.half_bogie_distance, -p.half_bogie_distance};
  for (int b = 0; b < 2; ++b) {
    bodies.push_back(make_body(fmt::format("bogie-{}", b + 1), p.bogie, bogie_x[b], p.bogie_height));
  }
  std::vector<Suspension> suspension;
  std::vector<int> wheelsets;
  for (int w = 0; w < 4; ++w) {
    const int bogie = 1 + w / 2;
    const int wheelset = static_cast<int>(bodies.size());
    const double x = bogie_x[w / 2] + (w % 2 == 0 ? p.half_wheelbase : -p.half_wheelbase);
    bodies.push_back(make_body(fmt::format("wheelset-{}", w + 1), p.wheelset, x, p.nominal_radius));
    wheelsets.push_back(wheelset);
    // at axle height, so that the wheelset's rotation about its axle is free of the springs
    for (const double y : {-p.primary_half_distance, p.primary_half_distance}) {
      suspension.push_back(make_unit(wheelset, bogie, {x, y, -p.nominal_radius}, p.primary));
    }
  }
  for (int b = 0; b < 2; ++b) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d point{bogie_x[b], side * p.secondary_half_distance, -p.secondary_height};
      suspension.push_back(make_unit(1 + b, car, point, p.secondary));
      suspension.back().rotational_stiffness = {p.secondary_bending + 0.5 * p.roll_bar, p.secondary_bending, 0.0};
    }
  }
  std::vector<DofIndices> dofs(bodies.size(), DofIndices{0, 0, 0, 0, 0, 0});
  dofs[car][0] = held;
  if (plane == MotionPlane::vertical) {
    for (DofIndices& dof : dofs) dof[1] = dof[3] = dof[5] = held;
    for (const int wheelset : wheelsets) dofs[static_cast<size_t>(wheelset)][4] = held;
  }
  return assemble_vehicle({p.name, bodies, suspension, std::move(wheelsets), dofs, p.nominal_radius, p.length, weight});
}

}  // namespace railtab
