#pragma once

#include <string>

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What to say of the first wheelset that has left its rails: a wheel in the air, 0.15 m off their middle, 0.1 m below
/// or 1 m above them; empty where none has. From there on a run has nothing to do with the train it was meant for.
[[nodiscard]] std::string derailment(const VsiModel& model, const VsiState& state);

}  // namespace railtab
