#pragma once

#include <limits>
#include <memory>

#include "railtab/runtime/algebra/divided_substitution.hpp"
#include "railtab/runtime/vsi/rigid_wheels.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What one time-step size needs: the factor of the structure and the inverse of a vehicle, made once, and the
/// compliance of the rails where the train is.
class StepOperators {
 public:
  HhtScheme scheme;
  Eigen::MatrixXd vehicle_damping;
  VehicleResponse vehicle;
  std::unique_ptr<StructureResponse> structure;    ///< null on rigid track
  std::optional<RigidWheelResponse> rigid_wheels;  ///< for NormalContact::rigid

  StepOperators(const VsiModel& model, const HhtScheme& hht);

  /// For a step that ends at `time`: take the table of the rails' compliance along, so that it covers the train up to
  /// there and some way ahead, the vehicle's gyroscopic terms to the speed there, and let the unknowns in `active` take
  /// part.
  void follow(const VsiModel& model, double time, const DofRange& active);

 private:
  double speed_;                                   ///< of the gyroscopic terms [m/s]
  double covered_from_ = 0.0, covered_to_ = -1.0;  ///< positions along the track [m]; none at first
};

struct StepLimits {
  NewtonLimits newton;
  double far_field_tolerance = 1e-9;  ///< largest rail displacement the contact solution may miss [m, rad]
  int max_passes = 6;                 ///< contact solutions per step
  /// Leave a step undone in which a wheel meets or leaves its rail, or in which a rail's vertical force on a wheel
  /// changes by more than `largest_change` [N].
  bool smooth_only = false;
  double largest_change = std::numeric_limits<double>::infinity();
  bool without_table = false;  ///< contact geometry by the online search
};

/// What happens to the wheels of a step that touch their rails, with tread or flange; one that meets it counts first.
enum class TouchChange { none, left, met };

struct StepReport {
  bool converged = false;
  TouchChange touch_change = TouchChange::none;
  bool hits = false;  ///< a force changes by more than StepLimits::largest_change
  int newton_iterations = 0;
  int back_substitutions = 0;  ///< forward and backward once through the whole factor of the structure
  ContactCounts counts;
  /// Contact: all that its solution does besides looking up the geometry.
  double seconds_contact = 0.0, seconds_structure = 0.0, seconds_vehicle = 0.0;
};

/// Buffers of a step, reused.
struct StepWorkspace {
  std::vector<Prediction> vehicle_prediction;
  Prediction structure_prediction;
  std::vector<Eigen::VectorXd> vehicle_free, vehicle_increment;
  Eigen::VectorXd vehicle_load;  ///< of one vehicle
  WheelContactModel contact;     ///< at the speed of the step's end
  DividedSubstitution structure_solution;
  std::vector<int> rail_dofs;  ///< unknowns of the structure that the wheels load
  Eigen::VectorXd structure_free, structure_increment, structure_load, far_field;
  ContactProblem problem;
  ContactSolution solution;
  NewtonWorkspace newton;
  RigidWheelWorkspace rigid_wheels;

  explicit StepWorkspace(const VsiModel& model);
};

/// The contacts as the state has them at its time, for the step that begins there: needed with
/// ContactForceRule::energy where that state does not come from a step.
void remember_contact(const VsiModel& model, VsiState& state);

/// One HHT step of the coupled system (Eqs. 12-16). If it does not converge, `state` is as before. Serves both kinds of
/// normal contact; `advance_rigid_wheels` is the part for wheels that follow the rails.
[[nodiscard]] StepReport advance(const VsiModel& model, const StepOperators& operators, const StepLimits& limits,
                                 VsiState& state, StepWorkspace& workspace);
[[nodiscard]] StepReport advance_rigid_wheels(const VsiModel& model, const StepOperators& operators,
                                              const StepLimits& limits, VsiState& state, StepWorkspace& workspace);

}  // namespace railtab
