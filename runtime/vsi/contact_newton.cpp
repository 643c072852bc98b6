#include "railtab/runtime/vsi/contact_newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>

#include "railtab/runtime/algebra/inverse_side_by_side.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/lane_transpose.hpp"
#include "railtab/runtime/vsi/contact_evaluation.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"

namespace railtab {

namespace {

using Matrix12 = NewtonWorkspace::Matrix12;
using Computed = NewtonWorkspace::Computed;

// Evaluations of one contact solution in which the published method searches its pairs.
constexpr int paper_searches = 4;

// K_h of F_n = K_h d^{3/2}, rounded up [N/m^{3/2}]: a wheel's on a rail is 1e11 at most.
constexpr double stiffest_contact = 1e11;

// Of a wheelset: without the general kernel for products of matrices, which Eigen calls for twelve columns.
template <class Matrix, class Vector>
auto times(const Matrix& matrix, const Vector& vector) {
  return matrix.lazyProduct(vector);
}

// Groups of wheelsets, front first: single ones in a time step; at rest all of a vehicle, or of each separate system.
void find_groups(const ContactProblem& problem, int wheelsets, std::vector<WheelsetRange>& groups) {
  groups.clear();
  const int per_vehicle = problem.wheelsets_per_vehicle;
  for (int w = 0; w < wheelsets; ++w) {
    WheelsetRange group{w, w + 1};
    if (problem.wheelsets_per_group > 1) {
      const int first = w - w % per_vehicle;
      const WheelsetRange coupled =
          problem.coupled.empty() ? WheelsetRange{0, per_vehicle} : problem.coupled[index(w - first)];
      group = {first + coupled.first, first + coupled.end};
    }
    if (!groups.empty() && group.first < groups.back().end) {
      groups.back().end = std::max(groups.back().end, group.end);
    } else {
      groups.push_back(group);
    }
  }
}

// C of every group.
void assemble_compliances(const ContactProblem& problem, NewtonWorkspace& ws) {
  ws.group_of.resize(ws.tangent.size());
  for (std::size_t g = 0; g < ws.compliance.size(); ++g) {
    const auto [first, end] = ws.range[g];
    const int of_vehicle = first % problem.wheelsets_per_vehicle;
    const int size = wheelset_unknowns * (end - first);
    ws.compliance[g].setZero(size, size);
    for (int i = 0; i < end - first; ++i) {
      ws.group_of[index(first + i)] = static_cast<int>(g);
      for (int j = 0; j < end - first; ++j) {
        ws.compliance[g].block<6, 6>(wheelset_unknowns * i, wheelset_unknowns * j) =
            problem.vehicle_compliance.block<6, 6>(6 * (of_vehicle + i), 6 * (of_vehicle + j));
      }
    }
  }
  for (const RailCoupling& c : problem.rail) {
    const int g = ws.group_of[index(c.i)];
    if (ws.group_of[index(c.j)] != g) continue;
    const int first = ws.range[index(g)].first;
    ws.compliance[index(g)].block<6, 6>(rails_unknown(c.i - first), rails_unknown(c.j - first)) = c.compliance;
  }
}

// C of a group of a state of rest, less what its force elements take away. In a time step, where groups are single
// wheelsets, that is as small as their coupling.
Eigen::MatrixXd with_elements(const ContactProblem& problem, WheelsetRange group, const Eigen::MatrixXd& compliance) {
  if (!problem.elements || problem.wheelsets_per_group != problem.wheelsets_per_vehicle) return compliance;
  const Eigen::MatrixXd stiffening = problem.elements->stiffening(group);
  Eigen::MatrixXd result = compliance;
  for (int i = 0; i < group.end - group.first; ++i) {
    for (int j = 0; j < group.end - group.first; ++j) {
      result.block<6, 6>(wheelset_unknowns * i, wheelset_unknowns * j) -= stiffening.block<6, 6>(6 * i, 6 * j);
    }
  }
  return result;
}

// (I − C T)⁻¹ of a group of several wheelsets.
void invert_group(const ContactProblem& problem, int group, NewtonWorkspace& ws) {
  const WheelsetRange range = ws.range[index(group)];
  const Eigen::MatrixXd stiffened = with_elements(problem, range, ws.compliance[index(group)]);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(stiffened.rows(), stiffened.cols());
  for (int j = 0; j < range.end - range.first; ++j) {
    jacobian.middleCols<12>(12 * j) -= stiffened.middleCols<12>(12 * j) * ws.tangent[index(range.first + j)];
  }
  ws.inverse[index(group)] = dense_inverse(jacobian);
}

using SideBySide12 = MatricesSideBySide<wheelset_unknowns>;

// The transposes of matrices that stand by columns.
SideBySide12 transposed_side_by_side(const std::array<const double*, SideBySide12::count>& matrix) {
  SideBySide12 result;
  for (std::size_t q = 0; q < result.entry.size(); q += 4) {
    std::array<Pack, SideBySide12::count> part;
    for (std::size_t s = 0; s < part.size(); ++s) std::memcpy(&part[s], matrix[s] + q, sizeof part[s]);
    set_side_by_side<Lanes>(part, &result.entry[q]);
  }
  return result;
}

// (I − C T)⁻¹ of up to eight wheelsets side by side, transposed meanwhile. C couples the motions of the wheelset with
// each other, and those of its rails.
void invert_wheelsets(std::span<const int> wheelsets, NewtonWorkspace& ws) {
  constexpr int n = wheelset_unknowns, half = 6;
  std::array<const double*, SideBySide12::count> of_compliance, of_tangent;
  std::array<double*, SideBySide12::count> of_inverse;
  Matrix12 unused;
  for (std::size_t s = 0; s < of_tangent.size(); ++s) {
    const std::size_t w = index(wheelsets[std::min(s, wheelsets.size() - 1)]);
    of_compliance[s] = ws.compliance[w].data();
    of_tangent[s] = ws.tangent[w].data();
    ws.inverse[w].resize(n, n);
    of_inverse[s] = s < wheelsets.size() ? ws.inverse[w].data() : unused.data();
  }
  const SideBySide12 C = transposed_side_by_side(of_compliance), T = transposed_side_by_side(of_tangent);
  SideBySide12 jacobian;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      Lanes sum = Lanes{} + (i == j ? 1.0 : 0.0);
      for (int k = i < half ? 0 : half, end = k + half; k < end; ++k) sum -= C.at(k, i) * T.at(j, k);
      jacobian.at(j, i) = sum;
    }
  }
  invert_side_by_side(jacobian);
  set_apart(jacobian.entry.data(), jacobian.entry.size(), of_inverse);
}

// (I − C T)⁻¹ of groups.
void invert(const ContactProblem& problem, std::span<const int> groups, NewtonWorkspace& ws) {
  if (problem.wheelsets_per_group > 1) {
    for (int g : groups) invert_group(problem, g, ws);
    return;
  }
  constexpr std::size_t count = SideBySide12::count;
  for (std::size_t first = 0; first < groups.size(); first += count) {
    invert_wheelsets(groups.subspan(first, std::min(count, groups.size() - first)), ws);
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

// What a correction changes the contact forces of some wheelsets by, to first order; returns the largest [N, N m].
double find_force_change(Wheelsets wheelsets, NewtonWorkspace& ws) {
  double largest = 0.0;
  for (int w = wheelsets.first; w < wheelsets.end; ++w) {
    Eigen::Ref<Eigen::Matrix<double, wheelset_unknowns, 1>> change =
        ws.force_change.segment<wheelset_unknowns>(wheelset_unknowns * w);
    change = times(ws.tangent[index(w)], ws.correction.segment<wheelset_unknowns>(wheelset_unknowns * w));
    largest = std::max(largest, change.cwiseAbs().maxCoeff());
  }
  return largest;
}

// Newton of the whole train: groups of wheelsets iterate side by side, each with its own tangent and step control, and
// rest where they are while that is good enough.
class TrainNewton {
 public:
  TrainNewton(const TrainContact& train, const ContactProblem& problem, const NewtonLimits& limits,
              ContactSolution& solution, NewtonWorkspace& ws, InitialForces forces)
      : train_(train),
        problem_(problem),
        limits_(limits),
        first_order_(std::pow(limits.force_tolerance / stiffest_contact, 2.0 / 3.0)),
        known_(forces == InitialForces::known),
        s_(solution),
        ws_(ws),
        side_by_side_(computes_side_by_side(train, problem)) {
    const auto wheelsets = static_cast<int>(s_.displacement.size()) / wheelset_unknowns;
    find_groups(problem, wheelsets, ws.range);
    const auto groups = static_cast<int>(ws.range.size());
    ws.tangent.resize(index(wheelsets), Matrix12::Zero());
    ws.computed.resize(index(wheelsets), Computed::forces);
    ws.start.resize(s_.displacement.size());
    ws.start_force.resize(s_.displacement.size());
    ws.correction.resize(s_.displacement.size());
    ws.force_change.resize(s_.displacement.size());
    ws.found.resize(train.shared().geometry->is_paper() ? 2 * ws.tangent.size() : 0);
    ws.found_at.resize(ws.found.size());
    // The tangents of the step before serve as long as they are good enough, with the compliance of this one. A group
    // that has rested since the beginning has none yet.
    const bool fresh = ws.inverse.empty();
    ws.inverse.resize(index(groups));
    ws.compliance.resize(index(groups));
    ws.group.resize(index(groups));
    ws.tangent_error.resize(index(groups), 1.0);
    if (!known_) assemble_compliances(problem, ws);
    ws.to_invert.clear();
    for (int g = 0; g < groups; ++g) {
      GroupNewton& n = ws.group[index(g)];
      n = {.moved = !known_, .new_tangent = fresh || n.new_tangent, .extrapolated = known_ ? n.extrapolated : 0.0};
      if (!n.new_tangent && !known_) ws.to_invert.push_back(g);
    }
    invert(problem, ws.to_invert, ws);
    if (forces == InitialForces::estimated) predict(ws.to_invert);
  }

  NewtonReport solve() {
    for (report_.iterations = 0; report_.iterations <= limits_.max_iterations; ++report_.iterations) {
      evaluate_moved();
      if (!correct() || report_.converged) break;
    }
    return report_;
  }

 private:
  using Vector12 = Eigen::Matrix<double, wheelset_unknowns, 1>;
  using Turn = GroupNewton::Turn;

  [[nodiscard]] Wheelsets wheelsets(int group) const {
    return {ws_.range[index(group)].first, ws_.range[index(group)].end};
  }
  [[nodiscard]] auto part_of(Eigen::VectorXd& vector, int group) const {
    const auto [first, end] = ws_.range[index(group)];
    return vector.segment(wheelset_unknowns * first, wheelset_unknowns * (end - first));
  }

  [[nodiscard]] int groups() const { return static_cast<int>(ws_.group.size()); }

  // The correction that a group's residual asks for.
  void set_correction(int g) const {
    const Eigen::MatrixXd& inverse = ws_.inverse[index(g)];
    if (problem_.wheelsets_per_group > 1) {
      part_of(ws_.correction, g).noalias() = inverse * part_of(ws_.residual, g);
      return;
    }
    const int first = wheelset_unknowns * ws_.range[index(g)].first;
    const Eigen::Map<const Matrix12> of_wheelset(inverse.data());
    ws_.correction.segment<wheelset_unknowns>(first) =
        times(of_wheelset, ws_.residual.segment<wheelset_unknowns>(first));
  }

  // The first correction of groups whose tangents are known, from estimated forces.
  void predict(std::span<const int> known) {
    contact_residual(problem_, s_, ws_.residual);
    for (int g : known) {
      auto correction = part_of(ws_.correction, g);
      set_correction(g);
      limit_moves(problem_, correction);
      part_of(s_.displacement, g) += correction;
    }
  }

  // A correction of every group that asks for one. False where a number is not finite.
  bool correct() {
    contact_residual(problem_, s_, ws_.residual);
    if (!ws_.residual.allFinite()) return false;
    ws_.to_invert.clear();
    for (int g = 0; g < groups(); ++g) examine(g);
    invert(problem_, ws_.to_invert, ws_);
    report_.correction = 0.0;
    report_.converged = true;
    for (int g = 0; g < groups(); ++g) {
      if (!rests(g)) report_.converged = false;
    }
    return true;
  }

  void evaluate_moved() {
    if (side_by_side_) {
      ws_.to_evaluate.clear();
      for (int g = 0; g < groups(); ++g) {
        if (!ws_.group[index(g)].moved) continue;
        for (int w = wheelsets(g).first; w < wheelsets(g).end; ++w) ws_.to_evaluate.push_back(w);
      }
      report_.counts += evaluate_side_by_side(train_, problem_, ws_.to_evaluate, s_, ws_);
    }
    for (int g = 0; g < groups(); ++g) {
      if (!ws_.group[index(g)].moved) continue;
      ws_.group[index(g)].extrapolated = 0.0;
      evaluate_rest_of(g);
    }
  }

  // What has not been computed side by side.
  void evaluate_rest_of(int g) {
    const bool searches = ws_.found.empty() || ++ws_.group[index(g)].evaluations <= paper_searches;
    for (int w = wheelsets(g).first; w < wheelsets(g).end; ++w) {
      if (side_by_side_ && ws_.computed[index(w)] != Computed::nothing) continue;
      report_.counts += evaluate(train_, problem_, searches ? Pairs::searched : Pairs::kept, {w, w + 1}, s_, ws_);
    }
  }

  // Broyden's update of the tangent: the least change that explains what the last correction has changed the forces by,
  // motions counted by what they change them by, which they do in different units. The inverse follows by Sherman's
  // and Morrison's formula.
  void learn(int g) {
    constexpr double nearly_singular = 0.1;
    constexpr double kept_error = 0.7;    // of the last estimate, at least
    constexpr double least_change = 1.0;  // N, N m: well above the rounding of forces, from which nothing is learnt
    if (problem_.wheelsets_per_group > 1) return;
    Matrix12& tangent = ws_.tangent[index(g)];
    const Vector12 move = part_of(s_.displacement, g) - part_of(ws_.start, g);
    const Vector12 weighted = tangent.colwise().squaredNorm().transpose().cwiseProduct(move);
    const double square = weighted.dot(move);
    const Vector12 change = part_of(s_.force, g) - part_of(ws_.start_force, g);
    if (!(square > 0.0) || change.cwiseAbs().maxCoeff() < least_change) return;
    const Vector12 explained = times(tangent, move);
    const Vector12 unexplained = change - explained;
    double& error = ws_.tangent_error[index(g)];
    const double now = unexplained.cwiseAbs().maxCoeff() / explained.cwiseAbs().maxCoeff();
    error = std::min(std::max(now, kept_error * error), 1.0);
    Eigen::Map<Matrix12> inverse(ws_.inverse[index(g)].data());
    const Vector12 v = weighted / square;
    const Vector12 responded = times(Eigen::Map<const Matrix12>(ws_.compliance[index(g)].data()), unexplained);
    const Vector12 z = times(inverse, responded);
    const double denominator = 1.0 - v.dot(z);
    if (!(std::abs(denominator) > nearly_singular)) return;
    tangent += unexplained * v.transpose();
    const Eigen::Matrix<double, 1, wheelset_unknowns> row = times(v.transpose(), inverse) / denominator;
    inverse += z * row;
  }

  // A tangent that has been made anew.
  void take_tangent(int g, double error) {
    ws_.to_invert.push_back(g);
    ws_.group[index(g)].new_tangent = false;
    ws_.tangent_error[index(g)] = error;
  }

  // What a group's residual asks for, and where that is a correction, its tangent, whose inverse is still to be made.
  void examine(int g) {
    constexpr double fast_enough = 0.5;           // of the residual, per iteration with a kept tangent
    constexpr double shortest_part = 1.0 / 32.0;  // of a correction that makes the residual worse
    // A new tangent is exact where it is made. On rough track at 200 km/h in steps of 0.5 ms, nine of ten tangents err
    // by less than 1 % after one step and 6 % after five: 3 %, which corrects_by_tangent() multiplies by 1.2 per step,
    // is above both.
    constexpr double renewed_error = 0.03;
    GroupNewton& n = ws_.group[index(g)];
    const bool renewed =
        n.moved && problem_.wheelsets_per_group == 1 && ws_.computed[index(g)] == Computed::forces_and_tangent;
    if (renewed) take_tangent(g, renewed_error);
    const double size = part_of(ws_.residual, g).cwiseAbs().maxCoeff();
    n.turn = Turn::rests;
    if (size < limits_.tolerance || (n.moved && n.last)) return;
    n.turn = n.moved && size > 2.0 * n.previous && n.part > shortest_part ? Turn::goes_back : Turn::corrects;
    if (n.turn == Turn::goes_back) return;
    if (!renewed && (n.new_tangent || (n.moved && size > fast_enough * n.previous))) {
      differentiate(train_, problem_, wheelsets(g), s_, ws_);
      take_tangent(g, 1.0);
    } else if (!renewed && n.moved && n.previous < std::numeric_limits<double>::infinity()) {
      learn(g);
    }
    if (n.extrapolated > 0.0) return;  // the residual is not that of evaluated forces
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
      displacement = part_of(ws_.start, g) + n.part * correction;
      n.moved = true;
      return false;
    }
    set_correction(g);
    const double change = correction.cwiseAbs().maxCoeff();
    report_.correction = std::max(report_.correction, change);
    const double of_forces = find_force_change(wheelsets(g), ws_);
    if (change < first_order_ && of_forces < limits_.force_tolerance) {
      // Made all the same where that costs nothing: what is left of every step in the direction of the estimate's error
      // would do work on wheels that bounce.
      // Forces that were known, and to which the structure has responded, stay.
      if (!known_ && may_correct_by_tangent(g, of_forces)) move_by_tangent(g);
      return true;
    }
    if (corrects_by_tangent(g, of_forces)) return false;
    // A correction so small ends the iteration, and is made: the forces then are those of a far smaller one.
    n.last = change < limits_.tolerance || (!n.gains && change < limits_.rounding);
    if (n.last && !moved) return true;
    limit_moves(problem_, correction);
    part_of(ws_.start, g) = displacement;
    part_of(ws_.start_force, g) = part_of(s_.force, g);
    displacement += correction;
    n.moved = true;
    return false;
  }

  // Whether the tangent holds as far as a correction goes that changes forces by so much.
  [[nodiscard]] bool may_correct_by_tangent(int g, double of_forces) const {
    constexpr double least_load = 10.0;  // of the change: the tangent of a wheel about to lift holds no further
    if (problem_.start || problem_.wheelsets_per_group > 1 || !ws_.found.empty()) return false;
    const double lighter = std::min(s_.end_force[rail_unknown(2 * g) + 1], s_.end_force[rail_unknown(2 * g + 1) + 1]);
    return lighter >= least_load * (ws_.group[index(g)].extrapolated + of_forces);
  }

  void move_by_tangent(int g) {
    part_of(s_.displacement, g) += part_of(ws_.correction, g);
    part_of(s_.force, g) += part_of(ws_.force_change, g);
    part_of(s_.end_force, g) += part_of(ws_.force_change, g);
  }

  // Makes a correction of displacements and forces where the tangent is good enough for both. The estimate of its error
  // grows with every step that does so, until forces are evaluated again.
  bool corrects_by_tangent(int g, double of_forces) {
    constexpr double most = 20.0, accepted_error = 0.5;  // of the force tolerance
    constexpr double growth = 1.2;
    constexpr double most_slip = 1e-4;  // creepage: less than from sticking to sliding, whose tangent holds no further
    GroupNewton& n = ws_.group[index(g)];
    double& error = ws_.tangent_error[index(g)];
    const double sum = n.extrapolated + of_forces;
    if (!may_correct_by_tangent(g, of_forces) || sum >= most * limits_.force_tolerance ||
        error * sum >= accepted_error * limits_.force_tolerance || largest_approach(g) > first_order_ ||
        largest_slip_change(g) > most_slip) {
      return false;
    }
    if (n.extrapolated == 0.0) error *= growth;
    n.extrapolated = sum;
    move_by_tangent(g);
    return true;
  }

  // How much a correction changes the creepages of a wheelset at most. A train at walking pace slides after a move of a
  // tenth of a micrometre.
  [[nodiscard]] double largest_slip_change(int g) const {
    const auto c = ws_.correction.segment<wheelset_unknowns>(wheelset_unknowns * g);
    const double radius = train_[g].geometry->pair().nominal_radius();
    double largest = 0.0;
    for (Eigen::Index k = 0; k < 6; ++k) {
      largest = std::max(largest, std::abs(problem_.velocity_rate[k] * c[k]) * (k < 3 ? 1.0 : radius));
    }
    const double of_rails = problem_.rail_velocity_rate * c.tail<6>().cwiseAbs().maxCoeff();
    return std::max(largest, of_rails) / train_[g].creepage_speed();
  }

  // How much closer a correction brings wheel and rail at most [m]. Up to first_order_, a patch that it makes bears no
  // more than the force tolerance.
  [[nodiscard]] double largest_approach(int g) const {
    const auto c = ws_.correction.segment<wheelset_unknowns>(wheelset_unknowns * g);
    const WheelRailPair& pair = train_[g].geometry->pair();
    double largest = 0.0;
    for (int side = 0; side < 2; ++side) {
      const int r = 6 + 3 * side;
      const double across = side == 0 ? -pair.tape_circle_offset() : pair.tape_circle_offset();
      const double y = c[1] - pair.nominal_radius() * c[3] - c[r], z = c[2] + across * c[3] - c[r + 1];
      largest = std::max(largest, y * y + z * z);
    }
    return std::sqrt(largest);
  }

  const TrainContact& train_;
  const ContactProblem& problem_;
  const NewtonLimits& limits_;
  /// A wheel in the air, whose tangent is zero, gains no more than the tolerance by such a correction [m, rad].
  double first_order_;
  bool known_;  ///< whether the forces were those at its displacement when the iteration began
  ContactSolution& s_;
  NewtonWorkspace& ws_;
  bool side_by_side_;
  NewtonReport report_;
};

}  // namespace

void contact_residual(const ContactProblem& problem, const ContactSolution& s, Eigen::VectorXd& r) {
  r = problem.free - s.displacement;
  const int wheelsets = static_cast<int>(r.size()) / wheelset_unknowns;
  const int per_vehicle = problem.wheelsets_per_vehicle;
  for (int w = 0; w < wheelsets; ++w) {
    const int first = w - w % per_vehicle;
    const WheelsetRange coupled =
        problem.coupled.empty() ? WheelsetRange{0, per_vehicle} : problem.coupled[index(w - first)];
    for (int v = first + coupled.first; v < first + coupled.end; ++v) {
      r.segment<6>(wheelset_unknowns * w) += problem.vehicle_compliance.block<6, 6>(6 * (w - first), 6 * (v - first)) *
                                             s.force.segment<6>(wheelset_unknowns * v);
    }
  }
  for (const RailCoupling& c : problem.rail) {
    r.segment<6>(rails_unknown(c.i)) += c.compliance * s.force.segment<6>(rails_unknown(c.j));
  }
  if (problem.elements) problem.elements->respond(s.force, r);
}

NewtonReport solve_contact(const TrainContact& train, const ContactProblem& problem, const NewtonLimits& limits,
                           ContactSolution& solution, NewtonWorkspace& workspace, InitialForces forces) {
  return TrainNewton(train, problem, limits, solution, workspace, forces).solve();
}

}  // namespace railtab
