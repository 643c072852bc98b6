#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// Steps of a run of `duration` [s]. @throws InputError where there are none, or more than anybody could wait for
[[nodiscard]] long step_count(const IntegrationParameters& integration, double duration);

}  // namespace railtab
