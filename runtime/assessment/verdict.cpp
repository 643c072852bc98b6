#include "railtab/runtime/assessment/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace railtab {
namespace {

bool within(double value, const std::array<double, 2>& range) { return value > range[0] && value <= range[1]; }

/// Why a clause does not apply to anything here; empty where it does.
std::string excluded(const Clause& clause, const AssessmentFacts& facts) {
  constexpr double kmh = 3.6;
  const std::vector<std::string>& rules = facts.rules;
  if (!clause.rules.empty() && std::find(rules.begin(), rules.end(), clause.rules) == rules.end()) {
    return fmt::format("of the rules \"{}\"; assessment.rules has {}", clause.rules, fmt::join(rules, ", "));
  }
  if (!clause.track.empty() && clause.track != facts.track) {
    return fmt::format("for {} track; this is {}", clause.track, facts.track);
  }
  if (clause.line_speed && !within(kmh * facts.line_speed * (1.0 - 1e-9), *clause.line_speed)) {
    return fmt::format("for line speeds above {:g} up to {:g} km/h; this is {:.4g} km/h", (*clause.line_speed)[0],
                       (*clause.line_speed)[1], kmh * facts.line_speed);
  }
  return {};
}

/// Whether a clause is about a deck of the value's span; none where that is not known.
std::optional<bool> of_span(const Clause& clause, const MeasuredValue& value) {
  if (!clause.span) return true;
  const auto span = value.quantities.find("span");
  if (span == value.quantities.end()) return std::nullopt;
  return within(span->second, *clause.span);
}

/// What keeps values of a clause's measure from being judged by it.
struct Unjudged {
  bool other_spans = false;
  std::string reason;  ///< of the last value that lacks something; empty: none does
};

std::string no_value_reason(const Clause& clause, const std::vector<MissingMeasure>& missing,
                            const std::string& unjudged) {
  std::string reasons = unjudged;
  for (const MissingMeasure& m : missing) {
    if (m.measure == clause.measure) {
      if (!reasons.empty()) reasons += "; ";
      reasons += fmt::format("{}: {}", stage_name(m.stage), m.reason);
    }
  }
  if (!reasons.empty()) return reasons;
  const MeasureKind* kind = find_measure(clause.measure);
  std::string stages;
  for (const AssessmentStage stage : kind->stages) {
    stages += fmt::format("{}{}", stages.empty() ? "" : " or ", stage_name(stage));
  }
  return fmt::format("needs stage {}", stages);
}

/// The verdict of one stage; none where the stage has no value that the clause is about.
std::optional<Verdict> judge_stage(const Clause& clause, AssessmentStage stage,
                                   const std::vector<MeasuredValue>& values, const std::vector<MissingMeasure>& missing,
                                   Unjudged& unjudged) {
  Verdict verdict{&clause, stage, Outcome::pass, {}, 0.0, {}};
  constexpr double rounding = 1e-9;
  const auto failing = [](const Verdict& v) { return v.at && v.utilisation() > 1.0 + rounding; };
  Verdict overestimated = verdict;
  std::string lacking;
  for (const MeasuredValue& value : values) {
    if (value.measure != clause.measure || value.stage != stage) continue;
    const std::optional<bool> about = of_span(clause, value);
    if (!about) {
      lacking = fmt::format("the span of {} is not known", value.where);
      continue;
    }
    if (!*about) {
      unjudged.other_spans = true;
      continue;
    }
    const std::optional<double> limit = limit_for(clause, value);
    if (!limit || !std::isfinite(*limit) || !std::isfinite(value.value)) {
      const std::string& why = value.limits_unknown;
      lacking =
          !limit ? fmt::format("{} of {} is not known{}{}", clause.limit.of, value.where, why.empty() ? "" : ": ", why)
          : !std::isfinite(*limit) ? fmt::format("the limit of {} is not a number", value.where)
                                   : fmt::format("the value of {} is not a number", value.where);
      continue;
    }
    Verdict next = verdict;
    next.at = value;
    next.limit = *limit;
    Verdict& worst = failing(next) && !value.overestimated.empty() ? overestimated : verdict;
    if (!worst.at || next.utilisation() > worst.utilisation()) worst = std::move(next);
  }
  if (failing(verdict)) {
    verdict.outcome = Outcome::fail;
    return verdict;
  }
  if (overestimated.at) {
    overestimated.outcome = Outcome::not_judged;
    overestimated.reason = overestimated.at->overestimated;
    return overestimated;
  }
  if (!lacking.empty()) unjudged.reason = lacking;
  if (!verdict.at) return std::nullopt;
  if (!lacking.empty()) {
    verdict.outcome = Outcome::not_judged;
    verdict.reason = lacking;
  }
  for (const MissingMeasure& m : missing) {
    if (m.measure != clause.measure || m.stage != stage || !m.partly) continue;
    verdict.outcome = Outcome::not_judged;
    verdict.reason = m.reason;
  }
  return verdict;
}

}  // namespace

std::string_view outcome_name(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::pass:
      return "pass";
    case Outcome::fail:
      return "fail";
    case Outcome::not_applicable:
      return "does not apply";
    case Outcome::not_judged:
      break;
  }
  return "not judged";
}

std::optional<double> limit_for(const Clause& clause, const MeasuredValue& value) {
  const ClauseLimit& limit = clause.limit;
  if (value.measure != clause.measure || !of_span(clause, value).value_or(false)) return std::nullopt;
  if (limit.of.empty()) return limit.constant;
  const auto quantity = value.quantities.find(limit.of);
  if (quantity == value.quantities.end()) return std::nullopt;
  const double found = limit.constant + limit.factor * std::pow(quantity->second, limit.exponent);
  return limit.at_most ? std::min(found, *limit.at_most) : found;
}

double Verdict::utilisation() const noexcept {
  if (!at) return 0.0;
  const double above = clause->limit.lower ? limit : at->value, below = clause->limit.lower ? at->value : limit;
  return below > 0.0 ? above / below : above > below ? INFINITY : 0.0;
}

std::vector<Verdict> judge(const std::vector<Clause>& clauses, const AssessmentFacts& facts,
                           const std::vector<MeasuredValue>& values, const std::vector<MissingMeasure>& missing) {
  using enum AssessmentStage;
  std::vector<Verdict> verdicts;
  for (const Clause& clause : clauses) {
    std::string reason = excluded(clause, facts);
    if (!reason.empty()) {
      verdicts.push_back({&clause, {}, Outcome::not_applicable, std::move(reason), 0.0, {}});
      continue;
    }
    bool any = false;
    Unjudged unjudged;
    for (const AssessmentStage stage : {check, moving_load, contact}) {
      if (auto verdict = judge_stage(clause, stage, values, missing, unjudged)) {
        verdicts.push_back(std::move(*verdict));
        any = true;
      }
    }
    if (any) continue;
    if (unjudged.other_spans && unjudged.reason.empty()) {
      verdicts.push_back({&clause,
                          {},
                          Outcome::not_applicable,
                          fmt::format("for spans above {:g} up to {:g} m", (*clause.span)[0], (*clause.span)[1]),
                          0.0,
                          {}});
    } else {
      verdicts.push_back(
          {&clause, {}, Outcome::not_judged, no_value_reason(clause, missing, unjudged.reason), 0.0, {}});
    }
  }
  return verdicts;
}

}  // namespace railtab
