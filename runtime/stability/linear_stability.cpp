#include "railtab/runtime/stability/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/stability/contact_slopes.hpp"
#include "railtab/runtime/stability/rigid_rails.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"

namespace railtab {

namespace {

constexpr Eigen::Index y_dof = 1, yaw_dof = 5;
constexpr double slowest = 0.05;  // rad/s: the angles of the wheelsets' rotations are free

LeastStableMotion motion_of(const std::complex<double>& value, double speed) {
  return {speed, value.real(), value.imag() / (2.0 * std::numbers::pi), -value.real() / std::abs(value)};
}

std::vector<int> all_rows(const VehicleModel& vehicle) {
  std::vector<int> rows(index(vehicle.dofs()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

// Adds what the contacts do to the matrices of the running vehicle.
void add_contacts(const VsiModel& model, std::optional<double> conicity, VehicleModel& running) {
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) {
    throw ComputationError(fmt::format("{} does not come to rest on straight rails at {:.6g} m/s", model.vehicle.name,
                                       model.contact.speed));
  }
  const TrainContact train = model.train_contact();
  const std::vector<WheelsetMotion> motions = wheelset_motions(model, state.vehicle[0]);
  for (int w = 0; w < model.wheelsets(); ++w) {
    ContactSlopes slopes = contact_slopes(train[w], motions[index(w)]);
    if (conicity) {
      const WheelRailPair& pair = train[w].geometry->pair();
      slopes.by_displacement(yaw_dof, y_dof) = pair.tape_circle_offset() * slopes.by_velocity(0, 0) *
                                               model.contact.speed * *conicity / pair.nominal_radius();
    }
    subtract_contact_slopes(running, w, slopes, running.stiffness, running.damping);
  }
}

// Share of y, roll and yaw in the kinetic energy of each shape. Where left and right are alike, it is 0 or 1.
Eigen::VectorXd lateral_shares(const VehicleModel& vehicle, const Eigen::MatrixXcd& shapes) {
  std::vector<bool> is_lateral(index(vehicle.dofs()), false);
  for (const DofIndices& dof : vehicle.dof) {
    for (const std::size_t motion : {1U, 3U, 5U}) {
      if (dof[motion] != held) is_lateral[index(dof[motion])] = true;
    }
  }
  Eigen::VectorXd lateral = Eigen::VectorXd::Zero(shapes.cols()), all = lateral;
  Eigen::Index k = 0;  // row of the shapes, which have those with mass
  for (int row = 0; row < vehicle.dofs(); ++row) {
    const double mass = vehicle.mass(row, row);
    if (!(mass > 0.0)) continue;
    const Eigen::VectorXd energy = mass * shapes.row(k++).cwiseAbs2().transpose();
    all += energy;
    if (is_lateral[index(row)]) lateral += energy;
  }
  return lateral.cwiseQuotient(all.cwiseMax(std::numeric_limits<double>::min()));
}

std::vector<LinearShape> lateral_shapes(const VehicleModel& running) {
  std::vector<int> massive;
  for (int row = 0; row < running.dofs(); ++row) {
    if (running.mass(row, row) > 0.0) massive.push_back(row);
  }
  const MotionSpectrum spectrum = motion_spectrum(running, all_rows(running));
  const Eigen::VectorXd lateral = lateral_shares(running, spectrum.shapes);
  std::vector<LinearShape> shapes;
  for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
    const std::complex<double> value = spectrum.values[k];
    if (std::abs(value) < slowest || lateral[k] < 0.5 || value.imag() < 0.0) continue;
    shapes.push_back({value, Eigen::VectorXcd::Zero(running.dofs())});
    shapes.back().displacement(massive) = spectrum.shapes.col(k);
  }
  std::stable_sort(shapes.begin(), shapes.end(),
                   [](const LinearShape& a, const LinearShape& b) { return a.value.real() > b.value.real(); });
  return shapes;
}

}  // namespace

VehicleModel running_vehicle(const VsiModel& model, double speed, std::optional<double> conicity) {
  VsiModel rigid = on_rigid_rails(model, speed);
  rigid.contact.damping = 0.0;
  VehicleModel running = rigid.vehicle;
  running.damping = rigid.vehicle_damping(speed);
  add_contacts(rigid, conicity, running);
  return running;
}

std::vector<LinearShape> lateral_shapes(const VsiModel& model, double speed, std::optional<double> conicity) {
  return lateral_shapes(running_vehicle(model, speed, conicity));
}

std::optional<LeastStableMotion> growing_motion(const VsiModel& model, double speed, std::optional<double> conicity) {
  const VehicleModel running = running_vehicle(model, speed, conicity);
  const Eigen::VectorXcd values = motion_eigenvalues(running, all_rows(running));
  const bool any = std::any_of(values.begin(), values.end(), [&](const std::complex<double>& value) {
    return std::abs(value) >= slowest && motion_of(value, speed).grows();
  });
  if (!any) return {};
  const std::vector<LinearShape> shapes = lateral_shapes(running);
  if (shapes.empty()) return {};
  const LeastStableMotion least = motion_of(shapes.front().value, speed);
  return least.grows() ? std::optional(least) : std::nullopt;
}

LeastStableMotion least_stable_motion(const VsiModel& model, double speed, std::optional<double> conicity, int motion) {
  const std::vector<LinearShape> shapes = lateral_shapes(model, speed, conicity);
  if (index(motion) > shapes.size()) return {.speed = speed, .growth = -std::numeric_limits<double>::infinity()};
  return motion_of(shapes[index(motion - 1)].value, speed);
}

LinearCriticalSpeed linear_critical_speed(const VsiModel& model, const SpeedSearch& search,
                                          std::optional<double> conicity) {
  LinearCriticalSpeed result;
  double stable = 0.0;
  for (int i = 0;; ++i) {
    const double speed = std::min(search.low + i * search.step, search.high);
    result.searched.push_back(least_stable_motion(model, speed, conicity, search.motion));
    if (result.searched.back().grows()) break;
    if (speed >= search.high) return result;
    stable = speed;
  }
  LeastStableMotion unstable = result.searched.back();
  while (stable > 0.0 && unstable.speed - stable > search.tolerance) {
    const LeastStableMotion middle =
        least_stable_motion(model, 0.5 * (stable + unstable.speed), conicity, search.motion);
    if (middle.grows()) {
      unstable = middle;
    } else {
      stable = middle.speed;
    }
  }
  result.critical = unstable;
  return result;
}

}  // namespace railtab
