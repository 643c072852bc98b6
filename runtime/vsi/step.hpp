#pragma once

#include <limits>

#include "railtab/runtime/vsi/contact_state.hpp"
#include "railtab/runtime/vsi/step_operators.hpp"
#include "railtab/runtime/vsi/step_times.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

class ContactLaw;

/// Whether a step stands. Any but `accepted` leaves the state as it was.
enum class StepOutcome {
  accepted,
  contact_state_changed,  ///< a wheel meets or leaves its rail, with tread or flange
  force_jumped,           ///< the vertical force of a wheel changes by more than StepLimits::force_jump
  diverged,               ///< Newton's method or the far-field correction does not converge
};

/// Events within a step that reject it.
enum class RejectedEvents { none, contact_change, contact_change_and_force_jump };

/// Where a step takes its contact geometry from.
enum class GeometrySource {
  model,   ///< as the scene has it
  search,  ///< the online search in place of a table
};

/// How a step is solved and when it stands.
struct StepLimits {
  NewtonLimits newton;
  double far_field_tolerance = 1e-9;  ///< largest rail displacement missing in the contact solution [m, rad]
  int max_passes = 6;                 ///< contact solutions per step
  ContactForceRule contact_force = ContactForceRule::endpoint;
  GeometrySource geometry = GeometrySource::model;
  RejectedEvents rejected = RejectedEvents::none;
  double force_jump = std::numeric_limits<double>::infinity();  ///< [N]
  double light_touch = 0.0;                                     ///< contact_change() [N]
};

struct StepReport {
  StepOutcome outcome = StepOutcome::diverged;
  ContactChange contact_change = ContactChange::none;
  int newton_iterations = 0;
  int back_substitutions = 0;  ///< forward and backward once through the whole factor of the structure
  ContactCounts counts;
  StepTimes times;
};

/// Buffers of a step, reused. The next step needs nothing that is in them, but that structure_load is zero outside of
/// rail_dofs.
struct StepWorkspace {
  std::vector<RailContact> contacts;  ///< StepContext
  StructureSolution structure;
  /// Unknowns of the structure that the wheels load at the end of the step, and those of the nodes ahead of them; under
  /// ContactForceRule::endpoint find_loaded() at its beginning, else not set.
  std::vector<int> rail_dofs, rail_dofs_ahead, past_rail_dofs;
  Eigen::VectorXd vehicle_load;                                       ///< of one vehicle
  Eigen::VectorXd structure_load;                                     ///< zero but for rail_dofs
  Eigen::VectorXd structure_predicted, structure_predicted_velocity;  ///< ã, ṽ at the rail_dofs
  Eigen::VectorXd structure_velocity;                                 ///< there at the beginning of the step
  Eigen::VectorXd structure_past, structure_free, far_field;
  ContactSolution solution;

  explicit StepWorkspace(const VsiModel& model);
};

/// One HHT step of the coupled system (Eqs. 12-16) under the contact law of the model (make_contact_law()).
[[nodiscard]] StepReport advance(const VsiModel& model, const StepOperators& operators, const StepLimits& limits,
                                 VsiState& state, ContactLaw& contacts, StepWorkspace& workspace);

/// Evaluates the contacts as the state has them at its time, for the step that begins there: needed with
/// ContactForceRule::energy where that state does not come from a step.
void evaluate_contact_at(const VsiModel& model, VsiState& state);

}  // namespace railtab
