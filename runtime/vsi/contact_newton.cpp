#include "railtab/runtime/vsi/contact_newton.hpp"

#include <algorithm>
#include <cmath>

#include "stopwatch.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;

constexpr std::array<WheelSide, 2> sides{WheelSide::left, WheelSide::right};

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Evaluations of one contact solution in which the published method searches its pairs.
constexpr int paper_searches = 4;

// K_h of F_n = K_h d^{3/2}, rounded up [N/m^{3/2}]: a wheel's on a rail is 1e11 at most.
constexpr double stiffest_contact = 1e11;

// Where an evaluation has its contact pairs from.
enum class Pairs { searched, held };

ContactPatches wheel_patches(const WheelContactModel& model, std::size_t wheel, const WheelsetPose& pose, Pairs pairs,
                             NewtonWorkspace& ws) {
  if (model.without_table) return model.geometry->patches_without_table(pose);
  if (ws.found.empty()) return model.geometry->patches(pose);
  if (pairs == Pairs::held) return moved_patches(*model.geometry, ws.found[wheel], ws.found_at[wheel], pose);
  ws.found[wheel] = model.geometry->patches(pose);
  ws.found_at[wheel] = pose;
  return ws.found[wheel];
}

// Contact forces at q of the wheelsets first, ..., last - 1.
void evaluate(const WheelContactModel& model, const ContactProblem& problem, Pairs pairs, int first, int last,
              ContactSolution& s, NewtonWorkspace& ws, NewtonReport& report) {
  for (int w = first; w < last; ++w) {
    const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
    auto force = s.force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    auto end_force = s.end_force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    force.setZero();
    end_force.setZero();
    for (int side = 0; side < 2; ++side) {
      const RailHeadMotion rail = rail_motion(problem, s.displacement, w, side);
      const WheelSide wheel_side = sides[index(side)];
      const std::size_t number = index(2 * w + side);
      ContactPatches& patches = s.patches[number];
      const WheelsetPose pose = relative_pose(model.geometry->pair(), wheel_side, motion, rail);
      {
        const Stopwatch watch(report.counts.seconds_lookup);
        patches = wheel_patches(model, number, pose, pairs, ws);
      }
      if (pairs == Pairs::searched) {
        ++report.counts.queries;
        if (patches.from_table) ++report.counts.table_queries;
      }
      const WheelForce wheel = wheel_force(model, wheel_side, motion, rail, patches);
      const int r = 6 + 3 * side;
      end_force.head<6>() += wheel.wheelset;
      end_force.segment<3>(r) = wheel.rail;
      s.rail_x[number] = wheel.rail_x;
      report.counts.outside_creep_table += wheel.outside_creep_table;
      s.normal[number] = wheel.normal;
      s.memory[number] = remembered(model.geometry->pair(), pose, patches, wheel);
      if (problem.start) {
        const ContactMemory& start = problem.start->memory[number];
        const Vector9 share = problem.mean_weight *
                              (mean_force(model.geometry->pair(), start, pose, patches, wheel) - 0.5 * start.force());
        force.head<6>() += share.head<6>();
        force.segment<3>(r) = share.tail<3>();
      } else {
        force.head<6>() += wheel.wheelset;
        force.segment<3>(r) = wheel.rail;
      }
    }
  }
}

// df/dq of the wheelsets first, ..., last - 1, where evaluate() has found their patches.
void differentiate(const WheelContactModel& model, const ContactProblem& problem, int first, int last,
                   const ContactSolution& s, NewtonWorkspace& ws) {
  for (int w = first; w < last; ++w) {
    Matrix12& tangent = ws.tangent[index(w)];
    tangent.setZero();
    const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
    for (int side = 0; side < 2; ++side) {
      const RailHeadMotion rail = rail_motion(problem, s.displacement, w, side);
      const std::size_t number = index(2 * w + side);
      const ContactMemory* start = problem.start ? &problem.start->memory[number] : nullptr;
      const Matrix9 t = (start ? problem.mean_weight : 1.0) *
                        wheel_force_tangent(model, sides[index(side)], motion, rail, s.patches[number],
                                            problem.velocity_rate, problem.rail_velocity_rate, start);
      const int r = 6 + 3 * side;
      tangent.topLeftCorner<6, 6>() += t.topLeftCorner<6, 6>();
      tangent.block<6, 3>(0, r) += t.topRightCorner<6, 3>();
      tangent.block<3, 6>(r, 0) += t.bottomLeftCorner<3, 6>();
      tangent.block<3, 3>(r, r) += t.bottomRightCorner<3, 3>();
    }
  }
}

// q_free + C f − q
void residual(const ContactProblem& problem, const ContactSolution& s, Eigen::VectorXd& r) {
  r = problem.free - s.displacement;
  const int wheelsets = static_cast<int>(s.displacement.size()) / wheelset_unknowns;
  const int per_vehicle = problem.wheelsets_per_vehicle;
  for (int w = 0; w < wheelsets; ++w) {
    const int first = w - w % per_vehicle;
    for (int v = first; v < first + per_vehicle; ++v) {
      r.segment<6>(wheelset_unknowns * w) += problem.vehicle_compliance.block<6, 6>(6 * (w - first), 6 * (v - first)) *
                                             s.force.segment<6>(wheelset_unknowns * v);
    }
  }
  for (const RailCoupling& c : problem.rail) {
    r.segment<3>(rail_unknown(c.i)) += c.compliance * s.force.segment<3>(rail_unknown(c.j));
  }
}

// I − C T of the wheelsets of one group, factorised.
void factorise(const ContactProblem& problem, int group, NewtonWorkspace& ws) {
  const int wheelsets = problem.wheelsets_per_group;
  const int size = wheelset_unknowns * wheelsets;
  const int first = group * wheelsets;
  const int of_vehicle = first % problem.wheelsets_per_vehicle;
  ws.compliance.setZero(size, size);
  for (int i = 0; i < wheelsets; ++i) {
    for (int j = 0; j < wheelsets; ++j) {
      ws.compliance.block<6, 6>(12 * i, 12 * j) =
          problem.vehicle_compliance.block<6, 6>(6 * (of_vehicle + i), 6 * (of_vehicle + j));
    }
  }
  for (const RailCoupling& c : problem.rail) {
    const int i = c.i - 2 * first;
    const int j = c.j - 2 * first;
    if (i < 0 || j < 0 || i >= 2 * wheelsets || j >= 2 * wheelsets) continue;
    ws.compliance.block<3, 3>(rail_unknown(i), rail_unknown(j)) = c.compliance;
  }
  ws.jacobian.setIdentity(size, size);
  for (int j = 0; j < wheelsets; ++j) {
    ws.jacobian.middleCols<12>(12 * j).noalias() -= ws.compliance.middleCols<12>(12 * j) * ws.tangent[index(first + j)];
  }
  ws.factor[index(group)].compute(ws.jacobian);
}

// Holds every wheelset with its rails to the largest move, in its own proportions. Pitch turns no profile; where its
// unknown is a rate, its size says nothing.
void limit_moves(const ContactProblem& problem, Eigen::Ref<Eigen::VectorXd> correction) {
  constexpr int pitch = 4;
  for (int k = 0; k < correction.size(); k += wheelset_unknowns) {
    auto moves = correction.segment<wheelset_unknowns>(k);
    const double largest = std::max(moves.head<pitch>().cwiseAbs().maxCoeff(),
                                    moves.tail<wheelset_unknowns - pitch - 1>().cwiseAbs().maxCoeff());
    if (largest > problem.largest_move) moves *= problem.largest_move / largest;
  }
}

// What a correction changes the contact forces of some wheelsets by, to first order: the largest [N, N m].
double force_change(const NewtonWorkspace& ws, int first, int last) {
  double largest = 0.0;
  for (int w = first; w < last; ++w) {
    const Eigen::Matrix<double, wheelset_unknowns, 1> change =
        ws.tangent[index(w)] * ws.correction.segment<wheelset_unknowns>(wheelset_unknowns * w);
    largest = std::max(largest, change.cwiseAbs().maxCoeff());
  }
  return largest;
}

// Newton of the whole train: groups of wheelsets iterate side by side, each with its own tangent and step control, and
// rest where they are while that is good enough.
class TrainNewton {
 public:
  TrainNewton(const WheelContactModel& model, const ContactProblem& problem, const NewtonLimits& limits,
              ContactSolution& solution, NewtonWorkspace& ws)
      : model_(model),
        problem_(problem),
        limits_(limits),
        first_order_(std::pow(limits.force_tolerance / stiffest_contact, 2.0 / 3.0)),
        s_(solution),
        ws_(ws) {
    const auto wheelsets = static_cast<int>(s_.displacement.size()) / wheelset_unknowns;
    const int groups = wheelsets / problem.wheelsets_per_group;
    ws.tangent.resize(index(wheelsets));
    ws.start.resize(s_.displacement.size());
    ws.correction.resize(s_.displacement.size());
    ws.found.resize(model.geometry->is_paper() ? 2 * ws.tangent.size() : 0);
    ws.found_at.resize(ws.found.size());
    // The tangents of the step before serve as long as they are good enough, with the compliance of this one. A group
    // that has rested since the beginning has none yet.
    const bool fresh = ws.factor.empty();
    ws.factor.resize(index(groups));
    ws.group.resize(index(groups));
    for (int g = 0; g < groups; ++g) {
      GroupNewton& n = ws.group[index(g)];
      n = {.moved = !ws.forces_known, .new_tangent = fresh || n.new_tangent};
      if (!n.new_tangent && !ws.forces_known) factorise(problem, g, ws);
    }
    ws.forces_known = false;
  }

  NewtonReport solve() {
    const int groups = static_cast<int>(ws_.group.size());
    for (report_.iterations = 0; report_.iterations <= limits_.max_iterations; ++report_.iterations) {
      for (int g = 0; g < groups; ++g) {
        if (ws_.group[index(g)].moved) evaluate_group(g);
      }
      residual(problem_, s_, ws_.residual);
      if (!ws_.residual.allFinite()) break;
      report_.correction = 0.0;
      report_.converged = true;
      for (int g = 0; g < groups; ++g) {
        if (!rests(g)) report_.converged = false;
      }
      if (report_.converged) break;
    }
    return report_;
  }

 private:
  [[nodiscard]] int first_wheelset(int group) const { return group * problem_.wheelsets_per_group; }
  [[nodiscard]] auto part_of(Eigen::VectorXd& vector, int group) const {
    const int size = wheelset_unknowns * problem_.wheelsets_per_group;
    return vector.segment(size * group, size);
  }

  void evaluate_group(int g) {
    const bool searches = ws_.found.empty() || ++ws_.group[index(g)].evaluations <= paper_searches;
    evaluate(model_, problem_, searches ? Pairs::searched : Pairs::held, first_wheelset(g), first_wheelset(g + 1), s_,
             ws_, report_);
  }

  // Whether a group may stay where it is; if not, it has been moved on.
  bool rests(int g) {
    constexpr double fast_enough = 0.2;           // of the residual, per iteration with a kept tangent
    constexpr double shortest_part = 1.0 / 32.0;  // of a correction that makes the residual worse
    GroupNewton& n = ws_.group[index(g)];
    auto displacement = part_of(s_.displacement, g);
    auto correction = part_of(ws_.correction, g);
    const double size = part_of(ws_.residual, g).cwiseAbs().maxCoeff();
    const bool moved = n.moved;
    n.moved = false;
    if (size < limits_.tolerance || (moved && n.last)) return true;
    if (moved && size > 2.0 * n.previous && n.part > shortest_part) {
      // The last correction made it worse (a patch gained or lost, an old tangent): take half of it back.
      n.part *= 0.5;
      displacement = part_of(ws_.start, g) + n.part * correction;
      n.moved = true;
      return false;
    }
    if (n.new_tangent || (moved && size > fast_enough * n.previous)) {
      differentiate(model_, problem_, first_wheelset(g), first_wheelset(g + 1), s_, ws_);
      factorise(problem_, g, ws_);
      n.new_tangent = false;
    }
    const bool gains = size < 0.5 * n.previous;
    n.previous = size;
    n.part = 1.0;
    correction = ws_.factor[index(g)].solve(part_of(ws_.residual, g));
    const double change = correction.cwiseAbs().maxCoeff();
    report_.correction = std::max(report_.correction, change);
    if (change < first_order_ &&
        force_change(ws_, first_wheelset(g), first_wheelset(g + 1)) < limits_.force_tolerance) {
      return true;
    }
    // A correction so small ends the iteration, and is made: the forces then are those of a far smaller one.
    n.last = change < limits_.tolerance || (!gains && change < limits_.rounding);
    if (n.last && !moved) return true;
    limit_moves(problem_, correction);
    part_of(ws_.start, g) = displacement;
    displacement += correction;
    n.moved = true;
    return false;
  }

  const WheelContactModel& model_;
  const ContactProblem& problem_;
  const NewtonLimits& limits_;
  /// A wheel in the air, whose tangent is zero, gains no more than the tolerance by such a correction [m, rad].
  double first_order_;
  ContactSolution& s_;
  NewtonWorkspace& ws_;
  NewtonReport report_;
};

}  // namespace

ContactCounts& ContactCounts::operator+=(const ContactCounts& more) noexcept {
  queries += more.queries;
  table_queries += more.table_queries;
  outside_creep_table += more.outside_creep_table;
  seconds_lookup += more.seconds_lookup;
  return *this;
}

WheelsetMotion wheelset_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset) noexcept {
  const int k = wheelset_unknowns * wheelset;
  const Vector6 displacement = q.segment<6>(k);
  return {displacement, problem.predicted_velocity.segment<6>(k) +
                            problem.velocity_rate.cwiseProduct(displacement - problem.predicted.segment<6>(k))};
}

RailHeadMotion rail_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset, int side) noexcept {
  const int k = wheelset_unknowns * wheelset + 6 + 3 * side;
  RailHeadMotion motion = problem.deviation[index(wheelset)][index(side)];
  const Vector3 displacement = q.segment<3>(k);
  motion.displacement += displacement;
  motion.velocity += problem.predicted_velocity.segment<3>(k) +
                     problem.rail_velocity_rate * (displacement - problem.predicted.segment<3>(k));
  return motion;
}

NewtonReport evaluate_contact(const WheelContactModel& model, const ContactProblem& problem,
                              ContactSolution& solution) {
  NewtonReport report;
  NewtonWorkspace workspace;
  const int wheelsets = static_cast<int>(solution.displacement.size()) / wheelset_unknowns;
  evaluate(model, problem, Pairs::searched, 0, wheelsets, solution, workspace, report);
  return report;
}

NewtonReport solve_contact(const WheelContactModel& model, const ContactProblem& problem, const NewtonLimits& limits,
                           ContactSolution& solution, NewtonWorkspace& workspace) {
  return TrainNewton(model, problem, limits, solution, workspace).solve();
}

}  // namespace railtab
