#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/vehicle/separate_systems.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {

/// Compliance of one separate system of a vehicle in the elongations of its force elements for one time-step size,
/// times the load weight.
struct ElementCompliance {
  Eigen::MatrixXd own;             ///< elongations per forces of the elements
  Eigen::MatrixXd from_wheelsets;  ///< elongations per contact forces on the system's wheelsets, 6 each
  Eigen::MatrixXd to_wheelsets;    ///< its wheelsets' displacements per forces of the elements

  /// @param inverse of the vehicle's effective matrix
  ElementCompliance(const VehicleModel& vehicle, const SeparateSystem& system, const Eigen::MatrixXd& inverse,
                    double load_weight);
  /// For a state of rest, whose pitch unknowns of the wheelsets are no displacements.
  void leave_out_pitch();
  /// Elongations only, of a vehicle whose dofs `free` have the inverse effective matrix `inverse`.
  ElementCompliance(const VehicleModel& vehicle, const SeparateSystem& system, const std::vector<int>& free,
                    const Eigen::MatrixXd& inverse, double load_weight);
};

/// Which force of an element stands in a step.
enum class ElementRule {
  endpoint,  ///< at the end of the step
  energy,    ///< its mean over the step's path: a stop keeps its energy, dampers and friction only take some
  rest,      ///< stops alone; a damper exerts nothing, and friction what it did
};

/// The force elements of one separate system of a vehicle in one step. The linear rest responds to their forces f by
///
///     x = x_free + C_xw f_w − C_xx f(x),     q_w = … − C_wx f(x)                          (E1)
///
/// with the contact forces f_w on the wheelsets: their elongations x are solved for given f_w, exactly, in every
/// evaluation of the contacts' residual (docs/theory/coupling.md, section 10).
class ElementForces {
 public:
  struct Step {
    ElementRule rule = ElementRule::endpoint;
    double time_step = 0.0, velocity_rate = 0.0;  ///< [s], [1/s]
    double mean_weight = 1.0;                     ///< as ContactProblem::mean_weight
  };
  /// What a step of the whole vehicle begins with.
  struct Start {
    const LinearMotion& motion;
    const Eigen::VectorXd& friction;  ///< force of every element, zero but of those of that kind [N]
    const Prediction& prediction;
    const Eigen::VectorXd& guess;  ///< displacement of the dofs that the iteration starts from
  };

  ElementForces(const VehicleModel& vehicle, const SeparateSystem& system);

  /// Motions, displacements, loads and friction forces are those of the whole vehicle.
  void begin(const Step& step, const Start& start);
  /// At rest: from the displacement reached.
  void begin_rest(const Eigen::VectorXd& displacement, const Eigen::VectorXd& friction);

  [[nodiscard]] bool empty() const noexcept { return elements_.empty(); }
  /// Whether the share of all elements in the step and its derivative vanish.
  [[nodiscard]] bool exert_nothing() const noexcept { return share_.isZero(0.0) && slope_.isZero(0.0); }
  /// Elongations of the system's elements.
  void elongate(const Eigen::VectorXd& displacement, Eigen::VectorXd& elongation) const;
  /// Solves (E1). @param free x without the elements' forces at the end. False where it does not converge.
  [[nodiscard]] bool solve(const ElementCompliance& compliance, const Eigen::VectorXd& free);
  /// Derivative of the wheelsets' displacements by their contact forces that the elements take away.
  [[nodiscard]] Eigen::MatrixXd stiffening(const ElementCompliance& compliance) const;

  [[nodiscard]] const Eigen::VectorXd& elongation() const noexcept { return x_; }
  /// The elements' share f in the step, dual to the elongations; and their forces at its end.
  [[nodiscard]] const Eigen::VectorXd& share() const noexcept { return share_; }
  [[nodiscard]] const Eigen::VectorXd& end_force() const noexcept { return end_; }
  /// The same as loads on the vehicle's dofs, added.
  void add_share(Eigen::VectorXd& load) const { add_load(share_, load); }
  void add_end_force(Eigen::VectorXd& load) const { add_load(end_, load); }
  /// By element of the vehicle, of those of kind friction at the end of the step.
  void store_friction(Eigen::VectorXd& friction) const;
  [[nodiscard]] const std::vector<int>& wheelsets() const noexcept { return system_.wheelsets; }

 private:
  struct Evaluated {
    double begin = 0.0;  // force at the step's begin
    ForceCurve::Value end, mean;
    double end_by_load_row = 0.0, mean_by_load_row = 0.0;
  };
  [[nodiscard]] Evaluated evaluated(std::size_t element) const;
  void take_friction(const Eigen::VectorXd& of_vehicle);
  void add_load(const Eigen::VectorXd& force, Eigen::VectorXd& load) const;
  void evaluate();
  void factor(const ElementCompliance& compliance);

  SeparateSystem system_;
  bool whole_;              // all dofs are the system's
  bool only_stops_;         // among the elements
  ForceElements elements_;  // of the system
  Step step_;
  Eigen::VectorXd x0_, v0_, friction_;          // at the begin
  Eigen::VectorXd predicted_, predicted_rate_;  // of the step
  Eigen::VectorXd x_, share_, end_, friction_end_;
  Eigen::MatrixXd slope_;  // ∂share/∂x
  Eigen::VectorXd residual_, correction_, x_before_;
  Eigen::MatrixXd jacobian_;
  LuFactor solver_;
  Eigen::MatrixXd factored_slope_, factored_compliance_;  // of solver_
};

/// The force elements of a train as the contacts' condensed system has them (ContactProblem::elements).
class TrainElements {
 public:
  TrainElements(const VehicleModel& kind, std::size_t vehicles);

  /// ElementForces::begin() of a vehicle. @param free displacement without contact and element forces
  void begin(int vehicle, const ElementForces::Step& step, const ElementForces::Start& start,
             const Eigen::VectorXd& free);
  void begin_rest(int vehicle, const Eigen::VectorXd& displacement, const Eigen::VectorXd& friction,
                  const Eigen::VectorXd& free);
  /// Solves the elements of every vehicle for contact forces and adds what theirs displace the wheelsets by; NaN where
  /// that fails. @param force, displacement 12 per wheelset
  void respond(const Eigen::VectorXd& force, Eigen::VectorXd& displacement);
  /// Solves those of one vehicle without contact forces. False where that does not converge.
  [[nodiscard]] bool solve(int vehicle);
  /// Derivative of the displacements of wheelsets by their contact forces, 6 per wheelset, that the elements take away.
  /// @param wheelsets of the train, all of some separate systems of one vehicle
  [[nodiscard]] Eigen::MatrixXd stiffening(WheelsetRange wheelsets) const;

  /// ElementForces::add_share(), add_end_force() and friction of a vehicle.
  void add_share(int vehicle, Eigen::VectorXd& load) const;
  void add_end_force(int vehicle, Eigen::VectorXd& load) const;
  void store_friction(int vehicle, Eigen::VectorXd& friction) const;

  const std::vector<ElementCompliance>* compliance = nullptr;  ///< of the step, per separate system

 private:
  /// Of a vehicle, those of its separate systems that have force elements or not.
  [[nodiscard]] std::span<ElementForces> of(int vehicle);
  [[nodiscard]] std::span<const ElementForces> of(int vehicle) const;

  std::size_t systems_;                // of a vehicle
  int wheelsets_;                      // of a vehicle
  std::vector<ElementForces> system_;  // vehicle by vehicle
  std::vector<Eigen::VectorXd> free_;  // per system: elongations without contact and element forces
  Eigen::VectorXd wheelset_force_, elongation_, wheelset_displacement_;
};

}  // namespace railtab
