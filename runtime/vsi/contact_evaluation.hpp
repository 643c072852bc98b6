#pragma once

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// Where the published method has its pairs from: its search, or the last one, each pair moving with its bodies.
enum class Pairs { searched, kept };

/// Neighbouring wheelsets of the train.
struct Wheelsets {
  int first, end;
};

/// Contact forces at the solution's displacement, and what they are made of.
ContactCounts evaluate(const WheelContactModel& model, const ContactProblem& problem, Pairs pairs, Wheelsets wheelsets,
                       ContactSolution& solution, NewtonWorkspace& workspace);

/// df/dq where evaluate() has found the patches.
void differentiate(const WheelContactModel& model, const ContactProblem& problem, Wheelsets wheelsets,
                   const ContactSolution& solution, NewtonWorkspace& workspace);

}  // namespace railtab
