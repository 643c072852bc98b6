#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {
struct VsiModel;
struct VsiState;
}  // namespace railtab

namespace railtab::scene {

struct SceneCase;

using Warnings = std::vector<std::string>;

/// What a run warns of: input that is valid, but most likely not what was meant.
struct Warning {
  std::string_view when;                               ///< as the guide says it
  void (*check)(const SceneCase& at, Warnings& list);  ///< adds a sentence for each case
  /// In place of `check`, where the state at the begin of the run decides; empty: no warning.
  std::string (*check_start)(const SceneParameters& scene, const VsiModel& model, const VsiState& start) = nullptr;
};

extern const Warning vehicle_above_top_speed, vehicle_above_critical_speed, vehicle_linearised, vehicle_implausible;
extern const Warning speed_outside_run, speed_without_brakes, start_on_flanges, start_on_span, judging_outside_run;
extern const Warning steps_too_long, records_too_few;
extern const Warning rails_off_gauge;
extern const Warning noisy_wheel_profile, noisy_rail_profile;
extern const Warning energy_rule_with_paper_search, inaccurate_loaded_table;
extern const Warning structure_unlike_a_bridge, span_unlike_a_bridge, span_far_from_track, span_with_few_sleepers;
extern const Warning irregularity_zero, irregularity_outside_run, irregularity_with_step, irregularity_too_large;
extern const Warning deviation_zero, deviation_outside_run;
extern const Warning load_zero, load_outside_run, load_shorter_than_steps;
extern const Warning ground_too_strong, ground_with_gap, ground_with_swing;
extern const Warning ground_at_rest, ground_drift, ground_lateral_motion, ground_after_run, ground_moves_nothing;

}  // namespace railtab::scene
