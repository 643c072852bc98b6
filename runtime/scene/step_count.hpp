#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Steps of a run of `duration` [s]. @throws InputError where there are none, or more than anybody could wait for
[[nodiscard]] long step_count(const IntegrationParameters& integration, double duration);

/// Steps that the train runs before its scene begins, so that the excitation by the sleepers, which the steady start
/// leaves out, is present at t = 0. The modelled track limits their number; rigid rails need none, but for the
/// published search, which has a steady state of its own to settle to.
[[nodiscard]] long pre_roll_steps(const IntegrationParameters& integration, const VsiModel& model);

}  // namespace railtab
