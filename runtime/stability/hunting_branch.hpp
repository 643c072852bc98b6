#pragma once

#include <array>
#include <complex>

#include "railtab/runtime/stability/cycle_branch.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "railtab/runtime/stability/vehicle_flow.hpp"

namespace railtab {

/// A periodic hunting motion of a vehicle on straight rigid rails.
struct LimitCycle {
  double speed = 0.0;      ///< V [m/s]
  double frequency = 0.0;  ///< [Hz]
  /// Half of the lateral way of each wheelset, front first, from one extremum to the other [m].
  std::vector<double> amplitudes;
  std::complex<double> multiplier;  ///< of Floquet, the largest besides that along the motion
  double residual = 0.0;            ///< Shooting::residual()
  double error_along_motion = 0.0;  ///< Shooting::error_along_motion()
  PeriodicMotion motion;            ///< in the state of VehicleFlow

  [[nodiscard]] double amplitude() const;  ///< of the wheelset that moves most [m]
  [[nodiscard]] bool is_stable() const { return std::abs(multiplier) < 1.0; }
};

/// A time simulation that settles on a limit cycle.
struct SettledStart {
  double speed = 80.0;     ///< [m/s]
  double shift = 5e-3;     ///< of the train to the right when it begins [m]
  double duration = 30.0;  ///< [s]
};

struct HuntingSearch {
  SpeedSearch speed;        ///< of the linear critical speed, and the range of the branch
  double time_step = 5e-4;  ///< longest [s]
  double alpha = 0.0;       ///< of HHT
  double first_amplitude = 1e-4,
         largest_amplitude = 20e-3;  ///< of the wheelset with the largest in the linear motion [m]
  double largest_step = 0.5;         ///< along the branch, in 1 mm and 2 m/s
  int max_cycles = 300;
  /// The branch through the cycle that a simulation settles on, followed to both sides; none: from the linear critical
  /// speed.
  std::optional<SettledStart> start{};
};

/// Which way the branch leaves the linear critical speed.
enum class Bifurcation {
  subcritical,    ///< to lower speeds: cycles are unstable, and limits of what disturbance the vehicle bears
  supercritical,  ///< to higher speeds: cycles are stable
};

/// Where cycles of two amplitudes meet: the speed has an extremum along the branch.
struct LimitCycleFold {
  LimitCycle cycle;                   ///< of the extreme speed found
  std::array<LimitCycle, 2> bracket;  ///< before and after it, between which the extremum is
  bool converged = false;             ///< the speeds of all three agree within 1e-4 m/s
};

struct HuntingBranch {
  LinearCriticalSpeed linear;
  std::optional<Bifurcation> bifurcation;  ///< of a branch that begins at the linear critical speed
  int section_wheelset = 0;                ///< whose lateral displacement is largest when a cycle begins
  std::vector<LimitCycle> cycles;
  std::vector<LimitCycleFold> folds;  ///< in the order of the branch
  BranchEnd end = BranchEnd::no_convergence;

  /// Lowest speed at which there is a limit cycle or rest is unstable [m/s]; none where there is neither. An upper
  /// bound where the branch leaves the range of speeds downwards.
  [[nodiscard]] std::optional<double> nonlinear_critical_speed() const;
};

/// The branch of limit cycles that begins at the linear critical speed, or with HuntingSearch::start.
/// @param linear   the vehicle with its force elements by linear stand-ins  @param model  the vehicle as it runs, with
///                 the same degrees of freedom
/// @param listener called with every cycle; false ends the search
/// @throws InputError as VehicleFlow  @throws ComputationError where no first cycle is found
[[nodiscard]] HuntingBranch hunting_branch(const VsiModel& linear, const VsiModel& model, const HuntingSearch& search,
                                           const std::function<bool(const LimitCycle&)>& listener);

}  // namespace railtab
