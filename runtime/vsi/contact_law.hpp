#pragma once

#include <memory>
#include <vector>

#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

/// One step: the constants of the run, and where its wheels stand at t + Δt.
struct StepContext {
  const VsiModel& model;
  const StepOperators& operators;
  const StepLimits& limits;
  HhtScheme hht;                             ///< with the force rule of this step
  double begin, end;                         ///< t, t + Δt [s]
  const std::vector<RailContact>& contacts;  ///< two per wheelset; empty on rigid track
};

/// What a contact solution has come to.
enum class ContactSolve { changed, unchanged, diverged };

/// What stands between wheels and rails in a step: Hertz's contacts with creep forces, or wheels that follow the rails
/// (NormalContact). advance() calls these in turn; forces are exchanged through StepWorkspace::solution.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  /// Predictors of the vehicles and what is known of their right-hand side (Eq. 13) before the contact forces at the
  /// end of the step.
  virtual void predict_vehicles(const StepContext& step, const VsiState& state, StepWorkspace& ws) = 0;
  /// The contacts at t + Δt (Eqs. 14 and 15) and what the linear rest of train and structure does under contact forces.
  /// The structure is predicted, and without contact forces ws.structure_free is its increment under the wheels.
  virtual void present(const StepContext& step, const VsiState& state, StepWorkspace& ws) = 0;
  /// Contact forces of Eq. 16, condensed to the contacts. @param pass  0 first, then after each correct_far_field()
  virtual ContactSolve solve(const StepContext& step, int pass, StepWorkspace& ws, StepReport& report) = 0;
  /// Adds what the structure's response under the wheels, ws.structure_free, differs by from that in solve().
  /// @return the largest difference [m, rad]
  virtual double correct_far_field(const StepContext& step, StepWorkspace& ws) = 0;
  /// Motion of the vehicles and contact forces at t + Δt.
  virtual void close(const StepContext& step, VsiState& state, StepWorkspace& ws) = 0;
  /// Forgets what the iteration has kept from earlier steps, which no checkpoint has: a run resumed there and one that
  /// goes on are the same to the last bit only if both begin anew.
  virtual void reinitialise() = 0;
};

[[nodiscard]] std::unique_ptr<ContactLaw> make_contact_law(const VsiModel& model);
[[nodiscard]] std::unique_ptr<ContactLaw> make_hertz_contact(const VsiModel& model);
[[nodiscard]] std::unique_ptr<ContactLaw> make_rigid_wheels(const VsiModel& model);

}  // namespace railtab
