#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/assessment/clause.hpp"
#include "railtab/runtime/assessment/measure_kind.hpp"

namespace railtab {

/// A measure's value at one deck, of one run or vehicle, and where it stood.
struct MeasuredValue {
  std::string measure;  ///< a name of measure_kinds()
  AssessmentStage stage = AssessmentStage::check;
  double value = 0.0;           ///< [SI]
  std::string where;            ///< "span 1", "wheelset 2 left"
  std::optional<double> x, y;   ///< along the track, at that time; right of its centre [m]
  std::string train;            ///< empty: none
  std::optional<double> time;   ///< [s]
  std::optional<double> speed;  ///< [m/s]
  std::optional<int> seed;      ///< of the random track
  std::string run;              ///< name of the run's files; empty: none
  /// What limits depend on: span [m], axle_load, static_wheel_load [N], nadal_limit, weinstock_limit, fra_limit.
  std::map<std::string, double, std::less<>> quantities;
  std::string overestimated;   ///< why the true value is smaller; empty: it is not known to be. It cannot fail a clause
  std::string limits_unknown;  ///< why it carries none of the limits of a flange; empty: it does, or is about no flange
};

/// What clauses are chosen by.
struct AssessmentFacts {
  std::string track = "ballasted";           ///< or "direct"
  double line_speed = 0.0;                   ///< [m/s]
  std::vector<std::string> rules{"Europe"};  ///< that apply, besides clauses that belong to none
};

/// Why a measure has no value, or may be larger than the one found: by measure and stage.
struct MissingMeasure {
  std::string measure;
  AssessmentStage stage = AssessmentStage::check;
  std::string reason;
  bool partly = false;  ///< there are values, of a part of what was asked for
};

enum class Outcome { pass, fail, not_judged, not_applicable };
[[nodiscard]] std::string_view outcome_name(Outcome outcome) noexcept;  ///< "pass", "fail", "not judged", …

/// One clause judged by the values of one stage.
struct Verdict {
  const Clause* clause = nullptr;
  std::optional<AssessmentStage> stage;  ///< whose value it is
  Outcome outcome = Outcome::not_judged;
  std::string reason;               ///< why it is not judged or does not apply
  double limit = 0.0;               ///< for this value [SI]; of pass and fail
  std::optional<MeasuredValue> at;  ///< the value nearest to or farthest beyond its limit; of pass and fail
  /// Value over limit, or limit over value where that is a lower one: above 1 is not met.
  [[nodiscard]] double utilisation() const noexcept;
  /// A fail that counts: no clause with a consequence.
  [[nodiscard]] bool failed() const noexcept { return outcome == Outcome::fail && clause->consequence.empty(); }
};

/// The limit of a clause for a value [SI]; none where the clause is about other measures or spans, or depends on a
/// quantity that the value does not carry.
[[nodiscard]] std::optional<double> limit_for(const Clause& clause, const MeasuredValue& value);

/// All clauses against all values: a verdict per clause and stage that has values for it, one "not judged" where none
/// has. A value whose measure is only partly known fails or is not judged, one that is overestimated passes or is not
/// judged; so is what carries no span or other quantity that the clause asks for, or is not a number. A limit is met by
/// values beyond it by rounding alone, 1e-9 of it.
/// @param clauses outlive the verdicts
[[nodiscard]] std::vector<Verdict> judge(const std::vector<Clause>& clauses, const AssessmentFacts& facts,
                                         const std::vector<MeasuredValue>& values,
                                         const std::vector<MissingMeasure>& missing);

}  // namespace railtab
