#include "assessment_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "assessment_charts.hpp"
#include "over_speed.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab::assess {
namespace {

using report::escaped;

constexpr const char* style = R"(<style>
.verdict{border-left:6px solid;padding:12px 16px;margin:14px 0 18px;font-size:18px;font-weight:600}
.verdict{background:#8795a61f}.verdict.bad{border-color:#c8442f;background:#c8442f1a}.verdict.good{border-color:#2e7d52;background:#2e7d521f}
.verdict p,.verdict ul{margin:4px 0 0;font-size:14px;font-weight:400}
.limits td.more{color:var(--soft)}
.limits{width:100%}.limits td,.limits th{padding:6px 12px 6px 0;border-bottom:1px solid var(--line);font-size:13px}
.limits th{color:var(--soft)}.limits th.n{text-align:right}.limits td.n{white-space:nowrap}.limits small{color:var(--soft)}
.mark{display:inline-block;min-width:76px;border-radius:4px;padding:1px 8px;text-align:center;color:#fff;background:#8795a6}
.mark.fail{background:#c8442f}.mark.pass{background:#2e7d52}.mark.note{background:#b57a00}
.bar{display:inline-block;width:64px;height:8px;background:var(--line);border-radius:2px;overflow:hidden;margin-left:6px}
.bar i{display:block;height:8px;background:#2e7d52}.bar.fail i{background:#c8442f}.bar.note i{background:#b57a00}
.standing{border:1px solid #b57a00;border-radius:3px;padding:0 4px;font-size:11px;white-space:nowrap}
.scroll{overflow-x:auto}@media print{.scroll{overflow:visible}}@page{size:landscape}
</style>)";

std::string_view mark_class(const Verdict& v) {
  if (v.failed()) return "fail";
  if (v.outcome == Outcome::fail) return "note";
  return v.outcome == Outcome::pass ? "pass" : "open";
}

std::string_view mark_text(const Verdict& v) {
  if (v.failed()) return "FAIL";
  if (v.outcome == Outcome::fail) return "not met";
  return v.outcome == Outcome::pass ? "pass" : "not judged";
}

std::string clause_cell(const Clause& clause) {
  std::string cell = fmt::format("{}<br><small>{}, {}</small><br>", escaped(clause.title), escaped(clause.edition),
                                 escaped(clause.clause));
  if (clause.verified()) return cell + fmt::format("<small>read in: {}</small>", escaped(clause.source));
  return cell + fmt::format("<span class=\"standing\">{}</span> <small>{}</small>", standing_in_words(clause),
                            escaped(clause.source));
}

/// Beside what a deck does stands what the wheels do.
std::string unloading_cell(const Assessment& assessment, const Verdict& v) {
  const auto beside = unloading_beside(assessment, v);
  if (!beside) return "";
  if (!beside->value) return "<small>none: " + escaped(beside->reason) + "</small>";
  return fmt::format("<b>{}</b><br><small>{}</small>", amount_in_words(beside->value->value, "-"),
                     escaped(spot_in_words(*beside->value)));
}

std::string mark_cell(const Verdict& v) {
  return fmt::format("<span class=\"mark {}\">{}</span>", mark_class(v), mark_text(v));
}

/// Rows of one stage of a limit, without the cells that all its stages share. @pre the stage has a value
std::vector<std::string> stage_rows(const Assessment& assessment, const Verdict& v) {
  const Clause& clause = *v.clause;
  const double share = 100.0 * v.utilisation();  // infinite beyond a limit of zero or below
  std::vector<std::string> rows{fmt::format(
      "<td>{}<br>{}</td><td class=\"n\"><b>{}</b></td><td class=\"n\">{} {}</td><td class=\"n\">{}"
      "<span class=\"bar {}\"><i style=\"width:{:.0f}%\"></i></span></td><td>{}{}</td><td>{}</td>",
      stage_in_words(*v.stage), mark_cell(v), amount_in_words(v.at->value, clause.unit), clause.limit.lower ? "≥" : "≤",
      amount_in_words(v.limit, clause.unit), std::isfinite(share) ? fmt::format("{:.0f} %", share) : "–", mark_class(v),
      std::min(100.0, share), escaped(place_in_words(*v.at)),
      v.at->run.empty() ? "" : "<br><small>run " + escaped(v.at->run) + "</small>", unloading_cell(assessment, v))};
  std::vector<std::string> more = over_speed_in_words(assessment, v);
  if (v.outcome == Outcome::fail && !clause.consequence.empty()) more.push_back(clause.consequence);
  if (v.outcome == Outcome::not_judged) more.push_back("not judged: " + v.reason);
  for (const std::string& words : more) {
    rows.push_back(fmt::format("<td class=\"more\" colspan=\"6\">→ {}</td>", escaped(words)));
  }
  return rows;
}

std::string limit_rows(const Assessment& assessment, const LimitVerdicts& limit) {
  const Verdict& worst = limit.worst();
  std::vector<std::string> rows;
  if (!worst.at) rows.push_back(fmt::format("<td colspan=\"6\">{}</td>", escaped(worst.reason)));
  for (const Verdict* v : limit.stages) {
    if (!v->at) continue;
    for (std::string& row : stage_rows(assessment, *v)) rows.push_back(std::move(row));
  }
  std::string html = fmt::format("<tr><td rowspan=\"{0}\">{1}</td><td rowspan=\"{0}\">{2}</td>", rows.size(),
                                 mark_cell(worst), clause_cell(*limit.clause));
  for (std::size_t i = 0; i < rows.size(); ++i) html += fmt::format("{}{}</tr>\n", i == 0 ? "" : "<tr>", rows[i]);
  return html;
}

std::string verdict_table(const Assessment& assessment, bool judged) {
  std::string rows;
  for (const LimitVerdicts& limit : by_limit(assessment.verdicts)) {
    const Verdict& worst = limit.worst();
    if (worst.outcome == Outcome::not_applicable || worst.at.has_value() != judged) continue;
    rows += limit_rows(assessment, limit);
  }
  if (rows.empty()) return "";
  const std::string_view columns =
      judged ? "<th>stage</th><th class=\"n\">value</th><th class=\"n\">limit</th><th class=\"n\">of the limit</th>"
               "<th>largest at</th><th>ΔQ/Q0 of that run</th>"
             : "<th colspan=\"6\">why</th>";
  return fmt::format(
      "<div class=\"scroll\"><table class=\"limits\"><tr><th>verdict</th><th>limit of</th>{}</tr>{}</table></div>",
      columns, rows);
}

/// A limit that fails, with the values of all its stages.
std::string failure(const Assessment& assessment, const LimitVerdicts& limit) {
  const Clause& clause = *limit.clause;
  std::string html = fmt::format("<p><b>{}</b> ({} {}, limit {})</p><ul>", escaped(clause.title),
                                 escaped(clause.edition), escaped(clause.clause), standing_in_words(clause));
  for (const Verdict* v : limit.stages) {
    html += fmt::format("<li>{}{}: {}, {} {} {}, {} {}", stage_in_words(*v->stage),
                        v->failed() ? "" : fmt::format(" ({})", mark_text(*v)),
                        amount_in_words(v->at->value, clause.unit), clause.limit.lower ? "at least" : "at most",
                        amount_in_words(v->limit, clause.unit), clause.limit.lower ? "required" : "permitted",
                        v->at->train.empty() ? "at" : "with", escaped(place_in_words(*v->at)));
    for (const std::string& words : over_speed_in_words(assessment, *v)) html += "; " + escaped(words);
    html += ".</li>";
  }
  return html + "</ul>";
}

std::string banner(const Assessment& assessment) {
  const bool bad = assessment.failures(false) > 0;
  std::string html =
      fmt::format("<div class=\"verdict {}\">{}", bad ? "bad" : "good", escaped(verdict_in_words(assessment)));
  for (const LimitVerdicts& limit : by_limit(assessment.verdicts)) {
    if (limit.worst().failed()) html += failure(assessment, limit);
  }
  for (const std::string& more : {need_in_words(assessment), standing_in_words(assessment)}) {
    if (!more.empty()) html += "<p>" + escaped(more) + "</p>";
  }
  return html + "</div>";
}

std::string deck_table(const Assessment& assessment) {
  std::string html;
  for (const DeckAssessment& deck : assessment.decks) {
    std::string frequencies;
    for (int n = 0; n < deck.deck.dynamic_modes; ++n) {
      frequencies += fmt::format("{}{:.3f}", n == 0 ? "" : ", ", deck.deck.frequency(n));
    }
    html += fmt::format(
        "<h3>{}</h3><table><tr><td>length</td><td>{:.6g} m</td></tr><tr><td>natural frequencies</td><td>{} Hz</td>"
        "</tr><tr><td>damping of the first bending mode</td><td>{:.2f} %</td></tr><tr><td>accelerations count up "
        "to</td><td>{:.1f} Hz (the greatest of 30 Hz, 1.5 f₁ and f₃; f₁ = {:.3f} Hz and f₃ = {:.3f} Hz bend the "
        "deck)</td></tr><tr><td>dynamic analysis by EN 1991-2, 6.4.4</td>"
        "<td><b>{}</b>: {}</td></tr></table>",
        escaped(deck.deck.name), deck.deck.length(), frequencies, 100.0 * deck.deck.damping[deck.deck.first_bending],
        deck.cut_off, deck.deck.frequency(deck.deck.first_bending), deck.deck.frequency(deck.deck.third_bending),
        need_name(deck.need.need), escaped(deck.need.reason));
  }
  return html;
}

std::string run_table(const Assessment& assessment) {
  if (assessment.runs.empty()) return "";
  constexpr const char* columns[] = {"wheel_unloading",   "derailment_2m",       "track_shift_2m",
                                     "wheel_force",       "deck_acceleration",   "deck_displacement",
                                     "car_body_vertical", "running_rms_vertical"};
  constexpr const char* heads[] = {
      "ΔQ/Q0", "Y/Q, 2 m", "ΣY, 2 m", "Q", "deck acceleration", "deck displacement", "car body", "car body, 1 s rms"};
  std::string html =
      "<div class=\"scroll\"><table class=\"limits\"><tr><th>run</th><th>train</th><th>km/h</th><th>seed</th>";
  for (const char* head : heads) html += fmt::format("<th class=\"n\">{}</th>", head);
  html += "<th></th></tr>";
  for (const RunAssessment& run : assessment.runs) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.1f}</td><td>{}</td>", escaped(run.name), escaped(run.train),
                        3.6 * run.speed, run.seed ? fmt::format("{}", *run.seed) : "");
    for (const char* column : columns) {
      const MeasuredValue* best = nullptr;
      for (const MeasuredValue& v : run.values) {
        if (v.measure == column && (!best || v.value > best->value)) best = &v;
      }
      html +=
          fmt::format("<td class=\"n\">{}</td>", best ? amount_in_words(best->value, find_measure(column)->unit) : "–");
    }
    html += fmt::format("<td>{}</td></tr>", run.complete ? "" : escaped("ended early: " + run.message));
  }
  return html + "</table></div>";
}

std::string measure_table(const Assessment& assessment) {
  std::map<std::pair<std::string, AssessmentStage>, const MeasuredValue*> best;
  for (const MeasuredValue& value : assessment.values) {
    const MeasuredValue*& b = best[{value.measure, value.stage}];
    if (!b || value.value > b->value) b = &value;
  }
  std::string rows;
  for (const MeasureKind& kind : measure_kinds()) {
    for (const AssessmentStage stage : kind.stages) {
      const auto found = best.find({std::string(kind.name), stage});
      if (found == best.end()) continue;
      rows += fmt::format("<tr><td>{}<br><small>{}</small></td><td class=\"n\">{}</td><td>{}</td></tr>",
                          escaped(kind.meaning), stage_name(stage), amount_in_words(found->second->value, kind.unit),
                          escaped(place_in_words(*found->second)));
    }
  }
  if (rows.empty()) return "";
  return "<div class=\"scroll\"><table class=\"limits\"><tr><th>measure</th><th class=\"n\">largest</th><th>at</th>"
         "</tr>" +
         rows + "</table></div>";
}

std::string list_of(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string html = "<ul>";
  for (const std::string& sentence : sentences) html += "<li>" + escaped(sentence) + "</li>";
  return html + "</ul>";
}

std::string stage_list(const Assessment& assessment) {
  std::string html;
  for (const StageReport& stage : assessment.stages) {
    html +=
        fmt::format("<h3>{}</h3><p class=\"lead\">{}</p>", stage_name(stage.stage),
                    stage.done ? fmt::format("done in {:.2f} s", stage.seconds) : "skipped: " + escaped(stage.skipped));
    html += list_of(stage.notes);
  }
  return html;
}

std::string others(const Assessment& assessment) {
  std::string rows;
  for (const Verdict& v : assessment.verdicts) {
    if (v.outcome != Outcome::not_applicable) continue;
    rows += fmt::format("<tr><td>{}<br><small>{}, {}</small></td><td>{}</td></tr>", escaped(v.clause->title),
                        escaped(v.clause->edition), escaped(v.clause->clause), escaped(v.reason));
  }
  std::string html;
  if (!rows.empty()) {
    html =
        "<details><summary>Clauses that do not apply</summary><table class=\"limits\">" + rows + "</table></details>";
  }
  return html + fmt::format("<details><summary>Scene {}</summary><pre>{}</pre></details>",
                            escaped(assessment.scene_file), escaped(assessment.scene_text));
}

}  // namespace

std::string assessment_page(const Assessment& assessment) {
  std::string body = style;
  body += fmt::format("<h1>{}</h1><p class=\"lead\">Line speed {:.4g} km/h, {} track. {}.</p>",
                      escaped(assessment.scene_name), 3.6 * assessment.facts.line_speed, assessment.facts.track,
                      assessment.high_speed > 0.0
                          ? fmt::format("Moving loads from {:.4g} km/h to {:.4g} km/h, 1.2 times the line speed",
                                        3.6 * assessment.low_speed, 3.6 * assessment.high_speed)
                          : "No moving loads");
  body += banner(assessment);
  body += report::html_section("Warnings of the runs", list_of(assessment.warnings));
  body += report::html_section("Limits", verdict_table(assessment, true));
  body += report::html_section("Decks", deck_table(assessment));
  body += report::html_section("Resonance of moving loads", resonance_charts(assessment));
  body += report::html_section("Runs with wheel–rail contact", run_table(assessment) + run_charts(assessment));
  body += report::html_section("Not judged", verdict_table(assessment, false));
  body += report::html_section("All measures", measure_table(assessment));
  body += report::html_section("What was computed", stage_list(assessment));
  body += report::html_section("More", others(assessment));
  return report::html_page(assessment_page_kind, assessment.scene_name + ": assessment", body, assessment.version);
}

}  // namespace railtab::assess
