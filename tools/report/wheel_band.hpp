#pragma once

#include <functional>

#include "railtab/runtime/report/chart.hpp"
#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Adds the smallest and largest value over all wheels that passed a piece of the track, where there are more than four
/// wheels.
/// @param quantity of a wheel; the second argument is its static load [N]
void add_band(const RunResults& results, const std::function<double(const WheelRecord&, double)>& quantity,
              Chart& chart);

}  // namespace railtab::report
