#include "outcome_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace railtab::stability {
namespace {

std::string without(std::string text, char unwanted) {
  std::replace(text.begin(), text.end(), unwanted, ';');
  return text;
}

std::string error_text(const Row& row) {
  const bool measured = row.result.outcome == Outcome::converged || row.result.outcome == Outcome::wrong;
  return measured ? fmt::format("{:.1e}", row.result.error) : "";
}

/// Gain of energy of a step, of the whole run and of an impact.
std::array<std::string, 3> energy_texts(const EnergyResult& energy) {
  if (!energy.kept) return {};
  return {fmt::format("{:.0e}", energy.step), fmt::format("{:+.0e}", energy.total),
          energy.impacts > 0 ? fmt::format("{:.1e}", energy.impact) : ""};
}

}  // namespace

std::string text_line(const Row& row) {
  const CaseResult& r = row.result;
  const auto [step, total, impact] = energy_texts(r.energy);
  return fmt::format("{:<34} {:<48} {:<9}{} {:>8} {:>6} {:>6} {:>7} {:>7.1f} s  {}\n", row.one.group, row.one.setting,
                     outcome_name(r.outcome), as_expected(row.one, r) ? " " : "!", error_text(row), step, total, impact,
                     r.seconds, r.note);
}

std::string csv_text(const std::vector<Row>& rows) {
  std::string text =
      "group,case,outcome,expected,error,stated,measure,steps,halved_steps,energy_step,energy_run,impacts,"
      "energy_impact,seconds,note\n";
  for (const Row& row : rows) {
    const CaseResult& r = row.result;
    const auto [step, total, impact] = energy_texts(r.energy);
    text += fmt::format("{},{},{},{},{},{:g},{},{},{},{},{},{},{},{:.2f},{}\n", without(row.one.group, ','),
                        without(row.one.setting, ','), outcome_name(r.outcome), outcome_name(row.one.expected),
                        error_text(row), row.one.allowed, without(row.one.measure, ','), r.steps, r.halved_steps, step,
                        total, r.energy.impacts, impact, r.seconds, without(r.note, ','));
  }
  return text;
}

}  // namespace railtab::stability
