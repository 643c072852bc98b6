// The time step with wheels that follow the rails (NormalContact::rigid).

#include <algorithm>

#include "railtab/runtime/vsi/step.hpp"
#include "stopwatch.hpp"

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

// Heave, its velocity and acceleration of a wheel at speed V on a line that has the values, slopes and curvatures
// `displacement`, and their material rates: d/dt = ∂/∂t + V ∂/∂x.
Vector3d followed(const Vector3d& displacement, const Vector3d& velocity, double acceleration, double V) {
  return {displacement[0], velocity[0] + V * displacement[1],
          acceleration + 2.0 * V * velocity[1] + V * V * displacement[2]};
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
void solve_forces(const VsiModel& model, const StepOperators& op, const std::vector<LineCoupling>& couplings,
                  const std::vector<Vector3d>& free, const Eigen::VectorXd& free_force, RigidWheelWorkspace& ws) {
  const int wheelsets = static_cast<int>(free_force.size());
  const int per_vehicle = model.wheelsets_per_vehicle();
  const RigidWheelResponse& wheels = *op.rigid_wheels;
  const double V = model.contact.speed;
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
    const Vector3d heave = followed(c.line, rate * c.line, op.scheme.acceleration_rate() * c.line[0], V);
    const int first = c.i - c.i % per_vehicle;
    for (int i = first; i < first + per_vehicle; ++i) ws.system(i, c.j) += impedance(i, c.i).dot(heave);
  }
  ws.force = ws.system.partialPivLu().solve(ws.force).eval();
}

}  // namespace

StepReport advance_rigid_wheels(const VsiModel& model, const StepOperators& op, const StepLimits& limits,
                                VsiState& state, StepWorkspace& ws) {
  StepReport report;
  const HhtScheme& hht = op.scheme;
  const double V = model.contact.speed;
  const double time = state.time + hht.time_step;
  const std::vector<RailContact> contacts = place_wheels(model, time);
  const int per_vehicle = model.wheelsets_per_vehicle();
  const int vehicles = static_cast<int>(model.vehicle_x.size());
  const int wheelsets = model.wheelsets();
  Eigen::VectorXd free_force(wheelsets);
  ws.rigid_wheels.R.resize(index(vehicles));
  {
    const Stopwatch watch(report.seconds_vehicle);
    for (int v = 0; v < vehicles; ++v) {
      Eigen::VectorXd& R = ws.rigid_wheels.R[index(v)];
      op.rigid_wheels->remainder(model.vehicle, op.vehicle_damping, hht, state.vehicle[index(v)],
                                 ws.vehicle_prediction[index(v)], R);
      free_force.segment(per_vehicle * v, per_vehicle) = op.rigid_wheels->free_force(R);
    }
  }

  // What the wheels would follow without contact forces at t + dt: (z, v, a) of the irregularity and of the rails.
  const Prediction& p = ws.structure_prediction;
  std::vector<Vector3d> known(index(wheelsets)), line(index(wheelsets)), increment(index(wheelsets));
  std::vector<LineCoupling> couplings;
  for (int w = 0; w < wheelsets; ++w) {
    const VerticalDeviation d = vertical_deviation(model, w, time);
    known[index(w)] = {d.z, d.rate, d.acceleration};
  }
  ws.far_field = state.far_field;
  if (model.structure) {
    const Stopwatch watch(report.seconds_structure);
    predict(hht, state.structure, ws.structure_prediction);
    op.structure->free_increment(*model.structure, hht, state.structure, p, ws.structure_free);
    ++report.back_substitutions;
    couplings = line_couplings(op, contacts);
    for (int w = 0; w < wheelsets; ++w) {
      const RailContact* contact = &contacts[index(2 * w)];
      known[index(w)] += followed(mean_line(contact, p.displacement), mean_line(contact, p.velocity), 0.0, V);
      line[index(w)] = mean_line(contact, ws.structure_free);
    }
  }
  const auto heave = [&](int w, const Vector3d& delta) {
    return Vector3d(known[index(w)] +
                    followed(delta, hht.velocity_rate() * delta, hht.acceleration_rate() * delta[0], V));
  };

  // Forces from the compliance at hand, then the structure's full answer; what that adds is the far field.
  std::vector<Vector3d> free(index(wheelsets));
  for (int pass = 0; pass < limits.max_passes && !report.converged; ++pass) {
    {
      const Stopwatch watch(report.seconds_contact);
      for (int w = 0; w < wheelsets; ++w) {
        free[index(w)] = heave(w, line[index(w)] + ws.far_field.segment<3>(3 * w));
      }
      solve_forces(model, op, couplings, free, free_force, ws.rigid_wheels);
      ++report.newton_iterations;
      for (int w = 0; w < wheelsets; ++w) increment[index(w)] = line[index(w)] + ws.far_field.segment<3>(3 * w);
      for (const LineCoupling& c : couplings) increment[index(c.i)] -= c.line * ws.rigid_wheels.force[c.j];
      set_vertical_forces(ws.rigid_wheels.force, ws.solution);
    }
    if (!model.structure) {
      report.converged = true;
      break;
    }
    const Stopwatch watch(report.seconds_structure);
    scatter_rail_forces(contacts, ws.solution.force, ws.structure_load);
    ws.structure_increment = ws.structure_free + hht.load_weight() * op.structure->solve(ws.structure_load);
    ++report.back_substitutions;
    double missed = 0.0;
    for (int w = 0; w < wheelsets; ++w) {
      const Vector3d miss = mean_line(&contacts[index(2 * w)], ws.structure_increment) - increment[index(w)];
      missed = std::max(missed, miss.cwiseAbs().maxCoeff());
      ws.far_field.segment<3>(3 * w) += miss;
      increment[index(w)] += miss;
    }
    report.converged = missed < limits.far_field_tolerance;
  }
  if (!report.converged) return report;

  const Stopwatch watch(report.seconds_vehicle);
  WheelsetHeave moved{Eigen::VectorXd(per_vehicle), Eigen::VectorXd(per_vehicle), Eigen::VectorXd(per_vehicle)};
  for (int v = 0; v < vehicles; ++v) {
    for (int i = 0; i < per_vehicle; ++i) {
      const int w = per_vehicle * v + i;
      const Vector3d h = heave(w, increment[index(w)]);
      moved.z[i] = h[0];
      moved.v[i] = h[1];
      moved.a[i] = h[2];
      ws.solution.displacement[wheelset_unknowns * w + 2] = h[0];
    }
    op.rigid_wheels->update(hht, ws.vehicle_prediction[index(v)], ws.rigid_wheels.R[index(v)], moved,
                            ws.rigid_wheels.force.segment(per_vehicle * v, per_vehicle), state.vehicle[index(v)]);
  }
  if (model.structure) {
    state.structure.contact_load = ws.structure_load;
    update(hht, p, ws.structure_increment, state.structure);
  }
  std::swap(state.contact, ws.solution);
  state.far_field = ws.far_field;
  state.time = time;
  return report;
}

}  // namespace railtab
