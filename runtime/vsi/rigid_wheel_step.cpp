// The time step with wheels that follow the rails (NormalContact::rigid).

#include <algorithm>

#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/step.hpp"
#include "railtab/runtime/vsi/structure_step.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

using Eigen::Vector3d;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Mean over the two rails under a wheelset of displacement, slope and curvature from structure dofs.
Vector3d mean_line(const RailContact* contact, const Eigen::VectorXd& dofs) {
  Vector3d line = Vector3d::Zero();
  for (int side = 0; side < 2; ++side) {
    if (!contact[side].on_rail) continue;
    const RailInterpolation& rows = contact[side].rows;
    for (std::size_t k = 0; k < 12; ++k) {
      if (rows.dof[k] != held) line += 0.5 * dofs[rows.dof[k]] * Vector3d(rows.z[k], -rows.pitch[k], rows.bend[k]);
    }
  }
  return line;
}

// How the wheels run at the end of a step.
struct Running {
  double V, rate;  // speed [m/s] and its rate [m/s²]
};

// Heave, its velocity and acceleration of a wheel on a line that has the values, slopes and curvatures `displacement`,
// and their material rates: d/dt = ∂/∂t + V ∂/∂x.
Vector3d followed(const Vector3d& displacement, const Vector3d& velocity, double acceleration, const Running& run) {
  return {displacement[0], velocity[0] + run.V * displacement[1],
          acceleration + 2.0 * run.V * velocity[1] + run.V * run.V * displacement[2] + run.rate * displacement[1]};
}

// Response of the mean lines to forces on the wheelsets: pairs within the reach of the tabulated compliance.
struct LineCoupling {
  int i, j;
  Vector3d line;  // displacement, slope, curvature under wheelset i per force on wheelset j, [1/N] times these units
};

std::vector<LineCoupling> line_couplings(const StepOperators& op, const std::vector<RailContact>& contacts) {
  std::vector<LineCoupling> couplings;
  const int wheelsets = static_cast<int>(contacts.size()) / 2;
  const auto response = [&](int i, int j) {
    Vector3d line = Vector3d::Zero();
    for (int side = 0; side < 2; ++side) {
      for (int other = 0; other < 2; ++other) {
        line += 0.25 * op.scheme.load_weight() *
                op.structure->vertical_compliance(contacts[index(2 * i + side)], contacts[index(2 * j + other)]);
      }
    }
    return line;
  };
  for (int j = 0; j < wheelsets; ++j) {
    for (int i = j; i < wheelsets; ++i) {
      const Vector3d line = response(i, j);
      if (i != j && line.isZero(0.0)) break;  // wheelsets are in the order of the train
      couplings.push_back({i, j, line});
      if (i != j) couplings.push_back({j, i, response(j, i)});
    }
  }
  return couplings;
}

// F = F_0 + Σ (Z, W, A)·heave with heave = free + T·Σ line·(load on the rails = −F): a system for the forces.
void solve_forces(const VsiModel& model, const StepOperators& op, const Running& run,
                  const std::vector<LineCoupling>& couplings, const std::vector<Vector3d>& free,
                  const Eigen::VectorXd& free_force, RigidWheelWorkspace& ws) {
  const int wheelsets = static_cast<int>(free_force.size());
  const int per_vehicle = model.wheelsets_per_vehicle();
  const RigidWheelResponse& wheels = *op.rigid_wheels;
  const double rate = op.scheme.velocity_rate();
  const auto impedance = [&](int i, int k) {
    const int a = i % per_vehicle, b = k % per_vehicle;
    return Vector3d(wheels.stiffness()(a, b), wheels.damping()(a, b), wheels.mass()(a, b));
  };
  ws.system.setIdentity(wheelsets, wheelsets);
  ws.force = free_force;
  for (int i = 0; i < wheelsets; ++i) {
    const int first = i - i % per_vehicle;
    for (int k = first; k < first + per_vehicle; ++k) ws.force[i] += impedance(i, k).dot(free[index(k)]);
  }
  for (const LineCoupling& c : couplings) {
    const Vector3d heave = followed(c.line, rate * c.line, op.scheme.acceleration_rate() * c.line[0], run);
    const int first = c.i - c.i % per_vehicle;
    for (int i = first; i < first + per_vehicle; ++i) ws.system(i, c.j) += impedance(i, c.i).dot(heave);
  }
  ws.force = ws.system.partialPivLu().solve(ws.force).eval();
}

// What the parts of one step hand on to each other. Lines are (displacement, slope, curvature) of the rails' mean under
// each wheelset, increments over the structure's predictor.
struct Lines {
  Running run;
  std::vector<RailContact> contacts;  // two per wheelset, none on rigid track
  std::vector<LineCoupling> couplings;
  std::vector<Vector3d> known;      // (z, v, a) of irregularity and predictor
  std::vector<Vector3d> free;       // increment without contact forces
  std::vector<Vector3d> increment;  // with them
};

// (z, v, a) of wheelset w for an increment of its line.
Vector3d heave(const HhtScheme& hht, const Lines& lines, int w, const Vector3d& increment) {
  return lines.known[index(w)] +
         followed(increment, hht.velocity_rate() * increment, hht.acceleration_rate() * increment[0], lines.run);
}

// Vehicles: what is known of their equations before the wheelsets' heave; returns the forces that no heave needs.
Eigen::VectorXd free_vehicles(const VsiModel& model, const StepOperators& op, const VsiState& state,
                              StepWorkspace& ws) {
  const int per_vehicle = model.wheelsets_per_vehicle();
  Eigen::VectorXd force(model.wheelsets());
  ws.rigid_wheels.R.resize(model.vehicle_x.size());
  for (int v = 0; v < static_cast<int>(model.vehicle_x.size()); ++v) {
    Eigen::VectorXd& R = ws.rigid_wheels.R[index(v)];
    const LinearMotion& motion = state.vehicle[index(v)];
    vehicle_step_load(model, op.scheme, v, state.time, motion, ws.vehicle_load);
    op.rigid_wheels->remainder(model.vehicle, op.vehicle_damping, op.scheme, ws.vehicle_load, motion,
                               ws.vehicle_prediction[index(v)], R);
    force.segment(per_vehicle * v, per_vehicle) = op.rigid_wheels->free_force(R);
  }
  return force;
}

// The line that supports carry the rails along, as the wheels of every wheelset follow it.
void add_carried(const VsiModel& model, double time, Lines& lines) {
  const StructureSupports& supports = model.structure->supports;
  if (!model.ground_motion || supports.carried.size() == 0) return;
  const SupportMotion motion = support_motion(*model.ground_motion, supports.x, time);
  for (int w = 0; w < model.wheelsets(); ++w) {
    const auto line = [&](const Eigen::VectorXd& translations) -> Vector3d {
      CarriedHead mean = CarriedHead::Zero();
      for (int side = 0; side < 2; ++side)
        mean += 0.5 * carried_head(lines.contacts[index(2 * w + side)], supports, translations);
      return {mean[1], -mean[4], mean[5]};
    };
    lines.known[index(w)] +=
        followed(line(motion.displacement), line(motion.velocity), line(motion.acceleration)[0], lines.run);
  }
}

// What the wheels would follow without contact forces at t + dt: the forward half of the structure's back-substitution.
Lines free_lines(const VsiModel& model, const StepOperators& op, const VsiState& state, double time,
                 StepWorkspace& ws) {
  Lines lines;
  lines.run = {model.speed(time), model.acceleration(time)};
  lines.contacts = place_wheels(model, time);
  lines.free.assign(index(model.wheelsets()), Vector3d::Zero());
  lines.increment = lines.free;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const VerticalDeviation d = vertical_deviation(model, w, time);
    lines.known.emplace_back(d.z, d.rate, d.acceleration);
    if (model.structure && lines.contacts[index(2 * w)].on_rail) continue;
    const VerticalDeviation ground = ground_under(model, w, time);
    lines.known.back() += Vector3d(ground.z, ground.rate, ground.acceleration);
  }
  if (!model.structure) return lines;
  begin_structure(model, op, state, lines.contacts, ws);
  const Prediction& p = ws.structure_prediction;
  lines.couplings = line_couplings(op, lines.contacts);
  for (int w = 0; w < model.wheelsets(); ++w) {
    const RailContact* contact = &lines.contacts[index(2 * w)];
    lines.known[index(w)] +=
        followed(mean_line(contact, p.displacement), mean_line(contact, p.velocity), 0.0, lines.run);
    lines.free[index(w)] = mean_line(contact, ws.structure_free);
  }
  add_carried(model, time, lines);
  return lines;
}

// Forces from the compliance at hand and the far field.
void solve_contact_forces(const VsiModel& model, const StepOperators& op, const Eigen::VectorXd& free_force,
                          Lines& lines, StepWorkspace& ws) {
  std::vector<Vector3d> free(lines.free.size());
  for (int w = 0; w < model.wheelsets(); ++w) {
    lines.increment[index(w)] = lines.free[index(w)] + ws.far_field.segment<3>(3 * w);
    free[index(w)] = heave(op.scheme, lines, w, lines.increment[index(w)]);
  }
  solve_forces(model, op, lines.run, lines.couplings, free, free_force, ws.rigid_wheels);
  for (const LineCoupling& c : lines.couplings) lines.increment[index(c.i)] -= c.line * ws.rigid_wheels.force[c.j];
  set_vertical_forces(ws.rigid_wheels.force, ws.solution);
}

// Response of the structure to the contact forces, under the wheels; returns what the forces' solution had missed of
// it.
double answer_under_wheels(const StepOperators& op, Lines& lines, StepWorkspace& ws) {
  for (int dof : ws.rail_dofs) ws.structure_load[dof] = 0.0;
  add_rail_forces(lines.contacts, ws.solution.force, ws.structure_load);
  ws.structure_solution.respond(op.structure->factor(), op.scheme.load_weight(), ws.structure_load, ws.structure_free);
  double missed = 0.0;
  for (int w = 0; w < static_cast<int>(lines.increment.size()); ++w) {
    const Vector3d miss = mean_line(&lines.contacts[index(2 * w)], ws.structure_free) - lines.increment[index(w)];
    missed = std::max(missed, miss.cwiseAbs().maxCoeff());
    ws.far_field.segment<3>(3 * w) += miss;
    lines.increment[index(w)] += miss;
  }
  return missed;
}

void close_vehicles(const VsiModel& model, const StepOperators& op, const Lines& lines, VsiState& state,
                    StepWorkspace& ws) {
  const int per_vehicle = model.wheelsets_per_vehicle();
  WheelsetHeave moved{Eigen::VectorXd(per_vehicle), Eigen::VectorXd(per_vehicle), Eigen::VectorXd(per_vehicle)};
  for (int v = 0; v < static_cast<int>(model.vehicle_x.size()); ++v) {
    for (int i = 0; i < per_vehicle; ++i) {
      const int w = per_vehicle * v + i;
      const Vector3d h = heave(op.scheme, lines, w, lines.increment[index(w)]);
      moved.z[i] = h[0];
      moved.v[i] = h[1];
      moved.a[i] = h[2];
      ws.solution.displacement[wheelset_unknowns * w + 2] = h[0];
    }
    op.rigid_wheels->update(op.scheme, ws.vehicle_prediction[index(v)], ws.rigid_wheels.R[index(v)], moved,
                            ws.rigid_wheels.force.segment(per_vehicle * v, per_vehicle), state.vehicle[index(v)]);
  }
}

}  // namespace

StepReport advance_rigid_wheels(const VsiModel& model, const StepOperators& op, const StepLimits& limits,
                                VsiState& state, StepWorkspace& ws) {
  StepReport report;
  const double time = state.time + op.scheme.time_step;
  Eigen::VectorXd free_force;
  {
    const Stopwatch watch(report.seconds_vehicle);
    free_force = free_vehicles(model, op, state, ws);
  }
  Lines lines;
  {
    const Stopwatch watch(report.seconds_structure);
    lines = free_lines(model, op, state, time, ws);
    if (model.structure) ++report.back_substitutions;
  }
  ws.far_field = state.far_field;

  // The constraint of Eq. 14 with its time derivatives, condensed to the forces; the structure's answer closes it.
  for (int pass = 0; pass < limits.max_passes && !report.converged; ++pass) {
    {
      const Stopwatch watch(report.seconds_contact);
      solve_contact_forces(model, op, free_force, lines, ws);
      ++report.newton_iterations;
    }
    if (!ws.rigid_wheels.force.allFinite()) break;  // the system of the forces is singular
    if (!model.structure) {
      report.converged = true;
      break;
    }
    const Stopwatch watch(report.seconds_structure);
    report.converged = answer_under_wheels(op, lines, ws) < limits.far_field_tolerance;
  }
  if (!report.converged) return report;

  {
    const Stopwatch watch(report.seconds_vehicle);
    close_vehicles(model, op, lines, state, ws);
  }
  if (model.structure) {
    const Stopwatch watch(report.seconds_structure);
    const DofRange& active = op.structure->active();
    ws.structure_solution.finish(op.structure->factor(), ws.structure_increment);
    active.of(state.structure.contact_load) = active.of(ws.structure_load);
    update(op.scheme, ws.structure_prediction, ws.structure_increment, active, state.structure);
  }
  std::swap(state.contact, ws.solution);
  state.far_field = ws.far_field;
  state.time = time;
  return report;
}

}  // namespace railtab
