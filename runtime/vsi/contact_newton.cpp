#include "railtab/runtime/vsi/contact_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stopwatch.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;

constexpr std::array<WheelSide, 2> sides{WheelSide::left, WheelSide::right};

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Evaluations of one contact solution in which the published method searches its pairs.
constexpr int paper_searches = 4;

// Where an evaluation has its contact pairs from.
enum class Pairs { searched, held };

ContactPatches wheel_patches(const WheelContactModel& model, std::size_t wheel, const WheelsetPose& pose, Pairs pairs,
                             NewtonWorkspace& ws) {
  if (ws.found.empty()) return model.geometry->patches(pose);
  if (pairs == Pairs::held) return moved_patches(*model.geometry, ws.found[wheel], ws.found_at[wheel], pose);
  ws.found[wheel] = model.geometry->patches(pose);
  ws.found_at[wheel] = pose;
  return ws.found[wheel];
}

// Contact forces at q, and with `tangents` their derivative per wheelset.
void evaluate(const WheelContactModel& model, const ContactProblem& problem, Pairs pairs, ContactSolution& s,
              NewtonWorkspace& ws, std::vector<Matrix12>* tangents, NewtonReport& report) {
  const int wheelsets = static_cast<int>(s.displacement.size()) / wheelset_unknowns;
  for (int w = 0; w < wheelsets; ++w) {
    const WheelsetMotion motion = wheelset_motion(problem, s.displacement, w);
    auto force = s.force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    auto end_force = s.end_force.segment<wheelset_unknowns>(wheelset_unknowns * w);
    force.setZero();
    end_force.setZero();
    if (tangents) (*tangents)[index(w)].setZero();
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
      const ContactMemory* start = problem.start ? &problem.start->memory[number] : nullptr;
      if (start) {
        const Vector9 share = problem.mean_weight *
                              (mean_force(model.geometry->pair(), *start, pose, patches, wheel) - 0.5 * start->force());
        force.head<6>() += share.head<6>();
        force.segment<3>(r) = share.tail<3>();
      } else {
        force.head<6>() += wheel.wheelset;
        force.segment<3>(r) = wheel.rail;
      }
      if (!tangents) continue;
      const Matrix9 t = (start ? problem.mean_weight : 1.0) * wheel_force_tangent(model, wheel_side, motion, rail,
                                                                                  patches, wheel, problem.velocity_rate,
                                                                                  problem.rail_velocity_rate, start);
      Matrix12& tangent = (*tangents)[index(w)];
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

// I − C T of every vehicle, factorised.
void factorise(const ContactProblem& problem, NewtonWorkspace& ws) {
  const int per_vehicle = problem.wheelsets_per_vehicle;
  const int size = wheelset_unknowns * per_vehicle;
  const int vehicles = static_cast<int>(ws.tangent.size()) / per_vehicle;
  ws.factor.resize(index(vehicles));
  for (int vehicle = 0; vehicle < vehicles; ++vehicle) {
    ws.compliance.setZero(size, size);
    for (int i = 0; i < per_vehicle; ++i) {
      for (int j = 0; j < per_vehicle; ++j) {
        ws.compliance.block<6, 6>(12 * i, 12 * j) = problem.vehicle_compliance.block<6, 6>(6 * i, 6 * j);
      }
    }
    const int first_wheel = 2 * per_vehicle * vehicle;
    for (const RailCoupling& c : problem.rail) {
      const int i = c.i - first_wheel;
      const int j = c.j - first_wheel;
      if (i < 0 || j < 0 || i >= 2 * per_vehicle || j >= 2 * per_vehicle) continue;
      ws.compliance.block<3, 3>(rail_unknown(i), rail_unknown(j)) = c.compliance;
    }
    ws.jacobian.setIdentity(size, size);
    for (int j = 0; j < per_vehicle; ++j) {
      ws.jacobian.middleCols<12>(12 * j).noalias() -=
          ws.compliance.middleCols<12>(12 * j) * ws.tangent[index(vehicle * per_vehicle + j)];
    }
    ws.factor[index(vehicle)].compute(ws.jacobian);
  }
}

// Correction of all vehicles: (I − C T) δ = r within each.
void correct(const ContactProblem& problem, NewtonWorkspace& ws) {
  const int size = wheelset_unknowns * problem.wheelsets_per_vehicle;
  ws.correction.resize(ws.residual.size());
  for (int vehicle = 0; vehicle < static_cast<int>(ws.factor.size()); ++vehicle) {
    ws.correction.segment(size * vehicle, size) =
        ws.factor[index(vehicle)].solve(ws.residual.segment(size * vehicle, size));
  }
}

// Holds every wheelset with its rails to the largest move, in its own proportions. Pitch turns no profile; where its
// unknown is a rate, its size says nothing.
void limit_moves(const ContactProblem& problem, Eigen::VectorXd& correction) {
  constexpr int pitch = 4;
  for (int k = 0; k < correction.size(); k += wheelset_unknowns) {
    auto moves = correction.segment<wheelset_unknowns>(k);
    const double largest = std::max(moves.head<pitch>().cwiseAbs().maxCoeff(),
                                    moves.tail<wheelset_unknowns - pitch - 1>().cwiseAbs().maxCoeff());
    if (largest > problem.largest_move) moves *= problem.largest_move / largest;
  }
}

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
  evaluate(model, problem, Pairs::searched, solution, workspace, nullptr, report);
  return report;
}

NewtonReport solve_contact(const WheelContactModel& model, const ContactProblem& problem, const NewtonLimits& limits,
                           ContactSolution& solution, NewtonWorkspace& ws) {
  constexpr double fast_enough = 0.2;           // of the residual, per iteration with a kept tangent
  constexpr double shortest_part = 1.0 / 32.0;  // of a correction that makes the residual worse
  NewtonReport report;
  ws.tangent.resize(static_cast<std::size_t>(solution.displacement.size() / wheelset_unknowns));
  const bool paper = model.geometry->is_paper();
  ws.found.resize(paper ? 2 * ws.tangent.size() : 0);
  ws.found_at.resize(ws.found.size());
  int evaluations = 0;
  const auto pairs = [&] { return paper && ++evaluations > paper_searches ? Pairs::held : Pairs::searched; };
  double previous = std::numeric_limits<double>::infinity();
  bool new_tangent = ws.factor.empty();  // that of the step before serves as long as it is good enough
  double part = 1.0;

  while (report.iterations < limits.max_iterations) {
    evaluate(model, problem, pairs(), solution, ws, new_tangent ? &ws.tangent : nullptr, report);
    residual(problem, solution, ws.residual);
    const double size = ws.residual.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return report;
    if (size < limits.tolerance) {
      report.converged = true;
      return report;
    }
    if (size > 2.0 * previous && part > shortest_part) {
      // The last correction made it worse (a patch gained or lost, an old tangent): take half of it back.
      part *= 0.5;
      solution.displacement = ws.start + part * ws.correction;
      ++report.iterations;
      continue;
    }
    if (!new_tangent && size > fast_enough * previous) {
      new_tangent = true;
      continue;
    }
    if (new_tangent) {
      factorise(problem, ws);
      new_tangent = false;
    }
    const bool gains = size < 0.5 * previous;
    previous = size;
    part = 1.0;
    correct(problem, ws);
    ++report.iterations;
    report.correction = ws.correction.cwiseAbs().maxCoeff();
    limit_moves(problem, ws.correction);
    ws.start = solution.displacement;
    solution.displacement += ws.correction;
    if (report.correction < limits.tolerance || (!gains && report.correction < limits.rounding)) {
      report.converged = true;
      break;
    }
  }
  // Forces at the corrected displacement, so that motion and forces belong together.
  evaluate(model, problem, pairs(), solution, ws, nullptr, report);
  return report;
}

}  // namespace railtab
