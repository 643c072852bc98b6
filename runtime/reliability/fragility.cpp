#include "railtab/runtime/reliability/fragility.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "railtab/runtime/reliability/counter_random.hpp"
#include "railtab/runtime/reliability/replicates.hpp"
#include "railtab/runtime/reliability/standard_normal.hpp"

namespace railtab {
namespace {

constexpr std::uint32_t bootstrap_stream = 8;

/// Φ(a + b·t) with t = (ln x − centre)/width, in which the regression is well scaled.
struct Probit {
  double a = 0.0, b = 0.0;
};

struct ScaledLevel {
  double t, runs, exceeded;
};

double log_likelihood(const std::vector<ScaledLevel>& levels, const Probit& probit) {
  double sum = 0.0;
  for (const ScaledLevel& level : levels) {
    const Probability p = normal_probability(probit.a + probit.b * level.t);
    if (level.exceeded > 0.0) sum += level.exceeded * std::log(p.below);
    if (level.runs > level.exceeded) sum += (level.runs - level.exceeded) * std::log(p.above);
  }
  return sum;
}

/// Score and expected information of the likelihood give the step of Fisher scoring.
Probit scoring_step(const std::vector<ScaledLevel>& levels, const Probit& probit) {
  double score_a = 0.0, score_b = 0.0, aa = 0.0, ab = 0.0, bb = 0.0;
  for (const ScaledLevel& level : levels) {
    const double eta = probit.a + probit.b * level.t, density = normal_density(eta);
    const Probability p = normal_probability(eta);
    const double product = p.below * p.above;
    if (!(product > 0.0)) continue;
    const double residual = density * (level.exceeded * p.above - (level.runs - level.exceeded) * p.below) / product;
    const double weight = level.runs * density * density / product;
    score_a += residual;
    score_b += residual * level.t;
    aa += weight;
    ab += weight * level.t;
    bb += weight * level.t * level.t;
  }
  const double determinant = aa * bb - ab * ab;
  return {(bb * score_a - ab * score_b) / determinant, (aa * score_b - ab * score_a) / determinant};
}

void add(const FragilitySample& sample, std::vector<FragilityLevel>& levels) {
  assert(sample.runs.size() == levels.size() && sample.exceeded.size() == levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].runs += sample.runs[i];
    levels[i].exceeded += sample.exceeded[i];
  }
}

std::vector<FragilityLevel> without_runs(const std::vector<double>& intensities) {
  std::vector<FragilityLevel> levels;
  for (const double x : intensities) levels.push_back({x, 0, 0});
  return levels;
}

// Samples are drawn whole: outcomes of a sample at neighbouring intensities are nearly one.
std::vector<FragilityLevel> drawn_again(const std::vector<double>& intensities,
                                        const std::vector<FragilitySample>& samples, std::uint64_t replicate,
                                        std::uint64_t seed) {
  std::vector<FragilityLevel> drawn = without_runs(intensities);
  const auto count = static_cast<double>(samples.size());
  for (std::uint32_t number = 0; number < samples.size(); ++number) {
    const double at = count * uniform_random(seed, {replicate, number, bootstrap_stream});
    add(samples[std::min(static_cast<std::size_t>(at), samples.size() - 1)], drawn);
  }
  return drawn;
}

}  // namespace

double FragilityCurve::probability(double intensity) const noexcept {
  return normal_probability(std::log(intensity / median) / deviation).below;
}

bool levels_overlap(const std::vector<FragilityLevel>& levels) {
  double least_exceeded = INFINITY, most_stood = -INFINITY;
  for (const FragilityLevel& level : levels) {
    if (level.exceeded > 0) least_exceeded = std::min(least_exceeded, level.intensity);
    if (level.exceeded < level.runs) most_stood = std::max(most_stood, level.intensity);
  }
  return least_exceeded < most_stood;
}

std::optional<FragilityCurve> fit_fragility(const std::vector<FragilityLevel>& levels) {
  if (!levels_overlap(levels)) return std::nullopt;
  double low = INFINITY, high = -INFINITY;
  for (const FragilityLevel& level : levels) {
    low = std::min(low, std::log(level.intensity));
    high = std::max(high, std::log(level.intensity));
  }
  const double centre = 0.5 * (low + high), width = 0.5 * (high - low);
  std::vector<ScaledLevel> scaled;
  for (const FragilityLevel& level : levels) {
    scaled.push_back({(std::log(level.intensity) - centre) / width, static_cast<double>(level.runs),
                      static_cast<double>(level.exceeded)});
  }
  Probit probit;
  double likelihood = log_likelihood(scaled, probit);
  constexpr int most_iterations = 200;
  constexpr double small = 1e-12;
  bool converged = false;
  for (int i = 0; i < most_iterations && !converged; ++i) {
    const Probit step = scoring_step(scaled, probit);
    if (!std::isfinite(step.a) || !std::isfinite(step.b)) return std::nullopt;
    double share = 1.0;
    Probit next{probit.a + step.a, probit.b + step.b};
    while (share > small && !(log_likelihood(scaled, next) >= likelihood)) {
      share *= 0.5;
      next = {probit.a + share * step.a, probit.b + share * step.b};
    }
    converged =
        std::hypot(next.a - probit.a, next.b - probit.b) < small * (1.0 + std::hypot(next.a, next.b)) || share <= small;
    probit = next;
    likelihood = log_likelihood(scaled, probit);
  }
  if (!converged || !(probit.b > 0.0)) return std::nullopt;
  const FragilityCurve curve{std::exp(centre - width * probit.a / probit.b), width / probit.b};
  if (!std::isfinite(curve.median) || !(curve.median > 0.0)) return std::nullopt;
  return curve;
}

FragilityFit fragility_with_bounds(const std::vector<double>& intensities, const std::vector<FragilitySample>& samples,
                                   const BootstrapOptions& options) {
  FragilityFit fit;
  std::vector<FragilityLevel> levels = without_runs(intensities);
  for (const FragilitySample& sample : samples) add(sample, levels);
  fit.curve = fit_fragility(levels);
  // runs of one sample depend on each other: no more than samples are independent
  for (std::size_t i = 0; i < levels.size(); ++i) {
    double squares = 0.0;
    for (const FragilitySample& s : samples) squares += static_cast<double>(s.runs[i]) * static_cast<double>(s.runs[i]);
    const auto runs = static_cast<double>(levels[i].runs), share = static_cast<double>(levels[i].exceeded) / runs;
    const auto independent = static_cast<std::size_t>(runs * runs / squares);  // the samples, if all have as many runs
    fit.observed.push_back(wilson_interval_of_share(share, independent, options.confidence));
  }
  if (!fit.curve || samples.size() < 2) return fit;
  std::vector<double> medians, deviations;
  std::vector<std::vector<double>> probabilities(levels.size());
  for (std::size_t r = 0; r < options.replicates; ++r) {
    const std::optional<FragilityCurve> curve = fit_fragility(drawn_again(intensities, samples, r, options.seed));
    if (!curve) continue;
    medians.push_back(curve->median);
    deviations.push_back(curve->deviation);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      probabilities[i].push_back(curve->probability(levels[i].intensity));
    }
  }
  fit.replicates = medians.size();
  if (2 * fit.replicates < options.replicates || fit.replicates == 0) return fit;
  fit.median = replicate_interval(fit.curve->median, medians, options.confidence);
  fit.deviation = replicate_interval(fit.curve->deviation, deviations, options.confidence);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    fit.at_levels.push_back(
        replicate_interval(fit.curve->probability(levels[i].intensity), probabilities[i], options.confidence));
  }
  return fit;
}

}  // namespace railtab
