#pragma once

#include "railtab/runtime/vsi/reduction_check.hpp"

namespace railtab::work_precision {

/// A history of which forces keep what lies below `force_limit` and deck accelerations what lies below `deck_limit`
/// [Hz]: Butterworth of second order forward and backward, which shifts nothing in time (-6 dB at the limit). 0.1 s at
/// either end, in which the filter settles, are left away. @param time_step of the history [s]
[[nodiscard]] ComparedHistory low_passed(const ComparedHistory& history, double time_step, double force_limit,
                                         double deck_limit);

}  // namespace railtab::work_precision
