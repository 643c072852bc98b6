#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/runtime/line/body_load.hpp"
#include "railtab/runtime/line/ground_motion.hpp"
#include "railtab/runtime/line/irregularity.hpp"
#include "railtab/runtime/line/rail_friction.hpp"
#include "railtab/runtime/line/span_deviation.hpp"
#include "railtab/runtime/line/speed_profile.hpp"
#include "railtab/runtime/line/wheel_deviation.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"
#include "railtab/runtime/vsi/element_deflection.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"
#include "railtab/runtime/vsi/moving_window.hpp"
#include "railtab/runtime/vsi/normal_contact.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/runtime/vsi/structure_store.hpp"

namespace railtab {

/// Gyroscopic moments of the rolling wheelsets.
enum class GyroscopicMoments { included, neglected };

/// Vertical deviation of the track under a wheelset and its time derivatives as the wheelset meets them; z is down.
struct VerticalDeviation {
  double z = 0, rate = 0, acceleration = 0;  ///< [m], [m/s], [m/s²]
};

/// Deviations that each wheelset meets, given at equal time steps from t = 0 in place of an irregularity over x.
struct DeviationHistory {
  double time_step = 0;                                    ///< [s]
  std::vector<std::vector<VerticalDeviation>> wheelset{};  ///< per wheelset of the train, front first, and step
  /// At the nearest step; zero before the first, the last value after the last.
  [[nodiscard]] VerticalDeviation at(int wheelset_of_train, double time) const noexcept;
};

/// A train of equal vehicles on a track, constant during a run. Without a structure the track is rigid.
struct VsiModel {
  VehicleModel vehicle;
  std::vector<double> vehicle_x;  ///< of the vehicles' centres at t = 0, front first [m]
  SharedStructure structure;
  std::vector<std::string> structure_warnings{};  ///< StructureModel::warnings of what was imported
  std::optional<WindowModel> window;              ///< for Reduction::window
  std::shared_ptr<StructureStore> store;          ///< of factors, for later runs of this structure; null: none
  Irregularity irregularity;
  std::optional<SpanDeviation> span_deviation;        ///< besides `irregularity`
  std::optional<DeviationHistory> deviation_history;  ///< in place of `irregularity`
  std::vector<WheelDeviation> wheel_deviation;        ///< 2 per wheelset, left first; none: all wheels are round
  std::optional<RailFriction> rail_friction;          ///< in place of contact.friction, which scales it
  NormalContact normal_contact = NormalContact::hertz;
  std::shared_ptr<const ContactGeometry> geometry;
  WheelContactModel contact;  ///< its geometry points to `geometry`, its speed is that at t = 0
  /// Where wheelsets differ in their profiles or radius: the geometry of each wheelset of the train; else empty, and
  /// all have `geometry`, which is that of the first.
  std::vector<std::shared_ptr<const ContactGeometry>> wheelset_geometry;
  std::optional<SpeedProfile> speed_profile;  ///< speed over time; without it contact.speed throughout
  std::vector<BodyLoad> loads;                ///< on the vehicles' bodies, besides gravity
  double lateral_acceleration = 0.0;          ///< that pushes the vehicles to the right, in the track's plane [m/s²]
  std::optional<GroundMotion> ground_motion;  ///< under the structure's supports and of rails that are rigid
  GyroscopicMoments gyroscopic_moments = GyroscopicMoments::included;
  std::vector<double> judged{};  ///< ResultHeader::judged

  [[nodiscard]] int wheelsets_per_vehicle() const noexcept { return static_cast<int>(vehicle.wheelsets.size()); }
  [[nodiscard]] int wheelsets() const noexcept { return wheelsets_per_vehicle() * static_cast<int>(vehicle_x.size()); }
  /// Position of a wheelset along the track at time t, wheelsets counted from the front of the train [m].
  [[nodiscard]] double wheelset_x(int wheelset, double time) const noexcept;
  /// Running speed V [m/s], its rate [m/s²], and the distance run since t = 0 [m].
  [[nodiscard]] double speed(double time) const noexcept {
    return speed_profile ? speed_profile->speed(time) : contact.speed;
  }
  [[nodiscard]] double acceleration(double time) const noexcept {
    return speed_profile ? speed_profile->acceleration(time) : 0.0;
  }
  [[nodiscard]] double distance(double time) const noexcept {
    return speed_profile ? speed_profile->distance(time) : contact.speed * time;
  }
  [[nodiscard]] const ContactGeometry& geometry_of(int wheelset) const noexcept {
    return wheelset_geometry.empty() ? *geometry : *wheelset_geometry[static_cast<std::size_t>(wheelset)];
  }
  /// `contact` on the profiles of every wheelset.
  [[nodiscard]] TrainContact train_contact() const;
  /// Nominal radius of a wheelset's wheels [m].
  [[nodiscard]] double wheel_radius(int wheelset) const noexcept {
    return vehicle.wheel_radius[static_cast<std::size_t>(wheelset % wheelsets_per_vehicle())];
  }
  /// How much higher a wheel runs than a round one at time t, over the way x: rise [m], dz/dx [-], d²z/dx² [1/m].
  [[nodiscard]] WheelRise wheel_rise(int wheel, double time) const noexcept;
  /// Irregularity of a rail and its deviation by turning spans together.
  [[nodiscard]] RailDeviation rail_line(RailSide side, double x) const noexcept;
  /// Damping with the gyroscopic terms of wheelsets that roll at V/R0.
  [[nodiscard]] Eigen::MatrixXd vehicle_damping(double speed) const {
    if (gyroscopic_moments == GyroscopicMoments::neglected) return vehicle.damping;
    return vehicle.damping + speed * vehicle.gyroscopic;
  }
};

/// Everything that changes from step to step.
struct VsiState {
  double time = 0.0;
  std::vector<LinearMotion> vehicle;
  StructureMotion structure;
  Eigen::VectorXd left_behind;  ///< modal coordinates, velocities and accelerations of the spans behind a window
  std::vector<Eigen::VectorXd> friction;  ///< per vehicle: force of each force element that is dry friction [N]
  StopExtremes stops;                     ///< where vehicles have force elements
  ContactSolution contact;
  /// What the tabulated compliance leaves out of the rails' displacement (far wheels). Hertzian contact: that of the
  /// rail head under each wheel, 3 per wheel [m, rad]. Rigid contact: displacement [m], slope [-] and curvature [1/m]
  /// of the rails' mean line under each wheelset, 3 per wheelset, then zeros.
  Eigen::VectorXd far_field;
  ElementDeflection deflection;  ///< of rails between the nodes of their elements
  WheelExtremes wheel_extremes;
  /// Where the force rule is left to the run [s]; runs begin before 0: until when steps are no longer than
  /// IntegrationParameters::impact_step, since a wheel has met its rail, until when an impact lasts, in steps up to
  /// eight times as long, and until when contacts keep their energy, which may be longer.
  double landing_until = std::numeric_limits<double>::lowest();
  double impact_until = std::numeric_limits<double>::lowest();
  double energy_until = std::numeric_limits<double>::lowest();

  explicit VsiState(const VsiModel& model);
};

/// All numbers of a state that the next step depends on, in a fixed order, for checkpoints: a run continued from them
/// is the uninterrupted run to the last bit.
[[nodiscard]] std::vector<double> packed(const VsiState& state);
/// The inverse. @throws InputError where the count is not that of the model.
void unpack(std::span<const double> numbers, VsiState& state);

/// Where the wheels stand on the structure, 2 per wheelset (left, right); empty on rigid track.
[[nodiscard]] std::vector<RailContact> place_wheels(const VsiModel& model, double time);
/// The same in place of what `contacts` holds.
void place_wheels(const VsiModel& model, double time, std::vector<RailContact>& contacts);

/// Irregularity under every wheel, with the slopes that the structure's displacement adds; where the rails are rigid,
/// with the motion of the ground, and where displacements are relative to supports, with what these carry along.
void rail_deviation(const VsiModel& model, const std::vector<RailContact>& contacts, double time,
                    const Eigen::VectorXd& structure_displacement,
                    std::vector<std::array<RailHeadMotion, 2>>& deviation);

/// Mean vertical deviation of the two rails under a wheelset, from the history or the irregularity at the running
/// speed; and the vertical motion of the ground there, which rails that are rigid follow.
[[nodiscard]] VerticalDeviation vertical_deviation(const VsiModel& model, int wheelset, double time) noexcept;
[[nodiscard]] VerticalDeviation ground_under(const VsiModel& model, int wheelset, double time) noexcept;

/// Adds to the load of a vehicle what its force elements exert as a state has them.
void add_element_forces(const VsiModel& model, const VsiState& state, int vehicle, Eigen::VectorXd& load);

/// The contact unknowns and their velocities as a state has them (`predicted`, with the track's deviation), nothing
/// left to solve: for what is asked of the contacts outside the steps.
[[nodiscard]] ContactProblem present_contact(const VsiModel& model, const VsiState& state);

/// Restriction of one vehicle's dof vector to its wheelset unknowns, written into a 12-per-wheelset vector.
void gather_wheelsets(const VsiModel& model, int vehicle, const Eigen::VectorXd& dofs, Eigen::VectorXd& q) noexcept;
/// Its transpose: the contact forces of one vehicle's wheelsets as loads on the vehicle's dofs.
void scatter_wheelset_forces(const VsiModel& model, int vehicle, const Eigen::VectorXd& force,
                             Eigen::VectorXd& load) noexcept;
/// Restriction of the structure's dofs to the rail heads.
void gather_rails(const std::vector<RailContact>& contacts, const Eigen::VectorXd& dofs, Eigen::VectorXd& q) noexcept;
/// Its transpose, as the contact loads of the structure.
void set_rail_forces(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force,
                     LinearMotion& structure) noexcept;
/// The transpose added to loads that are there.
void add_rail_forces(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force,
                     Eigen::VectorXd& load) noexcept;

}  // namespace railtab
