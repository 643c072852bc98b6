#pragma once

#include <functional>
#include <vector>

#include "railtab/runtime/stability/periodic_motion.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// The motion of one vehicle, or one train with joints, on straight rigid rails as a flow; the parameter is the speed
/// [m/s]. Steps are those of runs with ContactForceRule::endpoint. Its state is
///     x = [ u, u̇ ],
/// u without the rotation angles of wheelsets that no force depends on; accelerations follow from the equation of
/// motion.
/// @see docs/theory/limit_cycles.md
class VehicleFlow : public Flow {
 public:
  /// @param model of one vehicle; structure, deviations and loads play no part. Shares its contact geometry
  /// @param alpha of HHT
  /// @throws InputError where the vehicle has dry friction, whose forces are no function of its motion
  VehicleFlow(const VsiModel& model, double alpha);

  [[nodiscard]] std::optional<Eigen::VectorXd> end(const Eigen::VectorXd& start, const SteppedTime& time,
                                                   double speed) const override;
  /// By the linearised steps, each with the slopes of its contact forces; by time and speed by differences of end().
  [[nodiscard]] std::optional<FlowEnd> end_with_derivatives(const Eigen::VectorXd& start, const SteppedTime& time,
                                                            double speed) const override;
  /// 1 mm, 1 mrad, and their rates at a wheelset's wave of some Hz.
  [[nodiscard]] const Eigen::VectorXd& unit() const override { return unit_; }

  /// The largest and the smallest lateral displacement of each wheelset in a motion [m].
  struct Extent {
    double low = 0.0, high = 0.0;
    [[nodiscard]] double amplitude() const noexcept { return 0.5 * (high - low); }
  };
  [[nodiscard]] std::vector<Extent> lateral_extents(const Eigen::VectorXd& start, const SteppedTime& time,
                                                    double speed) const;

  [[nodiscard]] Eigen::VectorXd packed(const LinearMotion& motion) const;
  /// A state of the vehicle with accelerations and contact forces at x, at time 0.
  [[nodiscard]] VsiState state_at(const VsiModel& model, const Eigen::VectorXd& x) const;
  /// Lateral displacement and velocity of a wheelset in x.
  [[nodiscard]] CycleSection lateral_section(int wheelset) const;
  /// The vehicle alone on rigid rails at a speed.
  [[nodiscard]] VsiModel model_at(double speed) const;

 private:
  [[nodiscard]] bool run(const VsiModel& model, VsiState& state, const SteppedTime& time,
                         const std::function<void(const VsiState&)>& after_step) const;

  VsiModel model_;
  double alpha_;
  std::vector<int> displacements_;  // rows of u in x
  Eigen::VectorXd unit_;
};

}  // namespace railtab
