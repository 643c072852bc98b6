#pragma once

#include <memory>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

inline Vector6 pose(double y, double z, double yaw) { return Vector6{0.0, y, z, 0.0, 0.0, yaw}; }

/// The contacts of one wheelset, and their solutions at the start and the end of a step.
struct Chain {
  std::shared_ptr<const ContactGeometry> geometry = std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
  WheelContactModel model;
  ContactProblem problem;
  ContactSolution start, end;

  Chain() {
    model.geometry = geometry.get();
    model.speed = 30.0;
    problem.wheelsets_per_vehicle = problem.wheelsets_per_group = 1;
    problem.predicted = problem.predicted_velocity = Eigen::VectorXd::Zero(wheelset_unknowns);
    problem.deviation.resize(1);
    end.displacement = end.force = end.end_force = end.step_load = Eigen::VectorXd::Zero(wheelset_unknowns);
    end.rail_x.resize(2);
    end.normal.resize(2);
    end.creep_power.resize(2);
    end.pressure.resize(2);
    end.contact.resize(2);
    end.memory.resize(2);
    start = end;
  }

  /// Forces at the end of the step.
  Eigen::VectorXd force_after(const Eigen::VectorXd& q) {
    end.displacement = q;
    evaluate_contact(model, problem, end);
    return end.force;
  }
};

}  // namespace railtab
