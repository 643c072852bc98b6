#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// How a reduced run differs from the same run without reduction.
struct ReductionError {
  double duration = 0.0;  ///< compared [s]
  /// Vertical contact force, over all wheels and steps: largest and root mean square difference over the largest amount
  /// that Q differs from the static load by (its dynamic part), and the largest difference over the static load.
  double force_max = 0.0, force_rms = 0.0, force_static = 0.0;
  /// Vertical acceleration of the deck's nodes of interest: largest and root mean square difference over the largest
  /// acceleration.
  double deck_max = 0.0, deck_rms = 0.0;
  double dynamic_force = 0.0, deck_acceleration = 0.0;  ///< these largest amounts, without reduction [N], [m/s²]
  double peak_force = 0.0;                              ///< relative difference of the largest Q
  double peak_deck = 0.0;                               ///< relative difference of the largest deck acceleration
  /// Of Q, of Y and of the deck's vertical acceleration: root mean square difference over that of the dynamic part,
  /// what differs from the mean over time.
  double rms_Q = 0.0, rms_Y = 0.0, rms_deck = 0.0;
  RunSummary reduced, whole;
};

/// The first `duration` [s] of a scene with its reduction and without, step by step beside each other.
/// @throws InputError as run_scene, and where the scene is shorter; ComputationError where one of the two does not come
/// to its end
[[nodiscard]] ReductionError check_reduction(const SceneParameters& scene, double duration);

/// What of a run the comparison needs: Q and Y of every wheel and the deck's vertical accelerations, step by step.
struct ComparedHistory {
  std::vector<double> static_load;                       ///< [N] per wheel
  std::vector<std::vector<float>> force, lateral, deck;  ///< per step [N], [N], [m/s²]
  double seconds_steps = 0.0;                            ///< processor time of all steps
  RunSummary summary;
};
[[nodiscard]] ComparedHistory compared_history(const SceneParameters& scene, double duration);
[[nodiscard]] ReductionError compare(const ComparedHistory& reduced, const ComparedHistory& whole);

}  // namespace railtab
