#include "assessment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace railtab::assess {

int Assessment::count(Outcome outcome) const {
  return static_cast<int>(
      std::count_if(verdicts.begin(), verdicts.end(), [&](const Verdict& v) { return v.outcome == outcome; }));
}

int Assessment::failures(bool verified_only) const {
  return static_cast<int>(std::count_if(verdicts.begin(), verdicts.end(), [&](const Verdict& v) {
    return v.failed() && (v.clause->verified || !verified_only);
  }));
}

std::string verdict_in_words(const Assessment& assessment) {
  const int failed = assessment.failures(false), verified = assessment.failures(true),
            passed = assessment.count(Outcome::pass), open = assessment.count(Outcome::not_judged);
  const auto clauses = [](int n) { return fmt::format("{} limit{}", n, n == 1 ? "" : "s"); };
  const std::string rest = fmt::format("{} met, {} not judged", passed, open);
  if (failed == 0 && passed == 0) return fmt::format("NOTHING JUDGED: {} not judged", open);
  if (failed == 0) return fmt::format("PASSES as far as it was judged: {} met, {} not judged", clauses(passed), open);
  const std::string how = verified == failed ? "" : fmt::format(" ({} of them verified)", verified);
  return fmt::format("FAILS: {} not met{}, {}", clauses(failed), how, rest);
}

std::string place_in_words(const MeasuredValue& value) {
  std::string text = value.train;
  const auto add = [&](const std::string& part) {
    if (part.empty()) return;
    if (!text.empty()) text += ", ";
    text += part;
  };
  if (value.speed) add(fmt::format("{:.1f} km/h", 3.6 * *value.speed));
  if (value.seed) add(fmt::format("seed {}", *value.seed));
  add(value.where);
  if (value.time) add(fmt::format("t = {:.3f} s", *value.time));
  return text;
}

std::string onset_in_words(const Assessment& assessment, const Verdict& verdict) {
  if (verdict.outcome != Outcome::fail || verdict.stage != AssessmentStage::moving_load) return {};
  const auto quantity = verdict.clause->measure == "deck_acceleration"   ? &PassagePeaks::acceleration
                        : verdict.clause->measure == "deck_displacement" ? &PassagePeaks::displacement
                                                                         : &PassagePeaks::end_rotation;
  const PassagePeaks *first = nullptr, *lowest = nullptr;
  std::string train;
  for (const DeckAssessment& deck : assessment.decks) {
    for (const TrainResponse& response : deck.responses) {
      for (const PassagePeaks& p : response.passages) {
        if (!lowest || p.speed < lowest->speed) lowest = &p;
        if (!((p.*quantity).value > verdict.limit) || (first && p.speed >= first->speed)) continue;
        first = &p;
        train = deck.trains[response.train].name;
      }
    }
  }
  if (!first) return {};
  return fmt::format("{} at {:.0f} km/h{} ({})", first->speed > lowest->speed ? "first exceeded" : "exceeded already",
                     3.6 * first->speed, first->speed > lowest->speed ? "" : ", the lowest speed computed", train);
}

std::string standing_in_words(const Assessment& assessment) {
  int read = 0, unverified = 0;
  for (const Verdict& v : assessment.verdicts) {
    if (v.outcome == Outcome::pass || v.outcome == Outcome::fail) ++(v.clause->verified ? read : unverified);
  }
  if (read + unverified == 0) return {};
  return fmt::format(
      "Of the limits judged, {} were read in the source that is named; {} are unverified: check them in the "
      "standard.",
      read, unverified);
}

std::string need_in_words(const Assessment& assessment) {
  const auto with = [&](DynamicNeed need) {
    return std::find_if(assessment.decks.begin(), assessment.decks.end(),
                        [&](const DeckAssessment& d) { return d.need.need == need; });
  };
  if (assessment.decks.empty()) return {};
  if (with(DynamicNeed::required) != assessment.decks.end()) return "EN 1991-2, 6.4.4, asks for a dynamic analysis.";
  const auto open = with(DynamicNeed::undecided);
  if (open == assessment.decks.end()) return "EN 1991-2, 6.4.4, does not ask for a dynamic analysis here.";
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
  std::string text = amount_in_words(beside.value->value, "-") + ", " + beside.value->where;
  if (beside.value->time) text += fmt::format(", t = {:.3f} s", *beside.value->time);
  return text;
}

std::string amount_in_words(double value, std::string_view unit) {
  const ShownUnit shown = shown_unit(unit);
  const double amount = shown.factor * value;
  const int digits = std::abs(amount) >= 100.0 ? 1 : std::abs(amount) >= 10.0 ? 2 : 3;
  return fmt::format("{:.{}f}{}{}", amount, digits, shown.name.empty() ? "" : " ", shown.name);
}

std::vector<const Verdict*> ordered(const std::vector<Verdict>& verdicts) {
  std::vector<const Verdict*> list;
  for (const Verdict& verdict : verdicts) {
    if (verdict.outcome != Outcome::not_applicable) list.push_back(&verdict);
  }
  const auto rank = [](const Verdict* v) {
    if (v->failed()) return 0;
    return v->outcome == Outcome::fail ? 1 : v->outcome == Outcome::pass ? 2 : 3;
  };
  std::stable_sort(list.begin(), list.end(), [&](const Verdict* a, const Verdict* b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return rank(a) < 3 && a->utilisation() > b->utilisation();
  });
  return list;
}

}  // namespace railtab::assess
