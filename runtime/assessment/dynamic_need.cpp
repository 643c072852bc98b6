#include "railtab/runtime/assessment/dynamic_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr double shortest = 4.0, longest = 100.0;  // spans with limits of the first natural frequency [m]

}  // namespace

std::string_view need_name(DynamicNeed need) noexcept {
  switch (need) {
    case DynamicNeed::not_required:
      return "not required";
    case DynamicNeed::required:
      return "required";
    case DynamicNeed::undecided:
      break;
  }
  return "undecided";
}

double upper_frequency_limit(double span) noexcept { return 94.76 * std::pow(span, -0.748); }
double lower_frequency_limit(double span) noexcept {
  constexpr double short_span = 20.0;
  return span <= short_span ? 80.0 / span : 23.58 * std::pow(span, -0.592);
}

std::string frequency_unlike_a_bridge(double span, double first_frequency) {
  constexpr double factor = 3.0;
  if (span < shortest || span > longest) return {};
  const double low = lower_frequency_limit(span), high = upper_frequency_limit(span);
  if (first_frequency >= low / factor && first_frequency <= factor * high) return {};
  return fmt::format(
      "a span of {:.6g} m has its first natural frequency at {:.3g} Hz, as a simply supported beam; spans of that "
      "length have {:.3g} to {:.3g} Hz [EN 1991-2, Figure 6.10]",
      span, first_frequency, low, high);
}

DynamicNeedResult dynamic_need(double line_speed, double span, double first_frequency, bool simple) {
  constexpr double long_span = 40.0, rounding = 1e-9;
  const double kmh = 3.6 * line_speed;
  const bool slow = kmh <= 200.0 * (1.0 + rounding);
  if (!simple) {
    if (!slow) return {DynamicNeed::required, "above 200 km/h and no simply supported span"};
    return {DynamicNeed::undecided,
            "up to 200 km/h: not required if the deck is continuous, else by the limits of the first frequency"};
  }
  if (!(span >= shortest && span <= longest)) {
    return {DynamicNeed::required,
            fmt::format("the limits of the first frequency end at spans of {:g} and {:g} m", shortest, longest)};
  }
  const double low = lower_frequency_limit(span), high = upper_frequency_limit(span);
  const bool within = first_frequency >= low * (1.0 - rounding) && first_frequency <= high * (1.0 + rounding);
  const std::string where = fmt::format("first frequency {:.3f} Hz {} {:.3f} to {:.3f} Hz", first_frequency,
                                        within ? "within" : "outside", low, high);
  if (slow) {
    return {within ? DynamicNeed::not_required : DynamicNeed::required, "up to 200 km/h and " + where};
  }
  if (within && span >= long_span) return {DynamicNeed::not_required, "span of 40 m or more and " + where};
  return {DynamicNeed::required, where + ", above 200 km/h; Annex F, which may permit less, is not evaluated"};
}

double dynamic_factor_2(double length) noexcept {
  return std::clamp(1.44 / (std::sqrt(length) - 0.2) + 0.82, 1.0, 1.67);
}

}  // namespace railtab
