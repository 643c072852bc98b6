#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// The train of a model alone on straight rigid rails at a speed [m/s], in the middle at time 0.
[[nodiscard]] VsiModel on_rigid_rails(const VsiModel& model, double speed);
/// Likewise another vehicle, on the profiles of the model's wheelsets from `first_wheelset` on.
[[nodiscard]] VsiModel on_rigid_rails(const VsiModel& model, VehicleModel vehicle, int first_wheelset, double speed);

}  // namespace railtab
