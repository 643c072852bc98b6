#include "railtab/runtime/base/parameter_range.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

void require_positive(std::string_view key, double value, std::string_view unit) {
  if (std::isfinite(value) && value > 0) return;
  throw input_error(key, fmt::format("{}", value), fmt::format("a value above 0 [{}]", unit));
}

void require_not_negative(std::string_view key, double value, std::string_view unit) {
  if (std::isfinite(value) && value >= 0) return;
  throw input_error(key, fmt::format("{}", value), fmt::format("0 or more [{}]", unit));
}

void require_between(std::string_view key, double value, double low, double high, std::string_view unit) {
  if (value >= low && value <= high) return;
  throw input_error(key, fmt::format("{}", value), fmt::format("{} to {} [{}]", low, high, unit));
}

}  // namespace railtab
