#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// The train of a model alone on straight rigid rails at a speed [m/s], in the middle at time 0.
[[nodiscard]] VsiModel on_rigid_rails(const VsiModel& model, double speed);

}  // namespace railtab
