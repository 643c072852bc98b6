#include "railtab/runtime/start/static_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/start/wheelset_placement.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/contact_continuation.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/rigid_wheels.hpp"

namespace railtab {

namespace {

// eps [1/s²]: below the square of any suspended mode, (2π·0.5 Hz)² = 10, and below what a free vehicle falls over with,
// about 4, so that K + eps M is regular; weaker ones leave Newton's method without direction where there is no
// friction.
constexpr double regularisation = 0.5;
constexpr double travel_between = 0.025;  // m: between the equilibria that velocity and acceleration are taken from
constexpr int max_iterations = 60;
constexpr int most_solves = 200;             // of a detour; those that lead anywhere take less than 80
constexpr double newton_tolerance = 1e-12;   // m, rad
constexpr double contact_tolerance = 1e-10;  // m, rad: of the contact unknowns
// Of the dofs: what rounding leaves of the wheel loads, over the weak eps M, moves them by some nm.
constexpr double dof_tolerance = 1e-7;  // m, rad
// Where iterations no longer gain, what rounding leaves of the forces is the end: it moves the contact unknowns by some
// 1e-9 and, over the weak eps M, the dofs by some 1e-7.
constexpr double contact_rounding = 2e-9, dof_rounding = 2e-6;  // m, rad
constexpr double out_of_balance = 1e-3;                         // of the static wheel load
constexpr double pitch_rate_compliance =
    1e-3;  // rad/s per N m: any value that lets Newton drive the axle's torque to zero

constexpr int pitch = 4;

// Displacements of rails under wheels from loads on rails under wheels.
std::vector<RailCoupling> all_couplings(const VsiModel& model, StructureResponse& structure,
                                        const std::vector<RailContact>& contacts) {
  const Eigen::MatrixXd compliance = structure.compliance_at(contacts);
  const int wheelsets = static_cast<int>(contacts.size()) / 2;
  std::vector<RailCoupling> rail;
  rail.reserve(index(wheelsets) * index(wheelsets));
  for (int i = 0; i < wheelsets; ++i) {
    for (int j = 0; j < wheelsets; ++j) {
      rail.push_back({i, j, compliance.block<6, 6>(6 * i, 6 * j)});
      if (model.normal_contact == NormalContact::rigid) continue;
      add_element_compliance(rail_heads(contacts, i), rail_heads(contacts, j), 1.0, rail.back().compliance);
    }
  }
  return rail;
}

// The linear parts at rest, made once.
class RestOperators {
 public:
  TrainContact contact;
  std::vector<SeparateSystem> systems;
  VehicleResponse vehicle;
  std::vector<ElementCompliance> elements;  // per system; none where the vehicle has no force elements
  std::shared_ptr<StructureResponse> structure;
  NewtonWorkspace newton;  ///< with the tangents of the last equilibrium, of the same train and contacts

  explicit RestOperators(const VsiModel& model)
      : contact(contact_at_rest(model)),
        systems(separate_systems(model.vehicle)),
        vehicle(model.vehicle, systems, regularisation) {
    for (const SeparateSystem& system : systems) {
      if (model.vehicle.elements.empty()) break;
      elements.emplace_back(model.vehicle, system, vehicle.inverse(), 1.0).leave_out_pitch();
    }
    if (!model.structure) return;
    structure =
        model.store ? model.store->at_rest(model.structure) : std::make_shared<StructureResponse>(model.structure);
  }

  // all_couplings() where the train stands at a time; kept, since equilibria return there, where they are not many.
  std::vector<RailCoupling> couplings(const VsiModel& model, double time, const std::vector<RailContact>& contacts) {
    if (kept_couplings(contacts.size()) == 0) return all_couplings(model, *structure, contacts);
    const auto known = couplings_.find(time);
    if (known != couplings_.end()) return known->second;
    return couplings_.emplace(time, all_couplings(model, *structure, contacts)).first->second;
  }

 private:
  std::map<double, std::vector<RailCoupling>> couplings_;
};

// The structure under a load and the wheels' forces. Equilibria are found under the wheels; the rest follows at the
// end.
class LoadedStructure {
 public:
  LoadedStructure(const StructureResponse& structure, const Eigen::VectorXd& load,
                  const std::vector<RailContact>& contacts)
      : factor_(structure.factor()) {
    for (const RailContact& contact : contacts) append_dofs(contact, dofs_);
    solution_.begin(factor_, load, {dofs_, {}});
  }

  // Without wheels, the displacement of what they stand on; writes nothing else.
  void respond(Eigen::VectorXd& displacement) { solution_.respond(factor_, displacement); }
  // The same with wheels. @return its largest change
  double respond(const Eigen::VectorXd& wheels, Eigen::VectorXd& displacement) {
    before_ = displacement(dofs_);
    solution_.respond(factor_, 1.0, wheels, displacement);
    return dofs_.empty() ? 0.0 : (displacement(dofs_) - before_).cwiseAbs().maxCoeff();
  }
  // The whole displacement.
  void finish(Eigen::VectorXd& displacement) { solution_.finish(factor_, displacement); }

 private:
  const SubstitutionFactor& factor_;
  std::vector<int> dofs_;
  DividedSubstitution solution_;
  Eigen::VectorXd before_;
};

// A vehicle whose wheelsets are where their contacts put them. What contact forces displace it by would say the same
// but for the rounding of those forces, which a contact's stiffness over that of eps M enlarges: by a million on steel.
class WheelsetConstraint {
 public:
  WheelsetConstraint(const VsiModel& model, const VehicleResponse& vehicle) {
    for (int k = 0; k < vehicle.compliance().rows(); ++k) {
      const int body = model.vehicle.wheelsets[index(k / 6)];
      const int dof = model.vehicle.dof[index(body)][index(k % 6)];
      if (dof == held || k % 6 == pitch) continue;
      unknown_.push_back(wheelset_unknowns * (k / 6) + k % 6);
      dof_.push_back(dof);
    }
    response_ = vehicle.inverse()(Eigen::all, dof_);
    compliance_.factor(vehicle.inverse()(dof_, dof_));
    first_unknown_ = wheelset_unknowns * model.wheelsets_per_vehicle();
  }

  // Moves the dofs of vehicle v to the wheelsets' displacement q; what that takes beside the contact forces [N, N m].
  double apply(int v, const Eigen::VectorXd& q, Eigen::VectorXd& dofs) const {
    if (dof_.empty()) return 0.0;
    Eigen::VectorXd apart(dofs(dof_));
    for (std::size_t i = 0; i < dof_.size(); ++i) {
      apart[static_cast<Eigen::Index>(i)] = q[first_unknown_ * v + unknown_[i]] - apart[static_cast<Eigen::Index>(i)];
    }
    Eigen::VectorXd force;
    compliance_.solve(apart, force);
    dofs += response_ * force;
    return force.cwiseAbs().maxCoeff();
  }

 private:
  std::vector<int> unknown_, dof_;
  Eigen::MatrixXd response_;
  LuFactor compliance_;
  int first_unknown_ = 0;
};

// A wheelset's pitch angle has no effect at rest: in its place stands the deviation from the nominal rotation, which is
// free of torque. No angle is left behind.
void clear_pitch(const VsiModel& model, Eigen::VectorXd& dofs) {
  for (int body : model.vehicle.wheelsets) {
    const int dof = model.vehicle.dof[index(body)][pitch];
    if (dof != held) dofs[dof] = 0.0;
  }
}

// Coefficient of friction of the w-th wheelsets of all vehicles, where each has the larger one of both its wheels and
// the least counts, since they share their compliances.
double friction_of_wheelsets(const VsiModel& model, int w, double time) {
  if (!model.rail_friction) return model.contact.friction;
  double least = INFINITY;
  for (int i = w; i < model.wheelsets(); i += model.wheelsets_per_vehicle()) {
    const double x = model.wheelset_x(i, time);
    least = std::min(least,
                     std::max(model.rail_friction->at(RailSide::left, x), model.rail_friction->at(RailSide::right, x)));
  }
  return least;
}

ContactProblem rest_problem(const VsiModel& model, RestOperators& rest, double time,
                            const std::vector<RailContact>& contacts) {
  const VehicleResponse& vehicle = rest.vehicle;
  ContactProblem problem;
  problem.wheelsets_per_vehicle = model.wheelsets_per_vehicle();
  problem.wheelsets_per_group = problem.wheelsets_per_vehicle;
  problem.free = problem.predicted = problem.predicted_velocity =
      Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets());
  problem.vehicle_compliance = vehicle.compliance();
  problem.coupled = vehicle.coupled();
  problem.velocity_rate[pitch] = 1.0;
  constexpr double least_friction = 1e-3;
  for (int w = 0; w < problem.wheelsets_per_vehicle; ++w) {
    const int k = 6 * w + pitch;
    // Without friction no torque depends on the rotation. With less friction than this, creep forces cannot balance the
    // torque of rails that slope. Such wheelsets begin in pure rolling.
    const bool free_pitch =
        problem.vehicle_compliance(k, k) > 0.0 && friction_of_wheelsets(model, w, time) >= least_friction;
    problem.vehicle_compliance.row(k).setZero();
    problem.vehicle_compliance.col(k).setZero();
    if (free_pitch) problem.vehicle_compliance(k, k) = pitch_rate_compliance;
  }
  if (rest.structure) problem.rail = rest.couplings(model, time, contacts);
  problem.largest_move = 1e-3;
  return problem;
}

// Track deviations by a share of themselves.
void scale(double share, std::vector<std::array<RailHeadMotion, 2>>& deviation) {
  for (std::array<RailHeadMotion, 2>& wheelset : deviation) {
    for (RailHeadMotion& rail : wheelset) {
      rail.displacement *= share;
      rail.velocity *= share;
      rail.yaw *= share;
      rail.slope *= share;
    }
  }
}

double largest_static_load(const VsiModel& model) {
  double load = 0.0;
  for (int w = 0; w < model.wheelsets_per_vehicle(); ++w)
    load = std::max(load, std::abs(wheel_load_at_rest(model.vehicle, w)));
  return load;
}

// Whether a wheel is not where it runs: its flange on top of the rail, where there is rest too but no train comes to by
// itself, or the wheel itself deep in the rail or below.
bool off_its_rail(const VsiModel& model, const ContactProblem& problem, const Eigen::VectorXd& displacement) {
  if (model.normal_contact != NormalContact::hertz) return false;
  constexpr double farthest = 15e-3;  // m: flanks lift a wheel by less, the tips of flanges by twice as much
  for (int w = 0; w < model.wheelsets(); ++w) {
    const double b = model.geometry_of(w).pair().tape_circle_offset();
    const double z = displacement[wheelset_unknowns * w + 2], roll = displacement[wheelset_unknowns * w + 3];
    for (int side = 0; side < 2; ++side) {
      const double below = rail_motion(problem, displacement, w, side).displacement[1] - z;
      if (std::abs(below - (side == 0 ? -b : b) * roll) > farthest) return true;
    }
  }
  return false;
}

// Shares of what rest is sought with, 1 but on the way there.
struct RestShares {
  double deviation = 1.0;  // of the track's deviations
  double load = 1.0;       // of vehicle_load()
  double E = 1.0;          // of the Young's modulus of wheel and rail
};

// Slopes of rails between the nodes of their elements, which the next solution's forces change little.
void add_element_slopes(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force,
                        ContactProblem& problem) {
  std::vector<RailHeadMotion> between;
  const Eigen::VectorXd on_rails = rail_part(force);
  element_motion(contacts, on_rails, on_rails, on_rails, 0.0, between);
  for (std::size_t wheel = 0; wheel < between.size(); ++wheel) {
    add_slopes(between[wheel], problem.deviation[wheel / 2][wheel % 2]);
  }
}

// Equilibrium at state.time with `structure_load` on the structure besides the wheels.
EquilibriumReport equilibrium_at(const RestShares& share, const VsiModel& model, RestOperators& rest,
                                 const Eigen::VectorXd& structure_load, VsiState& state) {
  EquilibriumReport report;
  const VehicleResponse& vehicle = rest.vehicle;
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  ContactProblem problem = rest_problem(model, rest, state.time, contacts);
  std::optional<LoadedStructure> structure;
  if (rest.structure) {
    structure.emplace(*rest.structure, structure_load, contacts);
    Eigen::VectorXd free = Eigen::VectorXd::Zero(structure_load.size());
    structure->respond(free);
    gather_rails(contacts, free, problem.free);
  }
  TrainContact contact = rest.contact;
  for (WheelContactModel& wheelset : contact.model) wheelset.normal.material.E *= share.E;
  const WheelsetConstraint constraint(model, vehicle);
  const double balanced = out_of_balance * largest_static_load(model);
  const NewtonLimits limits{.tolerance = newton_tolerance, .max_iterations = 100, .rounding = contact_rounding};
  const int vehicles = static_cast<int>(model.vehicle_x.size());
  std::vector<Eigen::VectorXd> load(index(vehicles));  // gravity and the loads that act at this time
  for (int v = 0; v < vehicles; ++v) {
    vehicle_load(model, v, state.time, load[index(v)]);
    load[index(v)] = share.load * load[index(v)] + model.vehicle.static_load;
  }

  std::optional<TrainElements> elements;
  if (!rest.elements.empty()) {
    elements.emplace(model.vehicle, model.vehicle_x.size());
    elements->compliance = &rest.elements;
    problem.elements = &*elements;
  }

  for (report.iterations = 0; report.iterations < max_iterations && !report.converged; ++report.iterations) {
    rail_deviation(model, contacts, state.time, state.structure.whole().displacement, problem.deviation);
    if (model.normal_contact == NormalContact::hertz) add_element_slopes(contacts, state.contact.force, problem);
    if (share.deviation < 1.0) scale(share.deviation, problem.deviation);
    for (int v = 0; v < vehicles; ++v) {
      const LinearMotion& motion = state.vehicle[index(v)];
      const Eigen::VectorXd free =
          vehicle.displacement(load[index(v)] + regularisation * (model.vehicle.mass * motion.displacement));
      gather_wheelsets(model, v, free, problem.free);
      if (!elements) continue;
      elements->begin_rest(v, motion.displacement, state.friction[index(v)], free);
    }
    for (int w = 0; w < model.wheelsets(); ++w) {
      problem.free[wheelset_unknowns * w + pitch] = state.contact.displacement[wheelset_unknowns * w + pitch];
    }
    if (model.normal_contact == NormalContact::hertz && report.iterations == 0 && state.contact.displacement.isZero()) {
      set_down(model, contact, problem, state.contact.displacement);
    }
    const Eigen::VectorXd contact_before = state.contact.displacement;
    if (model.normal_contact == NormalContact::rigid) {
      if (elements && report.iterations > 0) elements->respond(state.contact.force, problem.free);
      rest_on_rails(problem, state.contact);
      Eigen::VectorXd displacement = problem.free;
      if (elements) elements->respond(state.contact.force, displacement);
    } else if (!solve_contact_by_continuation(contact, problem, limits, state.contact, rest.newton).converged) {
      rest.newton.forget_tangents();
      ++report.iterations;
      return report;
    }

    const double change_before = report.change;
    report.change = 0.0;
    double unbalanced = 0.0;
    for (int v = 0; v < vehicles; ++v) {
      LinearMotion& motion = state.vehicle[index(v)];
      scatter_wheelset_forces(model, v, state.contact.force, motion.contact_load);
      if (elements) elements->add_end_force(v, motion.contact_load);
      Eigen::VectorXd next = vehicle.displacement(load[index(v)] + motion.contact_load +
                                                  regularisation * (model.vehicle.mass * motion.displacement));
      clear_pitch(model, next);
      unbalanced = std::max(unbalanced, constraint.apply(v, state.contact.displacement, next));
      report.change = std::max(report.change, (next - motion.displacement).cwiseAbs().maxCoeff());
      motion.displacement = next;
    }
    if (structure) {
      LinearMotion& motion = state.structure.whole();
      set_rail_forces(contacts, state.contact.force, motion);
      report.change = std::max(report.change, structure->respond(motion.contact_load, motion.displacement));
    }
    const double contact_change = (state.contact.displacement - contact_before).cwiseAbs().maxCoeff();
    const bool gains = report.change < 0.5 * change_before;
    report.converged = (contact_change < contact_tolerance && report.change < dof_tolerance) ||
                       (!gains && contact_change < 5.0 * contact_rounding && report.change < dof_rounding);
    // Nothing but where forces jump (wheels deep in their rails) and a correction of nothing is left of a residual that
    // has not vanished.
    if (report.converged && unbalanced > balanced) return {.iterations = report.iterations + 1};
  }
  if (structure) structure->finish(state.structure.whole().displacement);
  if (report.converged && off_its_rail(model, problem, state.contact.displacement)) report.converged = false;
  state.contact.step_load = state.contact.force;
  state.deflection.force = state.deflection.slope_force = rail_part(state.contact.force);
  state.deflection.rate.setZero();
  for (LinearMotion& motion : state.vehicle) motion.step_load = motion.contact_load;
  state.structure.loads().step_load = state.structure.loads().contact_load;
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

// What grows from where rest is easier to find to its full size, as a share of the way, and by which steps of it.
struct Growth {
  std::function<RestShares(double)> at;
  double first, least;
};

EquilibriumReport by_growing(const Growth& growth, const VsiModel& model, RestOperators& rest,
                             const Eigen::VectorXd& structure_load, VsiState& state, double& share) {
  VsiState reached = state;
  rest.newton.forget_tangents();
  EquilibriumReport report = equilibrium_at(growth.at(0.0), model, rest, structure_load, reached);
  int iterations = 0;
  share = 0.0;
  double step = growth.first;
  for (int solve = 0; solve < most_solves && report.converged && share < 1.0; ++solve) {
    state = reached;
    iterations += report.iterations;
    const double next = std::min(1.0, share + step);
    rest.newton.forget_tangents();  // of another share
    report = equilibrium_at(growth.at(next), model, rest, structure_load, state);
    if (report.converged) {
      reached = state;
      share = next;
      step = std::min(growth.first, 2.0 * step);
    } else if (step > growth.least) {
      step *= 0.5;
      report.converged = true;  // with the share before
    }
  }
  report.converged = report.converged && share == 1.0;
  report.iterations += iterations;
  return report;
}

// Wheels and rails of steel that grow stiffer: a wheel that sinks in by a tenth of a micrometre is lost to Newton's
// method when rails and vehicle move first.
std::optional<Growth> of_stiffness(const RestOperators& rest) {
  constexpr double largest_ratio = 4.0, smallest_ratio = 1.05;
  const double steel_share = ElasticMaterial{}.E / rest.contact.shared().normal.material.E,
               way = -std::log(steel_share);
  if (!(way > std::log(largest_ratio))) return std::nullopt;
  return Growth{[=](double share) { return RestShares{.E = std::pow(steel_share, 1.0 - share)}; },
                std::log(largest_ratio) / way, std::log(smallest_ratio) / way};
}

// A train that leans far, as wind presses it, from one that stands upright.
std::optional<Growth> of_loads(const VsiModel& model, double time) {
  Eigen::VectorXd load;
  for (int v = 0; v < static_cast<int>(model.vehicle_x.size()); ++v) {
    vehicle_load(model, v, time, load);
    if (!load.isZero(0.0)) return Growth{[](double share) { return RestShares{.load = share}; }, 0.25, 1.0 / 256.0};
  }
  return std::nullopt;
}

// From where the train stands, and if that leads nowhere by a detour.
EquilibriumReport equilibrium(const VsiModel& model, RestOperators& rest, const Eigen::VectorXd& structure_load,
                              VsiState& state) {
  const VsiState begin = state;
  EquilibriumReport report = equilibrium_at({}, model, rest, structure_load, state);
  double deviation_share = 1.0, load_share = 1.0, stiffness_share = 1.0;
  const auto detour = [&](const std::optional<Growth>& growth, double& share) {
    if (report.converged || !growth) return;
    state = begin;
    const int iterations = report.iterations;
    report = by_growing(*growth, model, rest, structure_load, state, share);
    report.iterations += iterations;
  };
  detour(of_stiffness(rest), stiffness_share);
  detour(of_loads(model, state.time), load_share);
  // a wheelset far beside its rails, which would have to climb
  detour(Growth{[](double share) { return RestShares{.deviation = share}; }, 0.25, 1.0 / 64.0}, deviation_share);
  report.deviation_share = report.converged ? 1.0 : deviation_share;
  report.load_share = report.converged ? 1.0 : load_share;
  return report;
}

// Wheelsets rise and roll as the rails do that they run along, deviations of the track and of the wheels. From heights
// that stand still a wheel of 1000 kg on a rigid rail would begin with an impact.
void follow_rails(const VsiModel& model, VsiState& state) {
  const std::vector<RailContact> contacts = place_wheels(model, state.time);
  std::vector<std::array<RailHeadMotion, 2>> rail;
  rail_deviation(model, contacts, state.time, Eigen::VectorXd::Zero(state.structure.dofs()), rail);
  const double V = model.speed(state.time);
  const TrainContact train = model.train_contact();
  const int per_vehicle = model.wheelsets_per_vehicle();
  for (int w = 0; w < model.wheelsets(); ++w) {
    const DofIndices& dof = model.vehicle.dof[index(model.vehicle.wheelsets[index(w % per_vehicle)])];
    const auto& [left, right] = rail[index(w)];
    const double left_z = left.velocity[1] + V * left.slope, right_z = right.velocity[1] + V * right.slope;
    const double distance = 2.0 * train[w].geometry->pair().tape_circle_offset();
    Eigen::VectorXd& velocity = state.vehicle[index(w / per_vehicle)].velocity;
    constexpr int z = 2, roll = 3;
    if (dof[z] != held) velocity[dof[z]] = 0.5 * (left_z + right_z);
    if (dof[roll] != held) velocity[dof[roll]] = (right_z - left_z) / distance;
  }
}

}  // namespace

EquilibriumReport static_equilibrium(const VsiModel& model, VsiState& state) {
  RestOperators rest(model);
  return equilibrium(model, rest, Eigen::VectorXd::Zero(state.structure.dofs()), state);
}

namespace {

// With the structure moving as a deflection that travels with the train.
EquilibriumReport travelling_equilibrium(const VsiModel& model, VsiState& state) {
  const double time_step = travel_between / model.contact.speed;
  RestOperators rest(model);
  Eigen::VectorXd inertia = Eigen::VectorXd::Zero(state.structure.dofs());
  EquilibriumReport report = equilibrium(model, rest, inertia, state);
  if (!model.structure || !report.converged || !(model.contact.speed > 0.0)) return report;

  // The load that the moving deflection's inertia and damping exert, from the deflection at rest: the first term of a
  // series in (V / critical speed)², and in what dampers bear over what springs do. A second pass settles the contacts.
  // Where the first term is no small one, nothing follows from it, and the structure rests.
  const VsiState at_rest = state;
  LinearMotion& structure = state.structure.whole();
  constexpr int passes = 4;
  constexpr double largest_term = 0.5;
  const double most = largest_term * structure.displacement.cwiseAbs().maxCoeff();
  double change = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < passes && report.steady && change > dof_tolerance; ++pass) {
    VsiState before = state;
    VsiState after = state;
    before.time -= time_step;
    after.time += time_step;
    for (VsiState* neighbour : {&before, &after}) {
      const EquilibriumReport r = equilibrium(model, rest, inertia, *neighbour);
      report.iterations += r.iterations;
      report.steady = report.steady && r.converged;
    }
    if (!report.steady) break;
    const Eigen::VectorXd &u = structure.displacement, &u_before = before.structure.whole().displacement,
                          &u_after = after.structure.whole().displacement;
    structure.velocity = (u_after - u_before) / (2.0 * time_step);
    structure.acceleration = (u_after - 2.0 * u + u_before) / (time_step * time_step);
    inertia = -(model.structure->mass * structure.acceleration) - model.structure->damping * structure.velocity;
    const Eigen::VectorXd displacement = structure.displacement;
    const EquilibriumReport r = equilibrium(model, rest, inertia, state);
    change = (structure.displacement - displacement).cwiseAbs().maxCoeff();
    report.iterations += r.iterations;
    report.steady = report.steady && r.converged && change < most;
  }
  if (!report.steady) state = at_rest;
  return report;
}

}  // namespace

EquilibriumReport steady_start(const VsiModel& model, VsiState& state) {
  const EquilibriumReport report = travelling_equilibrium(model, state);
  if (report.converged && model.normal_contact == NormalContact::hertz) follow_rails(model, state);
  return report;
}

}  // namespace railtab
