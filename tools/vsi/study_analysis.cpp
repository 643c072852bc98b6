#include "study_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::vsi {
namespace {

using Progress = std::function<void(double)>;

std::size_t measure_index(const StudyPlan& plan) {
  const auto& all = study_measures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto* kind) { return kind->name == plan.measure; });
  return static_cast<std::size_t>(found - all.begin());
}

/// The measure of a run that came to its end. @throws ComputationError where it has none
double measure_of(const StudyPlan& plan, const StudyRow& row, const std::string& run) {
  const std::optional<double> value = row.measures[measure_index(plan)];
  if (value) return *value;
  throw ComputationError(fmt::format(
      "run {} has no {}: vsi assess of the scene says why (no lateral forces, time steps or records too far apart for "
      "its low-pass, an end before anything is judged)",
      run, plan.measure));
}

/// For limits: a run that ended early, by derailment say, is beyond every one.
double response_of(const StudyPlan& plan, const StudyRow& row, const std::string& run) {
  return row.complete ? measure_of(plan, row, run) : INFINITY;
}

/// Responses of points, which are added to those of the result.
std::vector<double> responses(const StudyPlan& plan, StudyRuns& runs, const std::vector<StudyPoint>& points,
                              const Progress& progress, StudyResult& result) {
  const double all = static_cast<double>(greatest_run_count(plan)), before = static_cast<double>(result.points.size());
  const double these = static_cast<double>(points.size());
  const std::vector<StudyRow> rows = runs.rows(points, [&](double share) { progress((before + share * these) / all); });
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.size(); ++i) values.push_back(response_of(plan, rows[i], runs.name_of(points[i])));
  result.points.insert(result.points.end(), points.begin(), points.end());
  return values;
}

bool same_group(const StudyPlan& plan, const StudyPoint& a, const StudyPoint& b) {
  if (plan.method == StudyMethod::fragility) return a[plan.intensity].number == b[plan.intensity].number;
  for (std::size_t j = 0; j < a.size(); ++j) {
    if (!plan.variables[j].random() && a[j].cell() != b[j].cell()) return false;
  }
  return true;
}

void count_exceedance(const StudyPlan& plan, const StudyRuns& runs, const std::vector<StudyRow>& rows,
                      StudyResult& result) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StudyPoint& point = result.points[i];
    auto group = std::find_if(result.exceedance.begin(), result.exceedance.end(),
                              [&](const ExceedanceCount& e) { return same_group(plan, e.point, point); });
    if (group == result.exceedance.end()) {
      group = result.exceedance.insert(group, ExceedanceCount{point, 0, 0, 0, {}});
    }
    ++group->runs;
    group->ended_early += !rows[i].complete;
    group->exceeded += response_of(plan, rows[i], runs.name_of(point)) >= plan.limit;
  }
  for (ExceedanceCount& group : result.exceedance) {
    group.probability = wilson_interval(group.exceeded, group.runs, plan.confidence);
  }
}

/// Which sample a planned point has; without random variables, or with one sample of them, which point of the grid of
/// the variables other than the intensity.
std::size_t sample_of(const StudyPlan& plan, std::size_t point) {
  if (plan.sampling.samples > 1) return point % plan.sampling.samples;
  std::size_t faster = 1;  // points of the variables after the intensity
  for (std::size_t j = plan.intensity + 1; j < plan.variables.size(); ++j) {
    if (!plan.variables[j].random()) faster *= plan.variables[j].values.size();
  }
  const std::size_t intensities = plan.variables[plan.intensity].values.size();
  return point / (faster * intensities) * faster + point % faster;
}

void fit(const StudyPlan& plan, const StudyRuns& runs, const std::vector<StudyRow>& rows, StudyResult& result) {
  std::sort(result.exceedance.begin(), result.exceedance.end(), [&](const auto& a, const auto& b) {
    return a.point[plan.intensity].number < b.point[plan.intensity].number;
  });
  std::vector<double> intensities;
  for (const ExceedanceCount& group : result.exceedance) intensities.push_back(group.point[plan.intensity].number);
  const std::vector<std::size_t> none(intensities.size(), 0);
  std::vector<FragilitySample> samples;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StudyPoint& point = result.points[i];
    const std::size_t sample = sample_of(plan, i);
    if (sample >= samples.size()) samples.resize(sample + 1, {none, none});
    const auto at = std::lower_bound(intensities.begin(), intensities.end(), point[plan.intensity].number);
    const auto level = static_cast<std::size_t>(at - intensities.begin());
    ++samples[sample].runs[level];
    samples[sample].exceeded[level] += response_of(plan, rows[i], runs.name_of(point)) >= plan.limit;
  }
  result.fragility =
      fragility_with_bounds(intensities, samples, {plan.replicates, plan.confidence, plan.sampling.seed});
  for (std::size_t i = 0; i < intensities.size(); ++i) result.exceedance[i].probability = result.fragility->observed[i];
}

SubsetOptions subset_options(const StudyPlan& plan) {
  SubsetOptions options;
  options.variables = plan.variables.size();
  options.limit = plan.limit;
  options.samples = plan.sampling.samples;
  options.level_probability = plan.level_probability;
  options.most_levels = plan.most_levels;
  options.seed = plan.sampling.seed;
  return options;
}

void find_subset(const StudyPlan& plan, StudyRuns& runs, const Progress& progress, StudyResult& result) {
  result.subset = subset_simulation(subset_options(plan), [&](const std::vector<NormalPoint>& normal) {
    std::vector<StudyPoint> points;
    for (const NormalPoint& u : normal) {
      std::vector<Probability> probabilities;
      for (const double z : u) probabilities.push_back(normal_probability(z));
      points.push_back(point_at(plan, probabilities));
    }
    return responses(plan, runs, points, progress, result);
  });
}

void find_importance(const StudyPlan& plan, StudyRuns& runs, const Progress& progress, StudyResult& result) {
  const SobolOptions options{plan.variables.size(), plan.sampling.samples, plan.replicates, plan.confidence,
                             plan.sampling.seed};
  result.importance = sobol_indices(options, [&](const UnitPoints& unit) {
    for (const std::vector<double>& u : unit) {
      std::vector<Probability> probabilities;
      for (const double p : u) probabilities.push_back({p, 1.0 - p});
      result.points.push_back(point_at(plan, probabilities));
    }
    const std::vector<StudyRow> rows = runs.rows(result.points, progress);
    std::vector<double> values;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string run = runs.name_of(result.points[i]);
      if (!rows[i].complete) {
        throw ComputationError(
            fmt::format("run {} ended early ({}): importance needs runs that come to their end", run, rows[i].message));
      }
      values.push_back(measure_of(plan, rows[i], run));
    }
    return values;
  });
}

void find_peak(const StudyPlan& plan, StudyRuns& runs, const Progress& progress, StudyResult& result) {
  const std::vector<StudyValue>& values = plan.variables.front().values;
  PeakSearchOptions options;
  options.points = values.size();
  options.coarse_step = plan.coarse_step;
  result.peak = search_peak(options, [&](const std::vector<std::size_t>& at) {
    std::vector<StudyPoint> points;
    for (const std::size_t i : at) points.push_back({values[i]});
    return responses(plan, runs, points, progress, result);
  });
  result.points.clear();
  for (const auto& [i, value] : result.peak->values) result.points.push_back({values[i]});
}

void find_thresholds(const StudyPlan& plan, StudyRuns& runs, const Progress& progress, StudyResult& result) {
  const std::vector<StudyValue>& values = plan.variables[plan.intensity].values;
  std::vector<StudyPoint> others = planned_points(plan);
  std::erase_if(others, [&](const StudyPoint& point) { return point[plan.intensity].number != values[0].number; });
  const auto evaluate = [&](const std::vector<SearchPoint>& at) {
    std::vector<StudyPoint> points;
    for (const SearchPoint& p : at) points.emplace_back(others[p.search])[plan.intensity] = values[p.point];
    return responses(plan, runs, points, progress, result);
  };
  const std::vector<ThresholdSearch> searches = search_thresholds(others.size(), values.size(), plan.limit, evaluate);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const auto place = [&](std::size_t at) -> std::optional<StudyThreshold::Place> {
      if (at >= values.size()) return std::nullopt;
      return StudyThreshold::Place{values[at].number, searches[i].values.at(at)};
    };
    const std::size_t reached = searches[i].reached;
    result.thresholds.push_back({others[i], reached > 0 ? place(reached - 1) : std::nullopt, place(reached)});
  }
}

}  // namespace

std::optional<double> StudyThreshold::crossing(double limit) const noexcept {
  if (!below || !reached || !std::isfinite(reached->response)) return std::nullopt;
  const double share = (limit - below->response) / (reached->response - below->response);
  return below->value + share * (reached->value - below->value);
}

std::size_t greatest_run_count(const StudyPlan& plan) {
  const std::size_t samples = plan.sampling.samples;
  std::size_t grid = 1;
  for (const StudyVariable& v : plan.variables) grid *= v.random() ? 1 : v.values.size();
  switch (plan.method) {
    case StudyMethod::subset: {
      const auto seeds = static_cast<std::size_t>(std::llround(plan.level_probability * static_cast<double>(samples)));
      return samples + (plan.most_levels - 1) * (samples - seeds);
    }
    case StudyMethod::importance:
      return samples * (plan.variables.size() + 2);
    case StudyMethod::peak:
      return std::max(grid / 4, (grid - 1) / plan.coarse_step + 2);
    case StudyMethod::threshold: {
      const std::size_t values = plan.variables[plan.intensity].values.size();
      return grid / values * static_cast<std::size_t>(std::bit_width(values));
    }
    case StudyMethod::table:
    case StudyMethod::probability:
    case StudyMethod::fragility:
      break;
  }
  return grid * std::max<std::size_t>(samples, 1);
}

StudyResult analyse(const StudyPlan& plan, StudyRuns& runs, const Progress& progress) {
  StudyResult result;
  if (plan.method == StudyMethod::subset) {
    find_subset(plan, runs, progress, result);
  } else if (plan.method == StudyMethod::importance) {
    find_importance(plan, runs, progress, result);
  } else if (plan.method == StudyMethod::peak) {
    find_peak(plan, runs, progress, result);
  } else if (plan.method == StudyMethod::threshold) {
    find_thresholds(plan, runs, progress, result);
  } else {
    result.points = planned_points(plan);
    const std::vector<StudyRow> rows = runs.rows(result.points, progress);
    count_exceedance(plan, runs, rows, result);
    if (plan.method == StudyMethod::fragility) fit(plan, runs, rows, result);
  }
  return result;
}

}  // namespace railtab::vsi
