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

void RunJudge::raise(const std::string& measure, double value, const Spot& spot, double group) {
  const double amount = std::abs(value);
  MeasuredValue& best = best_[{measure, group}];
  if (!best.measure.empty() && !(amount > best.value)) return;
  best.measure = measure;
  best.stage = AssessmentStage::contact;
  best.value = amount;
  best.where = spot.where;
  best.time = spot.time;
  best.x = spot.x;
  best.y = spot.y;
  best.speed = header_.speed;
  best.quantities["axle_load"] = 2.0 * group;
  best.quantities["static_wheel_load"] = group;
  for (const auto& [quantity, limit] : limits_) best.quantities[quantity] = limit;
}

void RunJudge::raise_sections(const std::string& measure, const SectionPercentiles& of, const std::string& name,
                              double group) {
  for (const SectionRange& section : of.sections()) {
    raise(measure, section.extreme(), {fmt::format("{}, x = {:.4g} to {:.4g} m", name, section.from, section.to)},
          group);
  }
}

bool RunJudge::has(std::string_view measure) const {
  return std::any_of(best_.begin(), best_.end(), [&](const auto& best) { return best.first.first == measure; });
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
