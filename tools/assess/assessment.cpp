#include "assessment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace railtab::assess {

namespace {

/// How near the top of a page an outcome stands.
int rank(const Verdict& verdict) {
  switch (verdict.outcome) {
    case Outcome::fail:
      return verdict.failed() ? 0 : 1;
    case Outcome::not_judged:
      return 2;
    case Outcome::pass:
      return 3;
    case Outcome::not_applicable:
      break;
  }
  return 4;
}

}  // namespace

const Verdict& LimitVerdicts::worst() const {
  return **std::ranges::min_element(stages, {}, [](const Verdict* v) { return rank(*v); });
}

std::vector<LimitVerdicts> by_limit(const std::vector<Verdict>& verdicts) {
  std::vector<LimitVerdicts> limits;
  for (const Verdict& verdict : verdicts) {
    const auto known = std::ranges::find(limits, verdict.clause, &LimitVerdicts::clause);
    if (known == limits.end()) {
      limits.push_back({verdict.clause, {&verdict}});
    } else {
      known->stages.push_back(&verdict);
    }
  }
  const auto place = [](const LimitVerdicts& limit) {
    double nearest = 0.0;
    bool any = false;
    for (const Verdict* v : limit.stages) {
      nearest = std::max(nearest, v->utilisation());
      any = any || v->at;
    }
    return std::pair(any ? std::min(2, rank(limit.worst())) : 3 + rank(limit.worst()), -nearest);
  };
  std::ranges::stable_sort(limits, {}, place);
  return limits;
}

int Assessment::count(Outcome outcome) const {
  return static_cast<int>(std::ranges::count(by_limit(verdicts), outcome,
                                             [](const LimitVerdicts& limit) { return limit.worst().outcome; }));
}

int Assessment::failures(bool verified_only) const {
  return static_cast<int>(std::ranges::count_if(by_limit(verdicts), [&](const LimitVerdicts& limit) {
    return limit.worst().failed() && (limit.clause->verified() || !verified_only);
  }));
}

std::string verdict_in_words(const Assessment& assessment) {
  const int failed = assessment.failures(false), verified = assessment.failures(true),
            passed = assessment.count(Outcome::pass), open = assessment.count(Outcome::not_judged);
  const auto clauses = [](int n) { return fmt::format("{} limit{}", n, n == 1 ? "" : "s"); };
  const auto fail = [&](int n) { return clauses(n) + (n == 1 ? " fails" : " fail"); };
  if (failed == 0 && passed == 0) return fmt::format("NOTHING JUDGED: {} not judged", open);
  if (failed == 0)
    return fmt::format("PASSES as far as it was judged: {} pass{}, {} not judged", clauses(passed),
                       passed == 1 ? "es" : "", open);
  std::vector<std::string> trains;
  for (const Verdict& v : assessment.verdicts) {
    const bool named = !v.failed() || v.at->train.empty() || std::ranges::count(trains, v.at->train) > 0;
    if (!named) trains.push_back(v.at->train);
  }
  return fmt::format("FAILS: {}{}{}; {} pass, {} not judged", fail(failed),
                     verified == failed ? "" : fmt::format(" ({} of them read in the standard)", verified),
                     trains.empty() ? "" : fmt::format(", worst with {}", fmt::join(trains, " and ")), passed, open);
}

std::string position_in_words(const std::optional<double>& x, const std::optional<double>& y) {
  std::vector<std::string> parts;
  if (x) parts.push_back(fmt::format("x = {:.2f} m", *x));
  if (y) parts.push_back(fmt::format("y = {:.2f} m", *y));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string spot_in_words(const MeasuredValue& value) {
  std::vector<std::string> parts;
  if (!value.where.empty()) parts.push_back(value.where);
  if (std::string position = position_in_words(value.x, value.y); !position.empty())
    parts.push_back(std::move(position));
  if (value.time) parts.push_back(fmt::format("t = {:.3f} s", *value.time));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string place_in_words(const MeasuredValue& value) {
  std::vector<std::string> parts;
  if (!value.train.empty()) parts.push_back(value.train);
  if (value.speed) parts.push_back(fmt::format("{:.1f} km/h", 3.6 * *value.speed));
  if (value.seed) parts.push_back(fmt::format("seed {}", *value.seed));
  if (std::string spot = spot_in_words(value); !spot.empty()) parts.push_back(std::move(spot));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string_view stage_in_words(AssessmentStage stage) noexcept {
  switch (stage) {
    case AssessmentStage::moving_load:
      return "moving forces";
    case AssessmentStage::contact:
      return "wheel–rail contact";
    case AssessmentStage::check:
      break;
  }
  return "the bridge itself";
}

std::string_view standing_in_words(const Clause& clause) noexcept {
  switch (clause.read_in) {
    case ReadIn::standard:
      return "read in the standard";
    case ReadIn::secondary_source:
      return "read in a secondary source";
    case ReadIn::nothing:
      break;
  }
  return "unverified";
}

std::string standing_in_words(const Assessment& assessment) {
  int standard = 0, secondary = 0, nothing = 0;
  for (const LimitVerdicts& limit : by_limit(assessment.verdicts)) {
    const Outcome outcome = limit.worst().outcome;
    if (outcome != Outcome::pass && outcome != Outcome::fail) continue;
    ++(limit.clause->read_in == ReadIn::standard           ? standard
       : limit.clause->read_in == ReadIn::secondary_source ? secondary
                                                           : nothing);
  }
  if (standard + secondary + nothing == 0) return {};
  return fmt::format(
      "Limits judged: {} read in the standard or a national annex to it, {} in a secondary source only, {} unverified. "
      "Check all but the first in the standard.",
      standard, secondary, nothing);
}

std::string need_in_words(const Assessment& assessment) {
  const auto with = [&](DynamicNeed need) {
    return std::find_if(assessment.decks.begin(), assessment.decks.end(),
                        [&](const DeckAssessment& d) { return d.need.need == need; });
  };
  if (assessment.decks.empty()) return {};
  if (with(DynamicNeed::required) != assessment.decks.end()) return "EN 1991-2, 6.4.4, asks for a dynamic analysis.";
  const auto open = with(DynamicNeed::undecided);
  if (open == assessment.decks.end()) {
    return "EN 1991-2, 6.4.4, does not ask for a dynamic analysis here: limits on dynamic values go beyond what it "
           "asks.";
  }
  return fmt::format("Whether EN 1991-2, 6.4.4, asks for a dynamic analysis is open: {}.", open->need.reason);
}

std::optional<UnloadingBeside> unloading_beside(const Assessment& assessment, const Verdict& verdict) {
  const std::string& measure = verdict.clause->measure;
  if (!verdict.at || !(measure.starts_with("deck_") || measure == "horizontal_rotation")) return std::nullopt;
  if (verdict.at->run.empty()) return UnloadingBeside{{}, "moving forces have no wheels"};
  UnloadingBeside beside{{}, "the run has none"};
  for (const MeasuredValue& value : assessment.values) {
    if (value.measure != "wheel_unloading" || value.run != verdict.at->run) continue;
    if (!beside.value || value.value > beside.value->value) beside.value = value;
  }
  for (const MissingMeasure& missing : assessment.missing) {
    if (missing.measure == "wheel_unloading" && !missing.partly) beside.reason = missing.reason;
  }
  if (beside.value) beside.reason.clear();
  return beside;
}

std::string unloading_in_words(const UnloadingBeside& beside) {
  if (!beside.value) return "none: " + beside.reason;
  return amount_in_words(beside.value->value, "-") + ", " + spot_in_words(*beside.value);
}

std::string amount_in_words(double value, std::string_view unit) {
  const ShownUnit shown = shown_unit(unit);
  const double amount = shown.factor * value;
  const int digits = std::abs(amount) >= 100.0 ? 1 : std::abs(amount) >= 10.0 ? 2 : 3;
  return fmt::format("{:.{}f}{}{}", amount, digits, shown.name.empty() ? "" : " ", shown.name);
}

}  // namespace railtab::assess
