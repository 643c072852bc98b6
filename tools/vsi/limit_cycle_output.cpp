#include "limit_cycle_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "railtab/runtime/report/svg_figure.hpp"

namespace railtab::vsi {

namespace {

using Json = nlohmann::ordered_json;
constexpr double kmh_per_ms = 3.6, mm_per_m = 1e3;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

const char* stability_of(const LimitCycle& cycle) { return cycle.is_stable() ? "stable" : "unstable"; }

const char* name_of(Bifurcation bifurcation) {
  return bifurcation == Bifurcation::subcritical ? "subcritical" : "supercritical";
}

Json as_json(const LimitCycle& cycle) {
  return {{"speed", cycle.speed},
          {"amplitude", cycle.amplitude()},
          {"amplitudes", cycle.amplitudes},
          {"frequency", cycle.frequency},
          {"stable", cycle.is_stable()},
          {"multiplier", {cycle.multiplier.real(), cycle.multiplier.imag()}},
          {"steps", cycle.motion.period.steps},
          {"residual", cycle.residual},
          {"error_along_motion", cycle.error_along_motion}};
}

Json as_json(const std::vector<LimitCycle>& cycles) {
  Json rows = Json::array();
  for (const LimitCycle& cycle : cycles) rows.push_back(as_json(cycle));
  return rows;
}

Json as_json(const LimitCycleFold& fold) {
  Json row = as_json(fold.cycle);
  row["converged"] = fold.converged;
  row["bracket"] = as_json(std::vector<LimitCycle>(fold.bracket.begin(), fold.bracket.end()));
  return row;
}

Json as_json(const std::vector<LimitCycleFold>& folds) {
  Json rows = Json::array();
  for (const LimitCycleFold& fold : folds) rows.push_back(as_json(fold));
  return rows;
}

// What a table says of a fold.
std::string note_of(const LimitCycleFold& fold) {
  if (fold.converged) return "  fold";
  const auto& [before, after] = fold.bracket;
  return fmt::format("  fold, not located: between {:.4f} mm at {:.2f} km/h and {:.4f} mm at {:.2f} km/h",
                     mm_per_m * before.amplitude(), kmh_per_ms * before.speed, mm_per_m * after.amplitude(),
                     kmh_per_ms * after.speed);
}

// The parts of the branch that are stable, or those that are not, joined to what comes before.
report::Series part(const HuntingBranch& branch, bool stable, const char* label) {
  report::Series series{label, {}, {}};
  const auto add = [&](double speed, double amplitude) {
    series.x.push_back(kmh_per_ms * speed);
    series.y.push_back(mm_per_m * amplitude);
  };
  for (std::size_t i = 0; i < branch.cycles.size(); ++i) {
    const LimitCycle& cycle = branch.cycles[i];
    const bool begins = i > 0 && branch.cycles[i - 1].is_stable() != stable;
    if (cycle.is_stable() != stable) {
      add(cycle.speed, missing);
      continue;
    }
    if (begins) add(branch.cycles[i - 1].speed, branch.cycles[i - 1].amplitude());
    add(cycle.speed, cycle.amplitude());
  }
  return series;
}

}  // namespace

std::string end_text(BranchEnd end) {
  switch (end) {
    case BranchEnd::parameter_range:
      return "leaves the range of speeds";
    case BranchEnd::height_range:
      return "leaves the range of amplitudes";
    case BranchEnd::max_cycles:
      return "may go on beyond the last cycle";
    case BranchEnd::no_convergence:
      return "ends where Newton's method no longer converges";
    case BranchEnd::stopped:
      break;
  }
  return "was stopped";
}

std::string branch_text(const HuntingBranch& branch) {
  if (branch.cycles.empty()) return "";
  std::string text = fmt::format(
      "  {}lowest speed with a limit cycle, or an unstable state of rest, {:.2f} km/h\n"
      "  the branch {}\n"
      "  {:>8} {:>12} {:>8} {:>9} {:>12}\n",
      branch.bifurcation ? fmt::format("{} bifurcation; ", name_of(*branch.bifurcation)) : "",
      kmh_per_ms * branch.nonlinear_critical_speed().value_or(missing), end_text(branch.end), "km/h", "amplitude mm",
      "Hz", "", "multiplier");
  const auto row = [&](const LimitCycle& cycle, const std::string& note) {
    fmt::format_to(std::back_inserter(text), "  {:8.2f} {:12.4f} {:8.4f} {:>9} {:12.4f}{}\n", kmh_per_ms * cycle.speed,
                   mm_per_m * cycle.amplitude(), cycle.frequency, stability_of(cycle), std::abs(cycle.multiplier),
                   note);
  };
  for (const LimitCycle& cycle : branch.cycles) row(cycle, "");
  for (const LimitCycleFold& fold : branch.folds) row(fold.cycle, note_of(fold));
  return text;
}

Json branch_json(const HuntingBranch& branch) {
  const auto nonlinear = branch.nonlinear_critical_speed();
  return {{"nonlinear_critical_speed", nonlinear ? Json(*nonlinear) : Json()},
          {"bifurcation", branch.bifurcation ? Json(name_of(*branch.bifurcation)) : Json()},
          {"branch_end", end_text(branch.end)},
          {"folds", as_json(branch.folds)},
          {"limit_cycles", as_json(branch.cycles)}};
}

std::string branch_csv(const HuntingBranch& branch) {
  std::string text = "speed_m_s,amplitude_m,frequency_Hz,stable,multiplier_real,multiplier_imaginary,residual";
  const std::size_t wheelsets = branch.cycles.empty() ? 0 : branch.cycles.front().amplitudes.size();
  for (std::size_t w = 1; w <= wheelsets; ++w) text += fmt::format(",amplitude_{}_m", w);
  text += "\n";
  for (const LimitCycle& c : branch.cycles) {
    fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.9g},{},{:.6g},{:.6g},{:.3g}", c.speed, c.amplitude(),
                   c.frequency, c.is_stable() ? 1 : 0, c.multiplier.real(), c.multiplier.imag(), c.residual);
    for (const double amplitude : c.amplitudes) fmt::format_to(std::back_inserter(text), ",{:.9g}", amplitude);
    text += "\n";
  }
  return text;
}

std::string branch_svg(const HuntingBranch& branch, const std::string& heading) {
  report::SvgPanel panel;
  panel.title = "Limit cycles";
  panel.x_label = "speed [km/h]";
  panel.y_label = "lateral amplitude of a wheelset [mm]";
  panel.lines = {part(branch, true, "stable"), part(branch, false, "unstable")};
  panel.styles = {report::LineStyle::solid, report::LineStyle::dashed};
  report::Series critical{"linear critical speed", {}, {}}, folds{"fold", {}, {}};
  if (branch.linear.critical) {
    critical.x.push_back(kmh_per_ms * branch.linear.critical->speed);
    critical.y.push_back(0.0);
  }
  for (const LimitCycleFold& fold : branch.folds) {
    folds.x.push_back(kmh_per_ms * fold.cycle.speed);
    folds.y.push_back(mm_per_m * fold.cycle.amplitude());
  }
  panel.dots = {critical, folds};
  return report::svg_figure(heading, {panel}, 1);
}

}  // namespace railtab::vsi
