#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/vsi/contact_estimate.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"
#include "railtab/runtime/vsi/train_contact.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {

class TrainElements;

/// Contact unknowns of one wheelset: its six displacements, then y, z, roll of the left and of the right rail head.
inline constexpr int wheelset_unknowns = 12;
/// First of the three rail-head unknowns of a wheel; wheel = 2·wheelset + side, left first.
[[nodiscard]] constexpr int rail_unknown(int wheel) noexcept {
  return wheelset_unknowns * (wheel / 2) + 6 + 3 * (wheel % 2);
}
/// First of the six rail-head unknowns of a wheelset.
[[nodiscard]] constexpr int rails_unknown(int wheelset) noexcept { return rail_unknown(2 * wheelset); }

/// Motion of the rail heads under wheelset i from loads on those under wheelset j.
struct RailCoupling {
  int i, j;
  RailHeadsCompliance compliance;

  /// Of a unit vertical load on each of both rail heads under j.
  [[nodiscard]] Vector6 under_vertical_loads() const { return compliance.col(1) + compliance.col(4); }
};

/// Solution and last contact forces, kept from step to step.
struct ContactSolution {
  Eigen::VectorXd displacement;  ///< q, 12 per wheelset
  /// f, dual to q: with the load weight 1+α, what these contact forces load train and structure with in this step.
  /// Under ContactForceRule::endpoint the contact force at q, otherwise its share in the step's mean.
  Eigen::VectorXd force;
  Eigen::VectorXd end_force;   ///< contact force at q and its velocity
  Eigen::VectorXd step_load;   ///< p, the contacts' part of Eq. 12 in the last step
  std::vector<double> rail_x;  ///< longitudinal force on the rail per wheel [N]
  std::vector<std::array<double, ContactPatches::capacity>> normal;  ///< of the patches [N]
  std::vector<double> creep_power, pressure;                         ///< WheelForce's, per wheel [W], [Pa]
  std::vector<WheelContact> contact;  ///< per wheel, of its own (mirrored on the left) side
  std::vector<ContactMemory> memory;  ///< per wheel, what the next step wants to know of this one's end
};

/// The contact problem of one step, condensed to the contact unknowns q: the linear rest of the train and the structure
/// responds with q = q_free + C·f(q, v) with v = v_predicted + velocity_rate·(q − q_predicted). Derived in
/// docs/theory/coupling.md from Eq. 16.
struct ContactProblem {
  int wheelsets_per_vehicle = 4;
  /// Wheelsets whose coupling enters Newton's Jacobian: wheelsets_per_vehicle at rest, all of a vehicle that `coupled`
  /// joins; one in a time step, within which each responds almost independently.
  int wheelsets_per_group = 4;
  /// dv/dq [1/s] of a wheelset and of a rail head: gamma/(beta·dt) in a time step. At rest 0, but for the wheelset's
  /// pitch, whose unknown is then its deviation from the nominal rotation.
  Vector6 velocity_rate = Vector6::Zero();
  double rail_velocity_rate = 0.0;
  Eigen::VectorXd free, predicted, predicted_velocity;  ///< 12 per wheelset
  Eigen::MatrixXd vehicle_compliance;                   ///< of one vehicle's wheelsets, 6w × 6w, times the load weight
  std::span<const WheelsetRange> coupled;  ///< per wheelset of a vehicle, those whose compliance with it is not zero;
                                           ///< empty: all of the vehicle
  TrainElements* elements = nullptr;       ///< force elements of the vehicles, which follow the contact forces; or none
  std::vector<RailCoupling> rail;          ///< times the load weight; empty on rigid track
  std::vector<std::array<RailHeadMotion, 2>> deviation;  ///< irregularity and the rails' slopes, per wheelset and side
  double largest_move = 5e-3;                            ///< bound on one Newton correction [m or rad]
  /// Contact at the start of the step where f = mean_weight·(mean force over the step − half of that at its start);
  /// none: f is the force at the end.
  const ContactSolution* start = nullptr;
  double mean_weight = 1.0;
};

/// What evaluations of the contact forces asked of the tables.
struct ContactCounts {
  /// Of the contact, and those that the table alone answered, by its loaded part where it has one.
  long queries = 0, table_queries = 0;
  long outside_creep_table = 0;  ///< creep forces that the creep table left to Polach, wholly or in part
  double seconds_lookup = 0.0;   ///< in the contact geometry

  ContactCounts& operator+=(const ContactCounts& more) noexcept;
};

struct NewtonReport {
  bool converged = false;
  int iterations = 0;       ///< corrections made of the wheelsets that needed most
  double correction = 0.0;  ///< largest last correction [m or rad]
  ContactCounts counts;
};

struct NewtonLimits {
  double tolerance = 1e-11;  ///< of the correction [m, rad]
  /// A correction that changes no contact force by more than this, to first order, is the last one [N, N m].
  double force_tolerance = 0.0;
  int max_iterations = 20;
  /// A correction this small ends the iteration where it no longer gains: what is left is rounding of the forces [m or
  /// rad].
  double rounding = 0.0;
};

/// Where the iteration of one group of wheelsets is.
struct GroupNewton {
  bool moved = true;                                                  ///< since its forces were computed
  enum class Turn { rests, goes_back, corrects } turn = Turn::rests;  ///< what its residual asks for
  bool gains = false;        ///< whether the residual is less than half of that before the last correction
  bool last = false;         ///< whether its last correction was below the displacement's tolerance
  bool new_tangent = false;  ///< whether one is wanted before the next correction
  double previous = std::numeric_limits<double>::infinity();  ///< largest residual before the last correction [m, rad]
  double part = 1.0;                                          ///< of the last correction that is made
  int evaluations = 0;
  /// Change of the forces by the tangent since they were computed, a sum of amounts [N, N m].
  double extrapolated = 0.0;
};

/// What a solution's forces are when its iteration begins.
enum class InitialForces {
  unknown,
  known,      ///< those at its displacement
  estimated,  ///< close to those at its displacement; the iteration begins where their kept tangents lead from there
};

/// Tangents and inverses, reused from step to step so that Newton allocates nothing.
struct NewtonWorkspace {
  /// The next solution makes its tangents anew: nothing then depends on earlier ones.
  void forget_tangents() {
    inverse.clear();
    tangent_error.clear();
    estimate.forget();
  }

  using Matrix12 = Eigen::Matrix<double, wheelset_unknowns, wheelset_unknowns>;
  std::vector<Matrix12> tangent;            ///< per wheelset, df/dq
  std::vector<WheelsetRange> range;         ///< per group, its wheelsets
  std::vector<int> group_of;                ///< per wheelset
  std::vector<Eigen::MatrixXd> compliance;  ///< per group, C
  std::vector<Eigen::MatrixXd> inverse;     ///< per group, of I − C df/dq
  std::vector<GroupNewton> group;
  std::vector<int> to_invert;    ///< groups whose inverse is to be made
  std::vector<int> to_evaluate;  ///< wheelsets whose forces are to be computed side by side
  /// Per wheelset, what its last evaluation side by side with others has found.
  enum class Computed : std::uint8_t { nothing, forces, forces_and_tangent };
  std::vector<Computed> computed;
  Eigen::VectorXd residual, correction;
  Eigen::VectorXd force_change;        ///< by the correction before it is limited, to first order
  Eigen::VectorXd start, start_force;  ///< displacement and force before the last correction
  std::vector<double> tangent_error;   ///< per group, estimate: of a change of forces by the tangent, relative
  ForceEstimate estimate;
  Eigen::VectorXd continuation_start;  ///< displacement that solve_contact_by_continuation() began with
  std::vector<ContactPatches> found;   ///< per wheel, by the last search, and where: of the published method only
  std::vector<WheelsetPose> found_at;
};

[[nodiscard]] WheelsetMotion wheelset_motion(const ContactProblem& problem, const Eigen::VectorXd& q,
                                             int wheelset) noexcept;
[[nodiscard]] RailHeadMotion rail_motion(const ContactProblem& problem, const Eigen::VectorXd& q, int wheelset,
                                         int side) noexcept;

/// q_free + C f − q: how far the linear rest of train and structure is, under the solution's forces, from its
/// displacement [m, rad].
void contact_residual(const ContactProblem& problem, const ContactSolution& solution, Eigen::VectorXd& residual);

/// Forces at solution.displacement, written into the solution.
void evaluate_contact(const TrainContact& train, const ContactProblem& problem, ContactSolution& solution);

/// Newton on the contact unknowns, from solution.displacement. The Jacobian is inverted group by group of wheelsets;
/// their coupling through vehicles and rails enters the residual. Each group keeps its tangent while it halves the
/// residual per iteration, from one step to the next too: a tangent costs five evaluations of the forces. Where a group
/// is one wheelset, the tangent learns from every correction what that has changed the forces by [Broyden1965]; where
/// wheels are computed side by side, for which a tangent costs less than a second evaluation, it is made anew when its
/// estimated error has grown to 15 %. Without inverses in the workspace it is made first of all. A group that has
/// converged rests while others iterate, unless its neighbours disturb it. A correction that changes forces little is
/// made by the tangent alone, without a further evaluation, if its error is less than half the force tolerance by the
/// errors that the tangent has shown in the last evaluations, both wheels carry ten times that change, and no creepage
/// changes by more than 10⁻⁴. What else the solution holds of the contacts, such as the patches' normal forces, then
/// belongs to a displacement at which forces differ by at most 20 tolerances. The published method's pairs jump as a
/// wheel moves: they are searched in the first evaluations and then held, each moving with its bodies' particles, so
/// that Newton ends on forces that are smooth. Converged: the residual is below the tolerance or the next correction
/// below one of the limits; the forces are those at the displacement, or by the tangent.
[[nodiscard]] NewtonReport solve_contact(const TrainContact& train, const ContactProblem& problem,
                                         const NewtonLimits& limits, ContactSolution& solution,
                                         NewtonWorkspace& workspace, InitialForces forces = InitialForces::unknown);

}  // namespace railtab
