#include "railtab/runtime/vsi/static_equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr double regularisation = 0.05;  // eps [1/s²]: far below the square of any suspended mode (2π·0.5 Hz)² = 10
constexpr int max_iterations = 60;
constexpr double contact_tolerance = 1e-10;  // m, rad: of the contact unknowns
// Of the dofs: what rounding leaves of the wheel loads, over the weak eps M, moves them by some nm.
constexpr double dof_tolerance = 1e-7;  // m, rad
constexpr double pitch_rate_compliance = 1e-3;  // rad/s per N m: any value that lets Newton drive the axle's torque to zero

std::size_t index(int i) { return static_cast<std::size_t>(i); }

std::vector<RailCoupling> all_couplings(const StructureResponse& response, const std::vector<RailContact>& contacts) {
  const Eigen::MatrixXd compliance = response.compliance_at(contacts);
  std::vector<RailCoupling> rail;
  const int wheels = static_cast<int>(contacts.size());
  for (int i = 0; i < wheels; ++i) {
    for (int j = 0; j < wheels; ++j) rail.push_back({i, j, compliance.block<3, 3>(3 * i, 3 * j)});
  }
  return rail;
}

constexpr int pitch = 4;

// A wheelset's pitch angle has no effect at rest: in its place stands the deviation from the nominal rotation, which is
// free of torque. No angle is left behind.
void clear_pitch(const VsiModel& model, Eigen::VectorXd& dofs) {
  for (int body : model.vehicle.wheelsets) {
    const int dof = model.vehicle.dof[index(body)][pitch];
    if (dof != held) dofs[dof] = 0.0;
  }
}

ContactProblem rest_problem(const VsiModel& model, const VehicleResponse& vehicle, const StructureResponse* structure,
                            const std::vector<RailContact>& contacts) {
  ContactProblem problem;
  problem.wheelsets_per_vehicle = model.wheelsets_per_vehicle();
  problem.free = problem.predicted = problem.predicted_velocity =
      Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets());
  problem.vehicle_compliance = vehicle.compliance();
  problem.velocity_rate[pitch] = 1.0;
  for (int w = 0; w < problem.wheelsets_per_vehicle; ++w) {
    const int k = 6 * w + pitch;
    const bool free_pitch = problem.vehicle_compliance(k, k) > 0.0;
    problem.vehicle_compliance.row(k).setZero();
    problem.vehicle_compliance.col(k).setZero();
    if (free_pitch) problem.vehicle_compliance(k, k) = pitch_rate_compliance;
  }
  if (structure) problem.rail = all_couplings(*structure, contacts);
  problem.largest_move = 1e-3;
  return problem;
}

}  // namespace

EquilibriumReport static_equilibrium(const VsiModel& model, VsiState& state) {
  EquilibriumReport report;
  const VehicleResponse vehicle(model.vehicle, regularisation);
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  std::unique_ptr<StructureResponse> structure;
  if (model.structure) structure = std::make_unique<StructureResponse>(*model.structure);
  ContactProblem problem = rest_problem(model, vehicle, structure.get(), contacts);
  const NewtonLimits limits{.tolerance = 1e-12, .max_iterations = 100};
  const int vehicles = static_cast<int>(model.vehicle_x.size());

  for (report.iterations = 0; report.iterations < max_iterations && !report.converged; ++report.iterations) {
    rail_deviation(model, contacts, state.time, state.structure.displacement, problem.deviation);
    for (int v = 0; v < vehicles; ++v) {
      const LinearMotion& motion = state.vehicle[index(v)];
      const Eigen::VectorXd free =
          vehicle.inverse() * (model.vehicle.static_load + regularisation * (model.vehicle.mass * motion.displacement));
      gather_wheelsets(model, v, free, problem.free);
    }
    for (int w = 0; w < model.wheelsets(); ++w) {
      problem.free[wheelset_unknowns * w + pitch] = state.contact.displacement[wheelset_unknowns * w + pitch];
    }
    const Eigen::VectorXd contact_before = state.contact.displacement;
    const NewtonReport newton = solve_contact(model.contact, problem, limits, state.contact);
    if (!newton.converged) return report;

    report.change = 0.0;
    for (int v = 0; v < vehicles; ++v) {
      LinearMotion& motion = state.vehicle[index(v)];
      scatter_wheelset_forces(model, v, state.contact.force, motion.contact_load);
      Eigen::VectorXd next =
          vehicle.inverse() * (model.vehicle.static_load + motion.contact_load +
                               regularisation * (model.vehicle.mass * motion.displacement));
      clear_pitch(model, next);
      report.change = std::max(report.change, (next - motion.displacement).cwiseAbs().maxCoeff());
      motion.displacement = next;
    }
    if (structure) {
      scatter_rail_forces(contacts, state.contact.force, state.structure.contact_load);
      const Eigen::VectorXd next = structure->solve(state.structure.contact_load);
      report.change = std::max(report.change, (next - state.structure.displacement).cwiseAbs().maxCoeff());
      state.structure.displacement = next;
    }
    const double contact_change = (state.contact.displacement - contact_before).cwiseAbs().maxCoeff();
    report.converged = contact_change < contact_tolerance && report.change < dof_tolerance;
  }
  // The pitch unknowns are rates: hand them to the vehicles as such.
  for (int w = 0; w < model.wheelsets(); ++w) {
    const int per_vehicle = model.wheelsets_per_vehicle();
    const int body = model.vehicle.wheelsets[index(w % per_vehicle)];
    const int dof = model.vehicle.dof[index(body)][pitch];
    if (dof == held) continue;
    state.vehicle[index(w / per_vehicle)].velocity[dof] = state.contact.displacement[wheelset_unknowns * w + pitch];
  }
  return report;
}

EquilibriumReport quasi_static_start(const VsiModel& model, double time_step, VsiState& state) {
  VsiState before = state;
  before.time -= time_step;
  VsiState after = state;
  after.time += time_step;
  EquilibriumReport report = static_equilibrium(model, state);
  if (!report.converged) return report;
  before.contact = after.contact = state.contact;
  for (VsiState* neighbour : {&before, &after}) {
    for (std::size_t v = 0; v < state.vehicle.size(); ++v) neighbour->vehicle[v].displacement = state.vehicle[v].displacement;
    neighbour->structure.displacement = state.structure.displacement;
    const EquilibriumReport r = static_equilibrium(model, *neighbour);
    report.iterations += r.iterations;
    report.converged = report.converged && r.converged;
  }
  const auto follow = [time_step](const LinearMotion& a, const LinearMotion& b, LinearMotion& motion) {
    motion.velocity += (b.displacement - a.displacement) / (2.0 * time_step);
    motion.acceleration = (b.displacement - 2.0 * motion.displacement + a.displacement) / (time_step * time_step);
  };
  for (std::size_t v = 0; v < state.vehicle.size(); ++v) follow(before.vehicle[v], after.vehicle[v], state.vehicle[v]);
  if (model.structure) follow(before.structure, after.structure, state.structure);
  return report;
}

}  // namespace railtab
