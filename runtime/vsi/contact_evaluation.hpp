#pragma once

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// Where the published method has its pairs from: its search, or the last one, each pair moving with its bodies.
enum class Pairs { searched, kept };

/// Neighbouring wheelsets of the train.
struct Wheelsets {
  int first, end;
};

/// Whether the table alone answered for a wheel, by its loaded part where it has one; else the online search did.
[[nodiscard]] inline bool answered_by_table(const ContactGeometry& geometry, const WheelContact& contact) noexcept {
  return geometry.loaded() ? !contact.by_patches() : contact.patches.from_table;
}

/// Contact forces at the solution's displacement, and what they are made of.
ContactCounts evaluate(const TrainContact& train, const ContactProblem& problem, Pairs pairs, Wheelsets wheelsets,
                       ContactSolution& solution, NewtonWorkspace& workspace);

/// Whether all wheels can be computed side by side in a time step, which must count the forces at its end.
[[nodiscard]] bool computes_side_by_side(const TrainContact& train, const ContactProblem& problem) noexcept;

/// evaluate() of those wheelsets of some whose wheels the loaded table answers alone; where each is a group of its own,
/// also differentiate() of those among them whose tangents err by more than 15 %, by their estimate, and of their
/// neighbours. workspace.computed says which. Contacts of the others are not set until evaluate() does.
/// @pre computes_side_by_side()
ContactCounts evaluate_side_by_side(const TrainContact& train, const ContactProblem& problem,
                                    std::span<const int> wheelsets, ContactSolution& solution,
                                    NewtonWorkspace& workspace);

/// df/dq where evaluate() has found the patches.
void differentiate(const TrainContact& train, const ContactProblem& problem, Wheelsets wheelsets,
                   const ContactSolution& solution, NewtonWorkspace& workspace);

}  // namespace railtab
