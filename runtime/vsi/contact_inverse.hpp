#pragma once

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

using ContactVector = Eigen::Matrix<double, wheelset_unknowns, 1>;

/// C of every group.
void assemble_compliances(const ContactProblem& problem, NewtonWorkspace& workspace);

/// (I − C T)⁻¹ of the wheelsets of one group.
void invert(const ContactProblem& problem, int group, NewtonWorkspace& workspace);

/// T += u vᵀ of a group that is one wheelset; its inverse follows by Sherman's and Morrison's formula. False, and
/// nothing changed, where that is nearly singular.
[[nodiscard]] bool add_to_tangent(NewtonWorkspace& workspace, int group, const ContactVector& u,
                                  const ContactVector& v);

}  // namespace railtab
