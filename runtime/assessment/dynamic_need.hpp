#pragma once

#include <string>
#include <string_view>

namespace railtab {

/// Whether EN 1991-2 asks for a dynamic analysis of a deck.
enum class DynamicNeed { not_required, required, undecided };
[[nodiscard]] std::string_view need_name(DynamicNeed need) noexcept;  ///< "not required", "required", "undecided"

struct DynamicNeedResult {
  DynamicNeed need = DynamicNeed::undecided;
  std::string reason;
};

/// Limits of the first natural frequency [EN1991-2, Figure 6.10]: 94.76 L^−0.748; 80/L up to 20 m, 23.58 L^−0.592
/// above. [Hz] @pre 4 <= span <= 100 [m]
[[nodiscard]] double upper_frequency_limit(double span) noexcept;
[[nodiscard]] double lower_frequency_limit(double span) noexcept;

/// A sentence on a simply supported span whose first natural frequency [Hz] is below a third of the lower limit or
/// above three times the upper one; empty for others, and for spans without limits. @param span [m]
[[nodiscard]] std::string frequency_unlike_a_bridge(double span, double first_frequency);

/// The flow chart of [EN1991-2, Figure 6.9]. Above 200 km/h and below 40 m of span it goes on to tables of Annex F,
/// which are not evaluated: a dynamic analysis counts as required there.
/// @param line_speed [m/s] @param span [m], 0: not known @param first_frequency [Hz]
/// @param simple one simply supported span
[[nodiscard]] DynamicNeedResult dynamic_need(double line_speed, double span, double first_frequency, bool simple);

/// Φ2 = 1.44/(√L − 0.2) + 0.82 for carefully maintained track, from 1 to 1.67 [EN1991-2, 6.4.5.2]; L the determinant
/// length [m].
[[nodiscard]] double dynamic_factor_2(double length) noexcept;

}  // namespace railtab
