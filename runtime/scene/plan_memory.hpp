#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Memory of what a run's steps work on [bytes]: matrices of the vehicles and the structure, the structure's factor,
/// made for this time step, and the factor that rail compliances come from, by its usual size. Without tables of
/// contact geometry and creep, records and the program itself.
[[nodiscard]] double step_memory(const VsiModel& model, double time_step, double alpha);

}  // namespace railtab
