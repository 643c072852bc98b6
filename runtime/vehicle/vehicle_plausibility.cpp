#include "railtab/runtime/vehicle/vehicle_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/vehicle/vehicle_terms.hpp"

namespace railtab {

namespace {

Eigen::VectorXd rest_under_weight(const VehicleModel& vehicle) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(vehicle.dofs());
  for (const DofIndices& dof : vehicle.dof) {
    const int z = dof[z_dof];
    if (z != held) weight[z] = vehicle.gravity * vehicle.mass(z, z);
  }
  return standing(vehicle, weight).displacement;
}

void add_deflections(const VehicleData& data, std::vector<std::string>& sentences) {
  constexpr double largest = 0.5;  // [m]: springs of vehicles deflect by up to 0.3 m
  for (const auto& [suspension, deflection] : static_deflections(data)) {
    if (deflection <= largest) continue;
    sentences.push_back(fmt::format(
        "{}: the springs of {} deflect by {:.3g} m under the weight, and none of a vehicle by more than {} m: is kz in "
        "N/m?",
        data.name, suspension, deflection, largest));
  }
}

double wheel_radius(const VehicleDescription& parts, std::size_t wheelset) {
  return parts.wheel_radius.empty() ? parts.nominal_radius : parts.wheel_radius[wheelset];
}

void add_overlapping_wheels(const VehicleData& data, std::vector<std::string>& sentences) {
  const VehicleDescription& parts = data.parts;
  for (std::size_t w = 0; w + 1 < parts.wheelsets.size(); ++w) {
    const RigidBody& ahead = parts.bodies[static_cast<std::size_t>(parts.wheelsets[w])];
    const RigidBody& behind = parts.bodies[static_cast<std::size_t>(parts.wheelsets[w + 1])];
    const double distance = ahead.position.x() - behind.position.x();
    const double radii = wheel_radius(parts, w) + wheel_radius(parts, w + 1);
    if (distance >= radii) continue;
    sentences.push_back(
        fmt::format("{}: the wheels of {} and {} overlap: their axles are {:.3g} m apart, and their radii add up to "
                    "{:.3g} m; are their positions in m?",
                    data.name, ahead.name, behind.name, distance, radii));
    return;
  }
}

void add_light_car_body(const VehicleData& data, std::vector<std::string>& sentences) {
  const VehicleDescription& parts = data.parts;
  double wheelsets = 0.0;
  for (const int w : parts.wheelsets) wheelsets += parts.bodies[static_cast<std::size_t>(w)].mass;
  for (const RigidBody& body : parts.bodies) {
    if (body.name != "car-body" || body.mass >= wheelsets) continue;
    sentences.push_back(
        fmt::format("{}: the car body of {:.6g} kg is lighter than the wheelsets, {:.6g} kg in all: is "
                    "its mass in kg?",
                    data.name, body.mass, wheelsets));
  }
}

// No moment of inertia exceeds the sum of the other two. Published ones do by up to a third; wrong units by far more.
void add_impossible_inertias(const VehicleData& data, std::vector<std::string>& sentences) {
  if (data.motion == MotionPlane::vertical) return;  // Jy alone is known
  constexpr double published = 2.0;
  constexpr std::array names{"Jx", "Jy", "Jz"};
  for (const RigidBody& body : data.parts.bodies) {
    const Eigen::Vector3d& J = body.inertia;
    Eigen::Index largest = 0;
    const double most = J.maxCoeff(&largest), others = J.sum() - most;
    if (most <= published * others) continue;
    sentences.push_back(
        fmt::format("{}: {} of {}, {:.4g} kg m², is more than twice the sum of the other two moments of inertia, "
                    "{:.4g} kg m²; no body "
                    "has one above the sum of the others: are they in kg m²?",
                    data.name, names[static_cast<std::size_t>(largest)], body.name, most, others));
  }
}

void add_loose_wheelsets(const VehicleData& data, std::vector<std::string>& sentences) {
  const VehicleDescription& parts = data.parts;
  if (data.stands_on_joints || parts.bodies.size() == parts.wheelsets.size()) return;
  for (const int w : parts.wheelsets) {
    const bool joined = std::any_of(parts.suspension.begin(), parts.suspension.end(),
                                    [&](const Suspension& s) { return s.body_a == w || s.body_b == w; });
    if (joined) continue;
    sentences.push_back(fmt::format("{}: no connection joins {} to the vehicle: it will run away from the rest",
                                    data.name, parts.bodies[static_cast<std::size_t>(w)].name));
  }
}

}  // namespace

std::vector<StaticDeflection> static_deflections(const VehicleData& data) {
  if (data.stands_on_joints) return {};
  const VehicleModel vehicle = build_vehicle(data, data.motion, {standard_gravity, GeometricStiffness::omitted});
  const Eigen::VectorXd rest = rest_under_weight(vehicle);
  std::vector<StaticDeflection> deflections;
  for (const Suspension& unit : data.parts.suspension) {
    if (unit.stiffness.z() <= 0.0) continue;
    auto known = std::find_if(deflections.begin(), deflections.end(),
                              [&](const StaticDeflection& d) { return d.suspension == unit.name; });
    if (known == deflections.end()) known = deflections.insert(known, StaticDeflection{unit.name, 0.0});
    known->deflection = std::max(known->deflection, std::abs(elongation(vehicle, unit, rest).z()));
  }
  return deflections;
}

std::vector<std::string> implausible_values(const VehicleData& data) {
  std::vector<std::string> sentences;
  add_deflections(data, sentences);
  add_overlapping_wheels(data, sentences);
  add_light_car_body(data, sentences);
  add_impossible_inertias(data, sentences);
  add_loose_wheelsets(data, sentences);
  return sentences;
}

}  // namespace railtab
