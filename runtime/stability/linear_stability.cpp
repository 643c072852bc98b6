#include "railtab/runtime/stability/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"

namespace railtab {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr Eigen::Index y_dof = 1, pitch_dof = 4, yaw_dof = 5;

// Well below penetration and creepage of sliding, well above the rounding of the contact search.
constexpr double move = 1e-6;  // m, rad
constexpr double creepage_step = 1e-6;

// Forces of both wheels on a wheelset.
Vector6 wheelset_force(const WheelContactModel& model, const WheelsetMotion& motion) {
  Vector6 sum = Vector6::Zero();
  const RailHeadMotion rail;
  for (const WheelSide side : {WheelSide::left, WheelSide::right}) {
    const WheelsetPose pose = relative_pose(model.geometry->pair(), side, motion, rail);
    sum += wheel_force(model, side, motion, rail, wheel_contact(*model.geometry, pose)).wheelset;
  }
  return sum;
}

struct ForceSlopes {
  Matrix6 by_displacement, by_velocity;
};

ForceSlopes force_slopes(const WheelContactModel& model, const WheelsetMotion& at) {
  ForceSlopes slopes;
  const auto difference = [&](Vector6 WheelsetMotion::*member, Eigen::Index dof, double step) {
    WheelsetMotion ahead = at, behind = at;
    (ahead.*member)[dof] += step;
    (behind.*member)[dof] -= step;
    return Vector6((wheelset_force(model, ahead) - wheelset_force(model, behind)) / (2.0 * step));
  };
  const double radius = model.geometry->pair().nominal_radius();
  for (Eigen::Index dof = 0; dof < 6; ++dof) {
    slopes.by_displacement.col(dof) = difference(&WheelsetMotion::displacement, dof, move);
    const double arm = dof < 3 ? 1.0 : radius;
    slopes.by_velocity.col(dof) = difference(&WheelsetMotion::velocity, dof, creepage_step * model.speed / arm);
  }
  return slopes;
}

// The train alone on rigid rails, at rest in the middle.
VsiModel on_rigid_rails(const VsiModel& model, double speed) {
  VsiModel rigid;
  rigid.vehicle = model.vehicle;
  rigid.vehicle_x = {0.0};
  rigid.geometry = model.geometry;
  rigid.contact = model.contact;
  rigid.contact.speed = speed;
  rigid.contact.damping = 0.0;
  rigid.gyroscopic_moments = model.gyroscopic_moments;
  return rigid;
}

// Adds what the contacts do to the matrices of the running vehicle.
void add_contacts(const VsiModel& model, std::optional<double> conicity, VehicleModel& running) {
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) {
    throw ComputationError(fmt::format("{} does not come to rest on straight rails at {:.6g} m/s", model.vehicle.name,
                                       model.contact.speed));
  }
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets()), velocity = displacement;
  gather_wheelsets(model, 0, state.vehicle[0].displacement, displacement);
  gather_wheelsets(model, 0, state.vehicle[0].velocity, velocity);
  const WheelRailPair& pair = model.geometry->pair();
  for (int w = 0; w < model.wheelsets(); ++w) {
    const int first = wheelset_unknowns * w;
    ForceSlopes slopes = force_slopes(model.contact, {displacement.segment<6>(first), velocity.segment<6>(first)});
    if (conicity) {
      slopes.by_displacement(yaw_dof, y_dof) = pair.tape_circle_offset() * slopes.by_velocity(0, 0) *
                                               model.contact.speed * *conicity / pair.nominal_radius();
    }
    const DofIndices& dof = running.dof[index(running.wheelsets[index(w)])];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        if (dof[index(i)] == held || dof[index(j)] == held) continue;
        running.stiffness(dof[index(i)], dof[index(j)]) -= slopes.by_displacement(i, j);
        running.damping(dof[index(i)], dof[index(j)]) -= slopes.by_velocity(i, j);
      }
    }
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

}  // namespace

VehicleModel running_vehicle(const VsiModel& model, double speed, std::optional<double> conicity) {
  const VsiModel rigid = on_rigid_rails(model, speed);
  VehicleModel running = rigid.vehicle;
  running.damping = rigid.vehicle_damping(speed);
  add_contacts(rigid, conicity, running);
  return running;
}

LeastStableMotion least_stable_motion(const VsiModel& model, double speed, std::optional<double> conicity) {
  const VehicleModel running = running_vehicle(model, speed, conicity);
  std::vector<int> rows;
  for (int row = 0; row < running.dofs(); ++row) rows.push_back(row);
  const MotionSpectrum spectrum = motion_spectrum(running, rows);
  const Eigen::VectorXd lateral = lateral_shares(running, spectrum.shapes);
  constexpr double slowest = 0.05;  // rad/s: the angles of the wheelsets' rotations are free
  LeastStableMotion least{.speed = speed, .growth = -std::numeric_limits<double>::infinity()};
  for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
    const std::complex<double> value = spectrum.values[k];
    const double size = std::abs(value);
    if (size < slowest || lateral[k] < 0.5 || value.real() <= least.growth) continue;
    least = {speed, value.real(), std::abs(value.imag()) / (2.0 * std::numbers::pi), -value.real() / size};
  }
  return least;
}

LinearCriticalSpeed linear_critical_speed(const VsiModel& model, const SpeedSearch& search,
                                          std::optional<double> conicity) {
  LinearCriticalSpeed result;
  double stable = 0.0;
  for (int i = 0;; ++i) {
    const double speed = std::min(search.low + i * search.step, search.high);
    result.searched.push_back(least_stable_motion(model, speed, conicity));
    if (result.searched.back().growth > 0.0) break;
    if (speed >= search.high) return result;
    stable = speed;
  }
  LeastStableMotion unstable = result.searched.back();
  while (stable > 0.0 && unstable.speed - stable > search.tolerance) {
    const LeastStableMotion middle = least_stable_motion(model, 0.5 * (stable + unstable.speed), conicity);
    if (middle.growth > 0.0) {
      unstable = middle;
    } else {
      stable = middle.speed;
    }
  }
  result.critical = unstable;
  return result;
}

std::optional<double> equivalent_conicity(const WheelRailPair& pair, double amplitude) {
  const ContactSearch search(pair);
  const PatchQuery query = [&](const WheelsetPose& pose, double near_miss) { return search.patches(pose, near_miss); };
  const RadiusDifferenceCurve curve(wheelset_contacts(query, pair, {}));
  const EquivalentConicity conicity = conicity_of_wave(curve, amplitude);
  if (conicity.status != ConicityStatus::found) return {};
  return conicity.tan_gamma;
}

}  // namespace railtab
