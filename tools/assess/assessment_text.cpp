#include "assessment_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace railtab::assess {
namespace {

std::string_view mark(const Verdict& verdict) {
  if (verdict.failed()) return "FAIL";
  if (verdict.outcome == Outcome::fail) return "note";
  return verdict.outcome == Outcome::pass ? "pass" : "  - ";
}

void verdict_line(const Assessment& assessment, const Verdict& verdict, std::string& text) {
  const Clause& clause = *verdict.clause;
  const auto out = std::back_inserter(text);
  const char* standing = clause.verified ? "" : ", unverified";
  if (!verdict.at) {
    fmt::format_to(out, "   -   {} ({} {}): {}\n", clause.title, clause.edition, clause.clause, verdict.reason);
    return;
  }
  fmt::format_to(out, " {}  {} = {} of {} {}\n", mark(verdict), clause.title,
                 amount_in_words(verdict.at->value, clause.unit), clause.limit.lower ? "at least" : "at most",
                 amount_in_words(verdict.limit, clause.unit));
  fmt::format_to(out, "       {}; {} {}{} [{}]\n", place_in_words(*verdict.at), clause.edition, clause.clause, standing,
                 stage_name(verdict.at->stage));
  if (const auto beside = unloading_beside(assessment, verdict)) {
    fmt::format_to(out, "       wheel unloading ΔQ/Q0 of the run: {}\n", unloading_in_words(*beside));
  }
  const std::string onset = onset_in_words(assessment, verdict);
  if (!onset.empty()) fmt::format_to(out, "       {}\n", onset);
  if (verdict.outcome == Outcome::fail && !clause.consequence.empty()) {
    fmt::format_to(out, "       {}\n", clause.consequence);
  }
  if (verdict.outcome == Outcome::not_judged) fmt::format_to(out, "       not judged: {}\n", verdict.reason);
}

}  // namespace

std::string assessment_text(const Assessment& assessment) {
  std::string text = fmt::format("{}\n{}\n", assessment.scene_name, verdict_in_words(assessment));
  if (const std::string standing = standing_in_words(assessment); !standing.empty()) text += standing + "\n";
  text += "\n";
  const auto out = std::back_inserter(text);
  for (const DeckAssessment& deck : assessment.decks) {
    fmt::format_to(out, "{}: {:.6g} m, first frequency {:.3f} Hz; dynamic analysis {}: {}\n", deck.deck.name,
                   deck.deck.length(), deck.deck.frequency(0), need_name(deck.need.need), deck.need.reason);
  }
  text += "\n";
  bool open = false;
  int elsewhere = 0;
  for (const Verdict* verdict : ordered(assessment.verdicts)) {
    if (!verdict->at && verdict->reason.starts_with("needs stage")) {
      ++elsewhere;
      continue;
    }
    if (!verdict->at && !open) text += "Not judged:\n";
    open = open || !verdict->at;
    verdict_line(assessment, *verdict, text);
  }
  if (elsewhere > 0) fmt::format_to(out, "{} limits need a stage that was not computed.\n", elsewhere);
  text += "\n";
  for (const StageReport& stage : assessment.stages) {
    fmt::format_to(out, "Stage {}: {}\n", stage_name(stage.stage),
                   stage.done ? fmt::format("{:.2f} s", stage.seconds) : "skipped: " + stage.skipped);
    for (const std::string& note : stage.notes) fmt::format_to(out, "  {}\n", note);
  }
  return text;
}

}  // namespace railtab::assess
