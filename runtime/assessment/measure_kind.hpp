#pragma once

#include <string_view>
#include <vector>

namespace railtab {

/// Parts of an assessment: properties of the decks, trains of moving forces on them, runs with wheel–rail contact.
enum class AssessmentStage { check, moving_load, contact };
[[nodiscard]] std::string_view stage_name(AssessmentStage stage) noexcept;  ///< "check", "moving-load", "contact"

/// A quantity that clauses limit.
struct MeasureKind {
  std::string_view name, unit;          ///< SI; "-" for dimensionless
  std::vector<AssessmentStage> stages;  ///< that compute it; none: not computed yet
  std::string_view meaning;
};
/// All of them, in the order of pages.
[[nodiscard]] const std::vector<MeasureKind>& measure_kinds();
/// One of them; null where there is none of that name.
[[nodiscard]] const MeasureKind* find_measure(std::string_view name);

/// How pages show a quantity in an SI unit: "mm" for "m", "kN" for "N", "mrad" for "rad".
struct ShownUnit {
  std::string_view name;
  double factor;
};
[[nodiscard]] ShownUnit shown_unit(std::string_view unit) noexcept;

}  // namespace railtab
