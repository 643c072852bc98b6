#include "railtab/runtime/vsi/contact_newton.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_evaluation.hpp"
#include "railtab/runtime/vsi/contact_inverse.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;

// Evaluations of one contact solution in which the published method searches its pairs.
constexpr int paper_searches = 4;

// K_h of F_n = K_h d^{3/2}, rounded up [N/m^{3/2}]: a wheel's on a rail is 1e11 at most.
constexpr double stiffest_contact = 1e11;

// q_free + C f − q
void residual(const ContactProblem& problem, const ContactSolution& s, Eigen::VectorXd& r) {
  r = problem.free - s.displacement;
  const int wheelsets = static_cast<int>(r.size()) / wheelset_unknowns;
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
  if (problem.elements) problem.elements->respond(s.force, r);
}

// Whether the forces are those at the end of a time step and their derivatives of displacement and velocity apart
// known: the published method's contact points jump, and a mean over the step has its start in it.
bool of_step_end(const ContactProblem& problem, const NewtonWorkspace& ws) {
  return !problem.start && problem.wheelsets_per_group == 1 && problem.rail_velocity_rate > 0.0 && ws.found.empty();
}

// Displacement and velocity of a wheelset's contacts, the rails' deviations included.
void contact_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset,
                    Eigen::Ref<Eigen::Matrix<double, wheelset_unknowns, 1>> displacement,
                    Eigen::Ref<Eigen::Matrix<double, wheelset_unknowns, 1>> velocity) {
  const WheelsetMotion motion = wheelset_motion(problem, q, wheelset);
  displacement.head<6>() = motion.displacement;
  velocity.head<6>() = motion.velocity;
  for (int side = 0; side < 2; ++side) {
    const RailHeadMotion rail = rail_motion(problem, q, wheelset, side);
    displacement.segment<3>(6 + 3 * side) = rail.displacement;
    velocity.segment<3>(6 + 3 * side) = rail.velocity;
  }
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
double force_change(const NewtonWorkspace& ws, Wheelsets wheelsets) {
  double largest = 0.0;
  for (int w = wheelsets.first; w < wheelsets.end; ++w) {
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
              ContactSolution& solution, NewtonWorkspace& ws, InitialForces forces)
      : model_(model),
        problem_(problem),
        limits_(limits),
        first_order_(std::pow(limits.force_tolerance / stiffest_contact, 2.0 / 3.0)),
        rail_offset_(model.geometry->pair().rail_offset()),
        radius_(model.geometry->pair().nominal_radius()),
        s_(solution),
        ws_(ws) {
    const auto wheelsets = static_cast<int>(s_.displacement.size()) / wheelset_unknowns;
    const int groups = wheelsets / problem.wheelsets_per_group;
    ws.tangent.resize(index(wheelsets));
    ws.by_displacement.resize(index(wheelsets));
    ws.by_velocity.resize(index(wheelsets));
    for (Eigen::VectorXd* v : {&ws.evaluated, &ws.evaluated_force, &ws.before, &ws.before_force, &ws.correction}) {
      v->resize(s_.displacement.size());
    }
    ws.found.resize(model.geometry->is_paper() ? 2 * ws.tangent.size() : 0);
    ws.found_at.resize(ws.found.size());
    // The tangents of the step before serve as long as they are good enough, with the compliance of this one. A group
    // that has rested since the beginning has none yet.
    const bool fresh = ws.inverse.empty();
    ws.inverse.resize(index(groups));
    ws.compliance.resize(index(groups));
    ws.group.resize(index(groups));
    const bool known = forces == InitialForces::known;
    for (GroupNewton& n : ws.group) {
      n = {.moved = !known,
           .new_tangent = fresh || n.new_tangent,
           .slopes_known = !fresh && n.slopes_known,
           .tangent_error = fresh ? 1.0 : n.tangent_error};
    }
    if (known) return;
    s_.linearised = false;
    assemble_compliances(problem, ws);
    begin_tangents();
    for (int g = 0; g < groups; ++g) {
      if (!ws.group[index(g)].new_tangent) invert(problem, g, ws);
    }
    predicted_ = predict();
  }

  NewtonReport solve() {
    for (report_.iterations = 0; report_.iterations <= limits_.max_iterations; ++report_.iterations) {
      for (int g = 0; g < groups(); ++g) {
        if (ws_.group[index(g)].moved) evaluate_group(g);
      }
      if (!correct() || report_.converged) break;
    }
    return report_;
  }

 private:
  using Vector12 = Eigen::Matrix<double, wheelset_unknowns, 1>;
  using Turn = GroupNewton::Turn;

  [[nodiscard]] Wheelsets wheelsets(int group) const {
    return {group * problem_.wheelsets_per_group, (group + 1) * problem_.wheelsets_per_group};
  }
  [[nodiscard]] auto part_of(Eigen::VectorXd& vector, int group) const {
    const int size = wheelset_unknowns * problem_.wheelsets_per_group;
    return vector.segment(size * group, size);
  }

  // The tangents at the end of the last step, without what its corrections have taught.
  void begin_tangents() {
    ws_.tangent_rate = of_step_end(problem_, ws_) ? problem_.rail_velocity_rate : 0.0;
    if (!(ws_.tangent_rate > 0.0)) return;
    for (int g = 0; g < groups(); ++g) {
      if (!ws_.group[index(g)].slopes_known) ws_.group[index(g)].new_tangent = true;
      ws_.tangent[index(g)] = ws_.by_displacement[index(g)] + ws_.tangent_rate * ws_.by_velocity[index(g)];
    }
  }

  // Where the step would end if the forces followed the tangents from the end of the last step on: there the iteration
  // begins, with an error of second order. False where the last step is not known.
  bool predict() {
    constexpr int sweeps = 2;  // neighbours are weakly coupled
    const bool fresh = std::any_of(ws_.group.begin(), ws_.group.end(), [](const auto& n) { return n.new_tangent; });
    if (!ws_.last.known || fresh || !(ws_.tangent_rate > 0.0)) return false;
    for (int w = 0; w < groups(); ++w) {
      const auto k = wheelset_unknowns * w;
      Vector12 displacement, velocity;
      contact_motion(problem_, s_.displacement, w, displacement, velocity);
      displacement -= ws_.last.displacement.segment<wheelset_unknowns>(k);
      velocity -= ws_.last.velocity.segment<wheelset_unknowns>(k);
      s_.force.segment<wheelset_unknowns>(k) = ws_.last.force.segment<wheelset_unknowns>(k) +
                                               ws_.by_displacement[index(w)] * displacement +
                                               ws_.by_velocity[index(w)] * velocity;
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      residual(problem_, s_, ws_.residual);
      for (int g = 0; g < groups(); ++g) {
        const Vector12 move = ws_.inverse[index(g)] * part_of(ws_.residual, g);
        part_of(s_.displacement, g) += move;
        part_of(s_.force, g) += ws_.tangent[index(g)] * move;
      }
    }
    ws_.predicted_force = s_.force;
    return true;
  }

  [[nodiscard]] int groups() const { return static_cast<int>(ws_.group.size()); }

  // A correction of every group that asks for one. False where a number is not finite.
  bool correct() {
    residual(problem_, s_, ws_.residual);
    if (!ws_.residual.allFinite()) return false;
    for (int g = 0; g < groups(); ++g) examine(g);
    report_.correction = 0.0;
    report_.converged = true;
    for (int g = 0; g < groups(); ++g) {
      if (!rests(g)) report_.converged = false;
    }
    return true;
  }

  void evaluate_group(int g) {
    const bool searches = ws_.found.empty() || ++ws_.group[index(g)].evaluations <= paper_searches;
    report_.counts += evaluate(model_, problem_, searches ? Pairs::searched : Pairs::kept, wheelsets(g), s_, ws_);
    if (ws_.group[index(g)].turn != Turn::goes_back) {
      part_of(ws_.before, g) = part_of(ws_.evaluated, g);
      part_of(ws_.before_force, g) = part_of(ws_.evaluated_force, g);
    }
    part_of(ws_.evaluated, g) = part_of(s_.displacement, g);
    part_of(ws_.evaluated_force, g) = part_of(s_.force, g);
  }

  // Rails' motions as a wheelset sees them, which alone matter: less those of a rigid body with the wheelset.
  [[nodiscard]] Vector12 against_rails(const Vector12& m) const {
    Vector12 r = m;
    r.segment<3>(1).setZero();
    for (const int rail : {6, 9}) {
      const double aside = rail == 6 ? -rail_offset_ : rail_offset_;
      r.segment<3>(rail) -= Vector3(m[1] - radius_ * m[3], m[2] + aside * m[3], m[3]);
    }
    return r;
  }
  // The transpose.
  [[nodiscard]] Vector12 of_motion(const Vector12& r) const {
    Vector12 m = r;
    m.segment<3>(1).setZero();
    for (const int rail : {6, 9}) {
      const double aside = rail == 6 ? -rail_offset_ : rail_offset_;
      m.segment<3>(1) -= Vector3(r[rail], r[rail + 1], aside * r[rail + 1] + r[rail + 2] - radius_ * r[rail]);
    }
    return m;
  }

  // Broyden's update of a tangent: the least change that explains what a motion has changed the forces by, motions
  // counted by what they change them by, which they do in different units. The forces know a wheelset's motion against
  // its rails only, and so does the update.
  static constexpr double least_change =
      1.0;  // N, N m: well above the rounding of forces, from which nothing is learnt

  // From the last correction, for the corrections of this step.
  void learn(int g) {
    if (problem_.wheelsets_per_group > 1) return;
    const Matrix12& tangent = ws_.tangent[index(g)];
    const Vector12 move = part_of(ws_.evaluated, g) - part_of(ws_.before, g);
    const Vector12 moved = against_rails(move);
    const Vector12 counted = tangent.colwise().squaredNorm().transpose().cwiseProduct(moved);
    const double square = counted.dot(moved);
    const Vector12 change = part_of(ws_.evaluated_force, g) - part_of(ws_.before_force, g);
    if (!(square > 0.0) || change.cwiseAbs().maxCoeff() < least_change) return;
    const Vector12 expected = tangent * move, unexplained = change - expected;
    note_error(g, unexplained, expected);
    static_cast<void>(add_to_tangent(ws_, g, unexplained, of_motion(counted) / square));
  }

  // From the whole step so far, for this one and those to come: displacement and velocity move apart.
  void learn_from_prediction(int g) {
    const auto k = wheelset_unknowns * g;
    const Vector12 unexplained = part_of(s_.force, g) - part_of(ws_.predicted_force, g);
    if (unexplained.cwiseAbs().maxCoeff() < least_change) return;
    Vector12 displacement, velocity;
    contact_motion(problem_, s_.displacement, g, displacement, velocity);
    displacement = against_rails(displacement - ws_.last.displacement.segment<wheelset_unknowns>(k));
    velocity = against_rails(velocity - ws_.last.velocity.segment<wheelset_unknowns>(k));
    Matrix12 &by_displacement = ws_.by_displacement[index(g)], &by_velocity = ws_.by_velocity[index(g)];
    const Vector12 slow = by_displacement.colwise().squaredNorm().transpose().cwiseProduct(displacement);
    const Vector12 fast = by_velocity.colwise().squaredNorm().transpose().cwiseProduct(velocity);
    const double square = slow.dot(displacement) + fast.dot(velocity);
    if (!(square > 0.0)) return;
    const Vector12 of_slow = of_motion(slow) / square, of_fast = of_motion(fast) / square;
    if (!add_to_tangent(ws_, g, unexplained, of_slow + ws_.tangent_rate * of_fast)) return;
    by_displacement += unexplained * of_slow.transpose();
    by_velocity += unexplained * of_fast.transpose();
  }

  // How wrong the forces by the tangent have been, as a share of their change; it fades as later ones are better.
  void note_error(int g, const Vector12& unexplained, const Vector12& expected) {
    constexpr double fades = 0.9;
    double& error = ws_.group[index(g)].tangent_error;
    const double share = unexplained.cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
    error = std::min(1.0, std::max(share, fades * error));
  }

  // What a group's residual asks for, and where that is a correction, its tangent.
  void examine(int g) {
    constexpr double fast_enough = 0.5;           // of the residual, per iteration with a kept tangent
    constexpr double shortest_part = 1.0 / 32.0;  // of a correction that makes the residual worse
    GroupNewton& n = ws_.group[index(g)];
    const double size = part_of(ws_.residual, g).cwiseAbs().maxCoeff();
    n.turn = Turn::rests;
    if (size < limits_.tolerance || (n.moved && n.last)) return;
    n.turn = n.moved && size > 2.0 * n.previous && n.part > shortest_part ? Turn::goes_back : Turn::corrects;
    if (n.turn == Turn::goes_back) return;
    if (n.new_tangent || (n.moved && size > fast_enough * n.previous)) {
      differentiate(model_, problem_, wheelsets(g), s_, ws_);
      invert(problem_, g, ws_);
      n.slopes_known = of_step_end(problem_, ws_);
      n.new_tangent = false;
    } else if (n.moved && n.previous < std::numeric_limits<double>::infinity()) {
      learn(g);
    } else if (n.moved && predicted_) {
      learn_from_prediction(g);
    }
    n.gains = size < 0.5 * n.previous;
    n.previous = size;
    n.part = 1.0;
  }

  // Whether a group may stay where it is; if not, it has been moved on.
  bool rests(int g) {
    GroupNewton& n = ws_.group[index(g)];
    auto displacement = part_of(s_.displacement, g);
    auto correction = part_of(ws_.correction, g);
    const bool moved = n.moved;
    n.moved = false;
    if (n.turn == Turn::rests) return true;
    if (n.turn == Turn::goes_back) {
      // The last correction made it worse (a patch gained or lost, an old tangent): take half of it back.
      n.part *= 0.5;
      displacement = 0.5 * (displacement + part_of(ws_.before, g));
      n.moved = true;
      return false;
    }
    correction.noalias() = ws_.inverse[index(g)] * part_of(ws_.residual, g);
    const double change = correction.cwiseAbs().maxCoeff();
    report_.correction = std::max(report_.correction, change);
    if (change < first_order_) {
      const double by = force_change(ws_, wheelsets(g));
      if (by < rest_share * limits_.force_tolerance) return true;
      if (follows_tangent(g)) return false;
      if (by < limits_.force_tolerance) return true;
    }
    // A correction so small ends the iteration, and is made: the forces then are those of a far smaller one.
    n.last = change < limits_.tolerance || (!n.gains && change < limits_.rounding);
    if (n.last && !moved) return true;
    limit_moves(problem_, correction);
    displacement += correction;
    n.moved = true;
    return false;
  }

  // Makes a correction whose forces are those by the tangent, where they are right within the tolerance.
  bool follows_tangent(int g) {
    constexpr double safety = 2.0;
    if (!(ws_.tangent_rate > 0.0)) return false;
    const Vector12 correction = part_of(ws_.correction, g);
    const Vector12 way = part_of(s_.displacement, g) - part_of(ws_.evaluated, g) + correction;
    if (!(way.cwiseAbs().maxCoeff() < first_order_)) return false;
    const Matrix12& tangent = ws_.tangent[index(g)];
    const double change = Vector12(tangent * way).cwiseAbs().maxCoeff();
    const double error = std::min(1.0, safety * ws_.group[index(g)].tangent_error) * change;
    if (!(error < limits_.force_tolerance)) return false;
    const Vector12 force = tangent * correction;
    part_of(s_.displacement, g) += correction;
    part_of(s_.force, g) += force;
    part_of(s_.end_force, g) += force;
    s_.linearised = true;
    return true;
  }

  /// Share of the force tolerance that a correction must reach to be worth making by the tangent.
  static constexpr double rest_share = 0.1;

  const WheelContactModel& model_;
  const ContactProblem& problem_;
  const NewtonLimits& limits_;
  /// A wheel in the air, whose tangent is zero, gains no more than the tolerance by such a correction [m, rad].
  double first_order_;
  double rail_offset_, radius_;
  ContactSolution& s_;
  NewtonWorkspace& ws_;
  NewtonReport report_;
  bool predicted_ = false;  // whether the first evaluation has a prediction to compare with
};

}  // namespace

void remember_contacts(const ContactProblem& problem, const ContactSolution& solution, NewtonWorkspace& ws) {
  LastContacts& last = ws.last;
  last.force = solution.end_force;
  last.displacement.resize(last.force.size());
  last.velocity.resize(last.force.size());
  for (int w = 0; w < static_cast<int>(last.force.size()) / wheelset_unknowns; ++w) {
    const int k = wheelset_unknowns * w;
    contact_motion(problem, solution.displacement, w, last.displacement.segment<wheelset_unknowns>(k),
                   last.velocity.segment<wheelset_unknowns>(k));
  }
  last.known = true;
}

NewtonReport solve_contact(const WheelContactModel& model, const ContactProblem& problem, const NewtonLimits& limits,
                           ContactSolution& solution, NewtonWorkspace& workspace, InitialForces forces) {
  return TrainNewton(model, problem, limits, solution, workspace, forces).solve();
}

}  // namespace railtab
