#include "railtab/runtime/vsi/contact_estimate.hpp"

#include <algorithm>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

ForceEstimate::Wheel ForceEstimate::wheel_at(const TrainContact& train, const ContactProblem& problem,
                                             const Eigen::VectorXd& displacement, std::size_t wheel) {
  constexpr int y = 1, yaw = 5;
  const int wheelset = static_cast<int>(wheel) / 2, side = static_cast<int>(wheel) % 2;
  const WheelContactModel& model = train[wheelset];
  const WheelsetMotion motion = wheelset_motion(problem, displacement, wheelset);
  const RailHeadMotion rail = rail_motion(problem, displacement, wheelset, side);
  return {relative_pose(model.geometry->pair(), wheel_sides[index(side)], motion, rail),
          motion.velocity[y] - rail.velocity[0] - model.speed * motion.displacement[yaw]};
}

// A wheel that presses deeper by a has the forces of a rail that has risen by a. One that slips faster across its rail
// by v has those of a rail that is slower across by v, which to the tangents is one that stands back by v / velocity
// rate; that the wheel stands deeper or less deep on such a rail is made up for.
void ForceEstimate::add_motion(const TrainContact& train, const ContactProblem& problem, const ContactSolution& start,
                               const NewtonWorkspace& workspace, ContactSolution& estimate) const {
  if (workspace.inverse.empty()) return;
  for (std::size_t wheel = 0; wheel < end_.size(); ++wheel) {
    const auto number = static_cast<int>(wheel);
    Wheel now = wheel_at(train, problem, estimate.displacement, wheel);
    const double back = (now.slip - end_[wheel].slip) / velocity_rate_;
    now.pose.y += number % 2 == 0 ? back : -back;
    const double deeper = equivalent_descent(start.memory[wheel], start.normal[wheel], end_[wheel].pose, now.pose);
    const NewtonWorkspace::Matrix12& tangent = workspace.tangent[wheel / 2];
    const int across = rail_unknown(number) % wheelset_unknowns, down = across + 1;
    estimate.force.segment<wheelset_unknowns>(wheelset_unknowns * (number / 2)) -=
        back * tangent.col(across) + deeper * tangent.col(down);
  }
}

// Of each wheelset nothing, the last or the straight line through the last two, whichever would have left least in the
// step before.
void ForceEstimate::add_error(Eigen::VectorXd& force) const {
  if (known_ < steps) return;
  for (Eigen::Index k = 0; k < force.size(); k += wheelset_unknowns) {
    const auto part = [&](int step) { return error_[index(step)].segment<wheelset_unknowns>(k); };
    const double of_nothing = part(0).squaredNorm(), of_last = (part(0) - part(1)).squaredNorm(),
                 of_line = (part(0) - 2.0 * part(1) + part(2)).squaredNorm();
    if (of_line < std::min(of_last, of_nothing)) {
      force.segment<wheelset_unknowns>(k) += 2.0 * part(0) - part(1);
    } else if (of_last < of_nothing) {
      force.segment<wheelset_unknowns>(k) += part(0);
    }
  }
}

void ForceEstimate::add_to(const TrainContact& train, const ContactProblem& problem, const ContactSolution& start,
                           const NewtonWorkspace& workspace, bool goes_on, ContactSolution& estimate) {
  if (!problem.start) add_motion(train, problem, start, workspace, estimate);
  if (!goes_on || problem.rail_velocity_rate != velocity_rate_) known_ = 0;
  velocity_rate_ = problem.rail_velocity_rate;
  goes_on_ = goes_on;
  if (!goes_on) return;
  displacement_ = estimate.displacement;
  force_ = estimate.force;
  add_error(estimate.force);
}

void ForceEstimate::learn(const TrainContact& train, const ContactProblem& problem, const NewtonWorkspace& workspace,
                          const ContactSolution& end) {
  end_.resize(end.contact.size());
  for (std::size_t wheel = 0; wheel < end_.size(); ++wheel) {
    end_[wheel] = wheel_at(train, problem, end.displacement, wheel);
  }
  if (!goes_on_) return;
  std::rotate(error_.begin(), error_.end() - 1, error_.end());
  error_[0] = end.force - force_;
  for (std::size_t w = 0; w < workspace.tangent.size(); ++w) {
    const auto k = wheelset_unknowns * static_cast<Eigen::Index>(w);
    const Eigen::Matrix<double, wheelset_unknowns, 1> moved =
        end.displacement.segment<wheelset_unknowns>(k) - displacement_.segment<wheelset_unknowns>(k);
    error_[0].segment<wheelset_unknowns>(k) -= workspace.tangent[w].lazyProduct(moved);
  }
  known_ = std::min(known_ + 1, steps);
}

}  // namespace railtab
