#include "assessment_text.hpp"

#include <fmt/format.h>

#include <iterator>

#include "over_speed.hpp"

namespace railtab::assess {
namespace {

std::string_view mark(const Verdict& verdict) {
  if (verdict.failed()) return "FAIL";
  if (verdict.outcome == Outcome::fail) return "note";
  return verdict.outcome == Outcome::pass ? "pass" : "  - ";
}

/// The verdict of one stage, below its limit.
void stage_lines(const Assessment& assessment, const Verdict& verdict, std::string& text) {
  const Clause& clause = *verdict.clause;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "       {}  {}: {} of {} {}\n", mark(verdict), stage_in_words(verdict.at->stage),
                 amount_in_words(verdict.at->value, clause.unit), clause.limit.lower ? "at least" : "at most",
                 amount_in_words(verdict.limit, clause.unit));
  fmt::format_to(out, "             {}\n", place_in_words(*verdict.at));
  for (const std::string& words : over_speed_in_words(assessment, verdict)) {
    fmt::format_to(out, "             {}\n", words);
  }
  if (const auto beside = unloading_beside(assessment, verdict)) {
    fmt::format_to(out, "             wheel unloading ΔQ/Q0 of the run: {}\n", unloading_in_words(*beside));
  }
  if (verdict.outcome == Outcome::fail && !clause.consequence.empty()) {
    fmt::format_to(out, "             {}\n", clause.consequence);
  }
  if (verdict.outcome == Outcome::not_judged) fmt::format_to(out, "             not judged: {}\n", verdict.reason);
}

void limit_lines(const Assessment& assessment, const LimitVerdicts& limit, std::string& text) {
  const Clause& clause = *limit.clause;
  const auto out = std::back_inserter(text);
  const Verdict& worst = limit.worst();
  if (!worst.at) {
    fmt::format_to(out, "   -   {} ({} {}): {}\n", clause.title, clause.edition, clause.clause, worst.reason);
    return;
  }
  fmt::format_to(out, " {}  {}\n       {} {}, {}\n", mark(worst), clause.title, clause.edition, clause.clause,
                 standing_in_words(clause));
  for (const Verdict* verdict : limit.stages) stage_lines(assessment, *verdict, text);
}

}  // namespace

std::string assessment_text(const Assessment& assessment) {
  std::string text = fmt::format("{}\n{}\n", assessment.scene_name, verdict_in_words(assessment));
  if (const std::string need = need_in_words(assessment); !need.empty()) text += need + "\n";
  if (const std::string standing = standing_in_words(assessment); !standing.empty()) text += standing + "\n";
  text += "\n";
  const auto out = std::back_inserter(text);
  for (const DeckAssessment& deck : assessment.decks) {
    fmt::format_to(out, "{}: {:.6g} m, first frequency {:.3f} Hz; dynamic analysis {}: {}\n", deck.deck.name,
                   deck.deck.length(), deck.deck.first_frequency(), need_name(deck.need.need), deck.need.reason);
  }
  text += "\n";
  bool open = false;
  int elsewhere = 0;
  for (const LimitVerdicts& limit : by_limit(assessment.verdicts)) {
    const Verdict& worst = limit.worst();
    if (worst.outcome == Outcome::not_applicable) continue;
    if (!worst.at && worst.reason.starts_with("needs stage")) {
      ++elsewhere;
      continue;
    }
    if (!worst.at && !open) text += "Not judged:\n";
    open = open || !worst.at;
    limit_lines(assessment, limit, text);
  }
  if (elsewhere > 0) fmt::format_to(out, "{} limits need a stage that was not computed.\n", elsewhere);
  if (const int others = assessment.count(Outcome::not_applicable); others > 0) {
    fmt::format_to(out, "{} limits do not apply here; the page lists them with the reason.\n", others);
  }
  text += "\n";
  for (const StageReport& stage : assessment.stages) {
    fmt::format_to(out, "Stage {}: {}\n", stage_name(stage.stage),
                   stage.done ? fmt::format("{:.2f} s", stage.seconds) : "skipped: " + stage.skipped);
    for (const std::string& note : stage.notes) fmt::format_to(out, "  {}\n", note);
  }
  return text;
}

}  // namespace railtab::assess
