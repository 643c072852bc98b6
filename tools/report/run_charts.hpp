#pragma once

#include <string>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Charts of a run as HTML, in the order of the page. Wheel quantities stand over the wheel's own position along the
/// track, bodies and deck over time. Empty where the run has no such quantity.
[[nodiscard]] std::string wheel_force_charts(const RunResults& results);
[[nodiscard]] std::string running_safety_charts(const RunResults& results);
[[nodiscard]] std::string car_body_charts(const RunResults& results);
[[nodiscard]] std::string structure_charts(const RunResults& results);

}  // namespace railtab::report
