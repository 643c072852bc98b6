#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"
#include "stability_case.hpp"

namespace railtab::stability {

/// A run whose records are summed up against the laws that no scheme may break.
struct WatchedRun {
  RunSummary summary;
  bool started = false;  ///< the state at t = 0 was found
  bool finite = true;    ///< every number of every record
  long records = 0;
  /// What the impulses of weight, loads and wheel forces leave of the change of the train's momentum, vertical and
  /// lateral together, relative to the impulse of the weight plus that of the wheel forces: a balance that holds
  /// whatever the contact does, up to the error of the trapezoidal rule over the steps.
  double impulse_error = 0.0;
  EnergyResult energy;
  double longest_flight = 0.0;  ///< longest time that a wheel was without contact [s]
  double largest_load = 0.0;    ///< largest Q [N]
  double largest_shift = 0.0;   ///< of a wheelset [m]
};

/// From the steady start, with `disturb` done to the state at t = 0.
[[nodiscard]] WatchedRun watched_run(const VsiModel& model, const IntegrationParameters& integration, double duration,
                                     const std::function<void(VsiState&)>& disturb = {});

/// The same, where the run's model differs from that of the steady start (a load that sets in at t = 0).
[[nodiscard]] WatchedRun watched_run(const VsiModel& start, const VsiModel& model,
                                     const IntegrationParameters& integration, double duration,
                                     const std::function<void(VsiState&)>& disturb = {});

/// The outcome that the laws allow: converged where the run came to its end, finite; its error is the impulse's.
[[nodiscard]] CaseResult judged(const WatchedRun& run);

/// A coach on straight, level, rigid track with online contact: the scene that cases vary.
[[nodiscard]] SceneParameters coach_on_rigid_track();
/// A wheelset with a sprung mass that both heave only, on the coach's track at its speed: the smallest train.
[[nodiscard]] VsiModel sprung_wheelset();
/// The coach on ballasted track with a span of 20 m.
[[nodiscard]] SceneParameters coach_on_bridge();

}  // namespace railtab::stability
