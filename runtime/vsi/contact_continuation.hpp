#pragma once

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// solve_contact(), and where it fails a way round it. Creepages are velocities over the running speed: at walking pace
/// a wheel goes from rolling to sliding within nanometres of a step, and Newton leaps to and fro between the two
/// directions of sliding. The solution for a small share of the creepages, as at a higher speed, is easy; from there
/// the share grows to 1, each solution being the start of the next. What is found is a solution of the full problem.
/// @return iterations and look-ups of all attempts together
[[nodiscard]] NewtonReport solve_contact_by_continuation(const TrainContact& train, const ContactProblem& problem,
                                                         const NewtonLimits& limits, ContactSolution& solution,
                                                         NewtonWorkspace& workspace,
                                                         InitialForces forces = InitialForces::unknown);

}  // namespace railtab
