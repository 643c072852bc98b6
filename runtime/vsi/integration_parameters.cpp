#include "railtab/runtime/vsi/integration_parameters.hpp"

#include <fmt/format.h>

#include <string_view>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

/// `ok` is false for NaN in every use below.
void require(bool ok, std::string_view key, double found, std::string_view expected) {
  if (!ok) throw input_error(key, fmt::format("{}", found), expected);
}

}  // namespace

void IntegrationParameters::validate() const {
  require(time_step >= 1e-9 && time_step <= 0.1, "integration.time_step", time_step, "1e-9 to 0.1 s");
  require(duration >= 0.0, "integration.duration", duration, ">= 0 s");
  require(alpha >= -1.0 / 3.0 && alpha <= 0.0, "integration.alpha", alpha, "-1/3 to 0");
  require(impact_step >= 1e-6 && impact_step <= 0.1, "integration.impact_step", impact_step, "1e-6 to 0.1 s");
  require(tolerance >= 1e-12 && tolerance <= 1e-2, "integration.tolerance", tolerance, "1e-12 to 0.01");
  require(max_iterations >= 2, "integration.max_iterations", max_iterations, ">= 2");
  require(reinitialise_every >= 1, "integration.reinitialise_every", static_cast<double>(reinitialise_every), ">= 1");
  require(max_halvings >= 0, "integration.max_halvings", max_halvings, ">= 0");
}

}  // namespace railtab
