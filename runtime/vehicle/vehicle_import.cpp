#include "railtab/runtime/vehicle/vehicle_import.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/fe/fe_files.hpp"
#include "railtab/runtime/fe/fe_frame.hpp"
#include "railtab/runtime/fe/fe_matrix.hpp"
#include "railtab/runtime/vehicle/geometric_stiffness.hpp"
#include "railtab/runtime/vehicle/vehicle_checks.hpp"
#include "railtab/runtime/vehicle/vehicle_table.hpp"
#include "railtab/runtime/vehicle/vehicle_terms.hpp"

namespace railtab {

namespace {

using Matrix = Eigen::MatrixXd;

Matrix read_dense(const std::filesystem::path& file, Eigen::Index rows) {
  const Eigen::SparseMatrix<double> matrix = read_matrix_market(file);
  if (matrix.rows() > most_vehicle_rows) {
    throw input_error(file.string(), fmt::format("{} rows", matrix.rows()),
                      fmt::format("at most {}: a flexible body by its lowest modes", most_vehicle_rows));
  }
  return Matrix(symmetric_mean(file, matrix, rows));
}

int body_index(const std::vector<TableBody>& bodies, const std::string& name, std::string_view key) {
  const auto found =
      std::find_if(bodies.begin(), bodies.end(), [&](const TableBody& body) { return body.name == name; });
  if (found != bodies.end()) return static_cast<int>(found - bodies.begin());
  std::vector<std::string_view> names;
  for (const TableBody& body : bodies) names.push_back(body.name);
  throw input_error(fmt::format("scene: {}", key), name, fmt::format("one of {}", fmt::join(names, ", ")));
}

// Turns rows and bodies from the model's axes and units into railtab's.
void convert(FreeVehicle& vehicle) {
  const FrameConversion conversion(vehicle.import.frame, "scene: vehicle");
  Eigen::VectorXd to_model = Eigen::VectorXd::Constant(vehicle.mass.rows(), conversion.inner_to_model());
  for (TableBody& body : vehicle.bodies) {
    body.position = conversion.position(body.position);
    const DofIndices of_model = body.row;
    for (int k = 0; k < 6; ++k) {
      const int row = of_model[static_cast<std::size_t>(k)];
      const FrameConversion::Row converted = conversion.row(k);
      body.row[static_cast<std::size_t>(converted.motion)] = row;
      if (row != held) to_model[row] = converted.to_model;
    }
  }
  for (Matrix* matrix : {&vehicle.mass, &vehicle.damping, &vehicle.stiffness}) {
    *matrix = to_model.asDiagonal() * *matrix * to_model.asDiagonal();
  }
}

FreeVehicle read_free_vehicle(const VehicleImport& import, GeometricStiffness geometric) {
  FreeVehicle vehicle(import);
  vehicle.stiffness = read_dense(import.stiffness, 0);
  const Eigen::Index rows = vehicle.stiffness.rows();
  vehicle.mass = read_dense(import.mass, rows);
  vehicle.damping = read_dense(import.damping, rows);
  vehicle.bodies = read_vehicle_table(import.dofs, static_cast<int>(rows));
  for (const std::string& name : import.wheelsets) {
    vehicle.wheelsets.push_back(body_index(vehicle.bodies, name, "vehicle.wheelsets"));
  }
  vehicle.car_body = body_index(vehicle.bodies, import.car_body, "vehicle.car_body");
  convert(vehicle);
  check_wheelsets(vehicle);
  check_numbers(vehicle);
  check_mass(vehicle);
  vehicle.rigid = rigid_motions(vehicle);
  check_free_motions(vehicle, geometric);
  return vehicle;
}

// Indices of the car bodies, front first.
std::vector<int> car_bodies(const FreeVehicle& vehicle) {
  if (vehicle.import.car_bodies.empty()) return {vehicle.car_body};
  std::vector<int> cars;
  for (const std::string& name : vehicle.import.car_bodies) {
    cars.push_back(body_index(vehicle.bodies, name, "vehicle.car_bodies"));
    const std::size_t n = cars.size();
    const auto x = [&](std::size_t k) { return vehicle.bodies[static_cast<std::size_t>(cars[k])].position.x(); };
    if (n < 2 || x(n - 1) < x(n - 2)) continue;
    throw input_error("scene: vehicle.car_bodies",
                      fmt::format("{} at x = {:.6g} m after one at {:.6g} m", name, x(n - 1), x(n - 2)),
                      "each car body once, in order from the front");
  }
  return cars;
}

// Names of results and loads, by which reports find car bodies.
std::vector<VehicleBody> named_bodies(const FreeVehicle& vehicle) {
  std::vector<std::string> given(vehicle.bodies.size());
  const std::vector<int> cars = car_bodies(vehicle);
  for (const int car : cars) given[static_cast<std::size_t>(car)] = "car-body";
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    given[static_cast<std::size_t>(vehicle.wheelsets[w])] = fmt::format("wheelset-{}", w + 1);
  }
  std::vector<VehicleBody> bodies;
  for (std::size_t b = 0; b < given.size(); ++b) {
    const TableBody& body = vehicle.bodies[b];
    if (given[b].empty() && std::find(given.begin(), given.end(), body.name) != given.end()) {
      throw input_error(body.place, fmt::format("a body named {}", body.name),
                        "another name: so results call what the scene names as car body or wheelset");
    }
    const auto distance = [&](int car) {
      return std::abs(vehicle.bodies[static_cast<std::size_t>(car)].position.x() - body.position.x());
    };
    const auto nearest =
        std::min_element(cars.begin(), cars.end(), [&](int a, int c) { return distance(a) < distance(c); });
    bodies.push_back(
        {given[b].empty() ? body.name : given[b], body.position, static_cast<int>(nearest - cars.begin())});
  }
  return bodies;
}

// Rows that are no degrees of freedom of a run.
std::vector<bool> held_rows(const FreeVehicle& vehicle, MotionPlane plane) {
  std::vector<bool> is_held(static_cast<std::size_t>(vehicle.mass.rows()), false);
  const auto hold = [&](const TableBody& body, std::size_t motion) {
    if (body.row[motion] != held) is_held[static_cast<std::size_t>(body.row[motion])] = true;
  };
  hold(vehicle.bodies[static_cast<std::size_t>(vehicle.car_body)], x_dof);
  if (plane == MotionPlane::spatial) return is_held;
  for (const TableBody& body : vehicle.bodies) {
    for (const std::size_t motion : {y_dof, roll_dof, yaw_dof}) hold(body, motion);
  }
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) hold(vehicle.wheelset(w), pitch_dof);
  return is_held;
}

// Where the scene names none, nothing follows the vehicle.
double length_over_couplers(const FreeVehicle& vehicle) {
  const double reach = vehicle.wheelset(0).position.x() - vehicle.wheelset(vehicle.wheelsets.size() - 1).position.x();
  const double length = vehicle.import.length.value_or(reach);
  if (!vehicle.import.length || length > reach) return length;
  throw input_error("scene: vehicle.length", fmt::format("{} m", length),
                    fmt::format("more than the distance of the outer wheelsets, {:.6g} m", reach));
}

// Weights of the bodies besides the wheelsets, each with that of the inner degrees of freedom it carries: what unit
// motions of the bodies, which the inner ones follow without strain, move against gravity.
std::vector<CarriedWeight> carried_weights(const FreeVehicle& vehicle, double gravity) {
  const Eigen::VectorXd weight = gravity * (vehicle.mass * vehicle.rigid.col(z_dof));
  const std::vector<int> inner = inner_rows(vehicle);
  Eigen::VectorXd followed;  // K_ii⁻¹ w_i
  if (!inner.empty()) {
    followed = symmetric_solution(vehicle.stiffness(inner, inner), Eigen::VectorXd(weight(inner)));
  }
  std::vector<CarriedWeight> weights;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const TableBody& body = vehicle.bodies[b];
    const int y = body.row[y_dof], z = body.row[z_dof], roll = body.row[roll_dof];
    const auto& wheelsets = vehicle.wheelsets;
    if (z == held || std::find(wheelsets.begin(), wheelsets.end(), static_cast<int>(b)) != wheelsets.end()) continue;
    double carried = weight[z];
    if (!inner.empty()) carried -= vehicle.stiffness(z, inner).dot(followed);
    // where a lateral force does not turn the body: the height of its springs, if they are all at one
    const double ky = y == held ? 0.0 : vehicle.stiffness(y, y);
    const double below = ky > 0.0 && roll != held ? -vehicle.stiffness(y, roll) / ky : 0.0;
    weights.push_back({static_cast<int>(b), carried, body.position.z() + below});
  }
  return weights;
}

}  // namespace

void VehicleImport::validate(int vehicles) const {
  if (mass.empty() || damping.empty() || stiffness.empty() || dofs.empty()) {
    throw input_error("train.vehicle", "\"imported\" without all its files",
                      "vehicle.mass, vehicle.damping, vehicle.stiffness and vehicle.dofs");
  }
  if (wheelsets.empty()) throw input_error("vehicle.wheelsets", "none", "their names in vehicle.dofs, front first");
  if (car_body.empty()) throw input_error("vehicle.car_body", "none", "its name in vehicle.dofs");
  for (auto name = wheelsets.begin(); name != wheelsets.end(); ++name) {
    if (std::find(wheelsets.begin(), name, *name) != name || *name == car_body) {
      throw input_error("vehicle.wheelsets", fmt::format("{} twice", *name), "each wheelset once, and no car body");
    }
  }
  if (vehicles > 1 && !length) {
    throw input_error("vehicle.length", fmt::format("none, and {} vehicles", vehicles), "the length over couplers");
  }
}

VehicleModel import_vehicle(const VehicleImport& import, MotionPlane plane, const VehicleWeight& weight) {
  import.validate(1);
  const FreeVehicle free = read_free_vehicle(import, weight.geometric_stiffness);
  VehicleModel vehicle;
  vehicle.name = fmt::format("the vehicle of {}", import.stiffness.string());
  vehicle.bodies = named_bodies(free);
  vehicle.coaches = static_cast<int>(car_bodies(free).size());
  vehicle.wheelsets = free.wheelsets;
  for (std::size_t w = 0; w < free.wheelsets.size(); ++w)
    vehicle.wheel_radius.push_back(-free.wheelset(w).position.z());
  vehicle.length = length_over_couplers(free);

  const std::vector<bool> is_held = held_rows(free, plane);
  std::vector<int> kept, unknown_of_row;
  for (const bool h : is_held) {
    unknown_of_row.push_back(h ? held : static_cast<int>(kept.size()));
    if (!h) kept.push_back(static_cast<int>(unknown_of_row.size()) - 1);
  }
  for (const TableBody& body : free.bodies) {
    DofIndices& dof = vehicle.dof.emplace_back();
    for (std::size_t k = 0; k < 6; ++k) {
      dof[k] = body.row[k] == held ? held : unknown_of_row[static_cast<std::size_t>(body.row[k])];
    }
  }
  vehicle.mass = free.mass(kept, kept);
  vehicle.damping = free.damping(kept, kept);
  vehicle.stiffness = free.stiffness(kept, kept);
  vehicle.gyroscopic.setZero(vehicle.mass.rows(), vehicle.mass.rows());
  const Matrix inertia = free.mass * free.rigid;
  vehicle.acceleration_load = -inertia.col(x_dof)(kept);
  vehicle.lateral_shift = free.rigid.col(y_dof)(kept);
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const int row = free.wheelset(w).row[pitch_dof];
    add_rolling(vehicle, w, free.mass(row, row));
  }
  vehicle.lateral_load = inertia.col(y_dof)(kept);
  vehicle.gravity = weight.gravity;
  vehicle.static_load = standing(vehicle, weight.gravity * inertia.col(z_dof)(kept)).reaction;
  if (weight.geometric_stiffness == GeometricStiffness::included) {
    add_geometric_stiffness(vehicle, carried_weights(free, weight.gravity));
  }
  check_wheel_loads(vehicle, [&](std::size_t wheelset) { return free.wheelset(wheelset).place; });
  return vehicle;
}

}  // namespace railtab
