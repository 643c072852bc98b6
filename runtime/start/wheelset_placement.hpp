#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// The contacts at rest: that of the springs alone. The damping's rate of penetration is zero there; the static
/// rails, whose material stands still while a train runs along their slopes, would say otherwise.
[[nodiscard]] TrainContact contact_at_rest(const VsiModel& model);

/// Where Newton's search for rest starts: rails as static wheel loads deflect them, and every wheelset lowered onto
/// them, level, until each wheel carries half its static load. From above the rails, with one wheel in the air or from
/// deep inside, its first corrections would be worth nothing.
/// @param contact contact_at_rest() @param problem at rest, with its deviations
/// @param displacement of the contact unknowns, zero before
void set_down(const VsiModel& model, const TrainContact& contact, const ContactProblem& problem,
              Eigen::VectorXd& displacement);

}  // namespace railtab
