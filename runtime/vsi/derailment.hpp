#pragma once

#include <string>

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What to say of the first wheelset that is beside its rails, 0.15 m off their middle or 0.1 m below them with a wheel
/// in the air; empty where none is. From there on a run has nothing to do with the train it was meant for.
[[nodiscard]] std::string derailment(const VsiModel& model, const VsiState& state);

}  // namespace railtab
