#pragma once

#include "railtab/runtime/scene/reduction_check.hpp"

namespace railtab::work_precision {

/// A history of which forces keep what lies below `force_limit` and deck accelerations what lies below `deck_limit`
/// [Hz]: Butterworth of fourth order forward and backward, which shifts nothing in time (-6 dB at the limit, -28 dB
/// half above it). 0.12 s at either end, in which the filter settles, are left away. @param time_step of the history
/// [s]
[[nodiscard]] ComparedHistory low_passed(const ComparedHistory& history, double time_step, double force_limit,
                                         double deck_limit);

}  // namespace railtab::work_precision
