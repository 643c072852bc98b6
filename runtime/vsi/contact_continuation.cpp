#include "railtab/runtime/vsi/contact_continuation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace railtab {

namespace {

void add(const NewtonReport& attempt, NewtonReport& total) {
  total.converged = attempt.converged;
  total.iterations += attempt.iterations;
  total.correction = attempt.correction;
  total.counts += attempt.counts;
}

}  // namespace

NewtonReport solve_contact_by_continuation(const TrainContact& train, const ContactProblem& problem,
                                           const NewtonLimits& limits, ContactSolution& solution, NewtonWorkspace& ws,
                                           InitialForces forces) {
  constexpr std::array first_shares{1.0 / 16.0, 1.0 / 256.0, 1.0 / 4096.0};
  constexpr double largest_ratio = 4.0, smallest_ratio = 1.05;
  ws.continuation_start = solution.displacement;
  const Eigen::VectorXd& start = ws.continuation_start;
  NewtonReport report = solve_contact(train, problem, limits, solution, ws, forces);
  if (report.converged || train.shared().friction <= 0.0) return report;

  TrainContact part = train;
  const auto solve = [&](double share, const Eigen::VectorXd& from) {
    for (WheelContactModel& model : part.model) model.creepage_share = share;
    solution.displacement = from;
    ws.forget_tangents();  // of another law
    add(solve_contact(part, problem, limits, solution, ws), report);
    return report.converged;
  };
  Eigen::VectorXd reached;
  double share = 0.0;
  for (const double first : first_shares) {
    if (!solve(first, start)) continue;
    share = first;
    reached = solution.displacement;
    break;
  }
  for (double ratio = largest_ratio; share > 0.0 && share < 1.0;) {
    const double next = std::min(1.0, share * ratio);
    if (solve(next, reached)) {
      share = next;
      reached = solution.displacement;
      ratio = std::min(largest_ratio, ratio * ratio);
    } else {
      ratio = std::sqrt(ratio);
      if (ratio < smallest_ratio) break;
    }
  }
  return report;
}

}  // namespace railtab
