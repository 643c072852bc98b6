#pragma once

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// Where the published method has its pairs from: its search, or the last one, each pair moving with its bodies.
enum class Pairs { searched, kept };

/// Contact forces at the solution's displacement of the wheelsets first, ..., last - 1, and what they are made of.
void evaluate(const WheelContactModel& model, const ContactProblem& problem, Pairs pairs, int first, int last,
              ContactSolution& solution, NewtonWorkspace& workspace, NewtonReport& report);

/// The forces alone, of the last evaluation's loads, moved along (moved_loads()): near to evaluate(), for a fraction of
/// its cost.
void evaluate_moved(const WheelContactModel& model, const ContactProblem& problem, int first, int last,
                    ContactSolution& solution, const NewtonWorkspace& workspace);

/// df/dq of the wheelsets first, ..., last - 1, where evaluate() has found their patches.
void differentiate(const WheelContactModel& model, const ContactProblem& problem, int first, int last,
                   const ContactSolution& solution, NewtonWorkspace& workspace);

}  // namespace railtab
