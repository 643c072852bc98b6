#include "run_judge.hpp"

#include <fmt/format.h>

namespace railtab::assess {

RunJudge::RunJudge(const RunResults& results, const RunWindow& window, RunMeasures& found)
    : results_(results),
      header_(results.header),
      window_(window),
      records_(count_even_records(results)),
      step_(results.steps[1].time - results.steps[0].time),
      found_(found) {}

void RunJudge::miss(const std::vector<std::string>& measures, const std::string& reason) {
  for (const std::string& measure : measures) {
    found_.missing.push_back({measure, AssessmentStage::contact, reason, false});
  }
}

double RunJudge::grouped(double static_load) {
  constexpr double rounding = 1e-9;
  const auto same = std::ranges::find_if(
      loads_, [&](double other) { return std::abs(static_load - other) <= rounding * std::abs(other); });
  if (same != loads_.end()) return *same;
  loads_.push_back(static_load);
  return static_load;
}

void RunJudge::raise(const std::string& measure, double value, const Spot& spot, double static_load,
                     const FlangeLimits* flange) {
  const double amount = std::abs(value), load = grouped(static_load);
  MeasuredValue& best = best_[{measure, load, flange ? flange->unknown : std::string()}];
  if (!best.measure.empty() && !(amount > best.value)) return;
  best.measure = measure;
  best.stage = AssessmentStage::contact;
  best.value = amount;
  best.where = spot.where;
  best.time = spot.time;
  best.x = spot.x;
  best.y = spot.y;
  best.speed = header_.speed;
  best.quantities["axle_load"] = 2.0 * load;
  best.quantities["static_wheel_load"] = load;
  if (!flange) return;
  for (const auto& [quantity, limit] : flange->values) best.quantities[quantity] = limit;
  best.limits_unknown = flange->unknown;
}

void RunJudge::raise_sections(const std::string& measure, const SectionPercentiles& of, const std::string& name,
                              double static_load, const FlangeLimits* flange) {
  for (const SectionRange& section : of.sections()) {
    raise(measure, section.extreme(), {fmt::format("{}, x = {:.4g} to {:.4g} m", name, section.from, section.to)},
          static_load, flange);
  }
}

bool RunJudge::has(std::string_view measure) const {
  return std::any_of(best_.begin(), best_.end(), [&](const auto& best) { return std::get<0>(best.first) == measure; });
}

void RunJudge::keep() {
  for (auto& [key, value] : best_) found_.values.push_back(std::move(value));
  best_.clear();
}

std::size_t count_even_records(const RunResults& results) {
  const std::vector<StepRecord>& steps = results.steps;
  if (steps.size() < 3) return steps.size();
  const double step = steps[1].time - steps[0].time, last = steps.back().time - steps[steps.size() - 2].time;
  return std::abs(last - step) > 1e-6 * step ? steps.size() - 1 : steps.size();
}

}  // namespace railtab::assess
