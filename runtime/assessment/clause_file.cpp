#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/assessment/clause.hpp"
#include "railtab/runtime/assessment/measure_kind.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"

namespace railtab {
namespace {

constexpr double any = 1e12;

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureKind& kind : measure_kinds()) names.emplace_back(kind.name);
  return names;
}

ClauseLimit read_limit(TomlSection& s, const std::string& unit) {
  ClauseLimit limit;
  if (s.has("limit") == s.has("limit_by")) {
    throw s.error("limit", s.has("limit") ? "limit and limit_by" : "neither limit nor limit_by",
                  "limit = a number, or a table limit_by with of, factor, constant, exponent, at_most");
  }
  if (s.has("limit")) {
    limit.constant = s.number("limit", {unit, -any, any});
  } else {
    TomlSection by = s.section("limit_by");
    limit.of =
        by.text_of("of", {"span", "axle_load", "static_wheel_load", "nadal_limit", "weinstock_limit", "fra_limit"});
    limit.factor = by.number("factor", {"", -any, any}, 1.0);
    limit.constant = by.number("constant", {unit, -any, any}, 0.0);
    limit.exponent = by.number("exponent", {"", -10.0, 10.0}, 1.0);
    if (by.has("at_most")) limit.at_most = by.number("at_most", {unit, -any, any});
    by.reject_others();
  }
  if (s.has("sense")) limit.lower = s.text_of("sense", {"at most", "at least"}) == "at least";
  return limit;
}

/// The standing that values of vehicles have does not tell a standard from what others say of it.
ReadIn read_where(TomlSection& s) {
  using enum ReadIn;
  if (s.provenance().standing != Standing::assumed) {
    throw s.error("standing", fmt::format("\"{}\"", standing_name(s.provenance().standing)),
                  "read_in = \"standard\" or \"secondary source\"");
  }
  if (!s.has("read_in")) return nothing;
  const std::string name =
      s.text_of("read_in", {std::string(read_in_name(standard)), std::string(read_in_name(secondary_source))});
  return name == read_in_name(standard) ? standard : secondary_source;
}

void read_conditions(TomlSection& s, Clause& clause) {
  std::optional<TomlSection> applies = s.find_section("applies");
  if (!applies) return;
  constexpr NumberKind speed{"km/h", 0.0, 1000.0}, length{"m", 0.0, 1e5};
  if (applies->has("track")) clause.track = applies->text_of("track", {"ballasted", "direct"});
  if (applies->has("line_speed")) clause.line_speed = applies->interval("line_speed", speed);
  if (applies->has("span")) clause.span = applies->interval("span", length);
  applies->reject_others();
}

Clause read_clause(TomlSection& s, const std::string& edition, const std::string& rules) {
  Clause clause;
  clause.edition = edition;
  clause.rules = rules;
  clause.id = s.text("id");
  clause.clause = s.text("clause");
  clause.title = s.text("title");
  clause.measure = s.text_of("measure", measure_names());
  const std::string unit(find_measure(clause.measure)->unit);
  clause.unit = s.text_of("unit", {unit});
  clause.limit = read_limit(s, unit);
  if (s.has("consequence")) clause.consequence = s.text("consequence");
  clause.read_in = read_where(s);
  clause.source = s.provenance().source;
  clause.note = s.provenance().note;
  if (clause.read_in != ReadIn::nothing && clause.source.empty()) {
    throw s.error("source", fmt::format("nothing for a limit that was read in a {}", read_in_name(clause.read_in)),
                  "a text: where the limit was read");
  }
  read_conditions(s, clause);
  s.reject_others();
  return clause;
}

void read_clauses(const toml::table& table, const std::filesystem::path& file, std::vector<Clause>& clauses) {
  SourcedValues values;
  TomlSection root(file, "", table, {}, values);
  const std::string edition = root.text("edition");
  const std::string rules = root.has("rules") ? root.text("rules") : "";
  std::vector<TomlSection> sections = root.sections("clause");
  if (sections.empty()) throw root.error("clause", "nothing", "at least one [[clause]]");
  std::vector<std::string> own;
  for (TomlSection& section : sections) {
    Clause clause = read_clause(section, edition, rules);
    if (std::find(own.begin(), own.end(), clause.id) != own.end()) {
      throw section.error("id", fmt::format("\"{}\" twice", clause.id), "one clause of each id in a file");
    }
    own.push_back(clause.id);
    const auto same = std::find_if(clauses.begin(), clauses.end(), [&](const Clause& c) { return c.id == clause.id; });
    if (same == clauses.end()) {
      clauses.push_back(std::move(clause));
    } else {
      *same = std::move(clause);
    }
  }
  root.reject_others();
}

}  // namespace

std::string_view read_in_name(ReadIn read_in) noexcept {
  switch (read_in) {
    case ReadIn::standard:
      return "standard";
    case ReadIn::secondary_source:
      return "secondary source";
    case ReadIn::nothing:
      break;
  }
  return "nothing";
}

std::vector<Clause> library_clauses() {
  std::vector<const LibraryFile*> files;
  for (const LibraryFile& file : clause_library_files()) files.push_back(&file);
  std::sort(files.begin(), files.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
  std::vector<Clause> clauses;
  for (const LibraryFile* file : files) {
    const std::string place = fmt::format("library/{}.toml", file->name);
    read_clauses(parse_toml(std::string(file->text), place), place, clauses);
  }
  return clauses;
}

std::vector<Clause> clauses_with(const std::vector<std::filesystem::path>& files) {
  std::vector<Clause> clauses = library_clauses();
  for (const std::filesystem::path& file : files) {
    const toml::table table = read_toml(file, "a TOML file of clauses");
    check_toml_kind(table, file, TomlKind::clauses);
    read_clauses(table, file, clauses);
  }
  return clauses;
}

}  // namespace railtab
