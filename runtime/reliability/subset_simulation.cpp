#include "railtab/runtime/reliability/subset_simulation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "railtab/runtime/reliability/counter_random.hpp"
#include "railtab/runtime/reliability/response_surface.hpp"

namespace railtab {
namespace {

constexpr std::uint32_t first_stream = 16;  // of level 0, one for each level

/// Samples of one level: `chains` chains, sample k·chains + c is step k of chain c.
struct LevelSamples {
  std::vector<NormalPoint> points;
  std::vector<double> responses;
  std::size_t chains = 1;
};

NormalPoint random_normal_point(const SubsetOptions& options, std::size_t sample, std::size_t level) {
  NormalPoint point(options.variables);
  for (std::size_t j = 0; j < point.size(); ++j) {
    point[j] = normal_random(options.seed,
                             {sample, static_cast<std::uint32_t>(j), first_stream + static_cast<std::uint32_t>(level)});
  }
  return point;
}

/// Indices of the samples, the largest response first.
std::vector<std::size_t> by_response(const LevelSamples& samples) {
  std::vector<std::size_t> order(samples.responses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return samples.responses[a] > samples.responses[b]; });
  return order;
}

std::size_t count_beyond(const LevelSamples& samples, double threshold) {
  return static_cast<std::size_t>(
      std::count_if(samples.responses.begin(), samples.responses.end(), [&](double y) { return y >= threshold; }));
}

/// γ = 2 Σ_k (1 − k/L)·R(k)/R(0) of the indicator y >= threshold, L steps per chain [AuBeck2001].
double chain_correlation(const LevelSamples& samples, double threshold, double p) {
  const std::size_t chains = samples.chains, length = samples.responses.size() / chains;
  const double variance = p * (1.0 - p);
  if (chains == samples.responses.size() || !(variance > 0.0)) return 0.0;
  const auto beyond = [&](std::size_t c, std::size_t k) {
    return samples.responses[k * chains + c] >= threshold ? 1.0 : 0.0;
  };
  double sum = 0.0;
  for (std::size_t lag = 1; lag < length; ++lag) {
    double covariance = 0.0;
    for (std::size_t c = 0; c < chains; ++c) {
      for (std::size_t k = 0; k + lag < length; ++k) covariance += beyond(c, k) * beyond(c, k + lag);
    }
    covariance = covariance / static_cast<double>(chains * (length - lag)) - p * p;
    sum += (1.0 - static_cast<double>(lag) / static_cast<double>(length)) * covariance / variance;
  }
  return std::max(0.0, 2.0 * sum);
}

/// Threshold of a level whose samples are in the order of their responses: just above the (seeds + 1)-th response, so
/// that the sample which defines it is not among the seeds, and equal ones are not either. That response itself where
/// fewer than two samples are beyond it.
double level_threshold(const LevelSamples& samples, const std::vector<std::size_t>& order, std::size_t seeds) {
  const double response = samples.responses[order[seeds]];
  const double above = std::nextafter(response, INFINITY);
  return count_beyond(samples, above) >= 2 ? above : response;
}

SubsetLevel level_of(const LevelSamples& samples, double threshold) {
  SubsetLevel level;
  const double count = static_cast<double>(samples.responses.size());
  level.threshold = threshold;
  level.probability = static_cast<double>(count_beyond(samples, threshold)) / count;
  level.correlation = chain_correlation(samples, threshold, level.probability);
  if (level.probability > 0.0) {
    level.variation = std::sqrt((1.0 - level.probability) / (level.probability * count) * (1.0 + level.correlation));
  }
  return level;
}

/// log g, g = 1/(1 + exp(−(ŷ − threshold)/s)) with the deviation s of the surface: a soft form of y >= threshold.
class SoftLimit {
 public:
  SoftLimit(const LevelSamples& samples, double threshold)
      : surface_(samples.points, samples.responses),
        threshold_(threshold),
        width_(std::max(surface_.deviation(), 1e-6 * std::abs(threshold) + 1e-300)) {}

  [[nodiscard]] double logarithm(const NormalPoint& point) const {
    const double x = (surface_(point) - threshold_) / width_;
    return std::min(x, 0.0) - std::log1p(std::exp(-std::abs(x)));
  }

 private:
  ResponseSurface surface_;
  double threshold_, width_;
};

/// Where a step leads to by the surface alone.
struct Candidate {
  NormalPoint point;
  double log_ratio = 0.0;  ///< log of g where the step begins over g of the point
};

/// The chains of one level, all a step at a time.
class Chains {
 public:
  Chains(const SubsetOptions& options, const ResponseOfPoints& response) : options_(options), response_(response) {}

  /// From these samples, all beyond the threshold. @param evaluations  most  @return share of the steps that moved
  double run(std::size_t level, double threshold, const std::vector<std::size_t>& seeds, std::size_t evaluations,
             LevelSamples& samples) {
    LevelSamples next;
    next.chains = seeds.size();
    for (const std::size_t i : seeds) {
      next.points.push_back(samples.points[i]);
      next.responses.push_back(samples.responses[i]);
    }
    const SoftLimit limit(samples, threshold);
    const std::size_t steps = evaluations / next.chains;
    double moved = 0.0;
    for (std::size_t step = 1; step <= steps; ++step) moved += advance(level, step, threshold, limit, next);
    moved /= static_cast<double>(steps * next.chains);
    samples = std::move(next);
    return moved;
  }

 private:
  /// One step of every chain. @return how many moved
  double advance(std::size_t level, std::size_t step, double threshold, const SoftLimit& limit, LevelSamples& samples) {
    const std::size_t last = samples.points.size() - samples.chains, first = step * samples.chains;
    std::vector<NormalPoint> points;
    std::vector<double> log_ratios;
    std::size_t moved = 0, moved_by_surface = 0;
    for (std::size_t c = 0; c < samples.chains; ++c) {
      Candidate candidate = follow_surface(samples.points[last + c], level, first + c, limit, moved_by_surface);
      points.push_back(std::move(candidate.point));
      log_ratios.push_back(candidate.log_ratio);
    }
    const std::vector<double> responses = response_(points);
    for (std::size_t c = 0; c < samples.chains; ++c) {
      const bool kept = responses[c] >= threshold && accepted(log_ratios[c], level, first + c, 1);
      moved += kept;
      samples.points.push_back(kept ? std::move(points[c]) : samples.points[last + c]);
      samples.responses.push_back(kept ? responses[c] : samples.responses[last + c]);
    }
    const double chains = static_cast<double>(samples.chains), count = static_cast<double>(moved);
    const double by_surface = static_cast<double>(moved_by_surface) / (chains * surface_steps);
    sigma_ *= std::exp(std::min(count / chains - 0.44, by_surface - 0.4) / std::sqrt(static_cast<double>(step)));
    sigma_ = std::min(sigma_, 1.0);
    return count;
  }

  /// Steps of which each has the distribution φ(u)·g(u) again. @param moved  counts those that move
  [[nodiscard]] Candidate follow_surface(const NormalPoint& from, std::size_t level, std::size_t sample,
                                         const SoftLimit& limit, std::size_t& moved) const {
    const double rho = std::sqrt(1.0 - sigma_ * sigma_), log_from = limit.logarithm(from);
    NormalPoint point = from;
    double log_point = log_from;
    for (std::size_t k = 0; k < surface_steps; ++k) {
      const std::size_t number = sample * surface_steps + k;
      NormalPoint next = random_normal_point(options_, number, level);
      for (std::size_t j = 0; j < next.size(); ++j) next[j] = rho * point[j] + sigma_ * next[j];
      const double log_next = limit.logarithm(next);
      if (!accepted(log_next - log_point, level, number, 0)) continue;
      point = std::move(next);
      log_point = log_next;
      ++moved;
    }
    return {std::move(point), log_from - log_point};
  }

  /// With the probability min(1, exp(log_ratio)). @param stage  0: steps on the surface, 1: whole steps
  [[nodiscard]] bool accepted(double log_ratio, std::size_t level, std::size_t number, std::size_t stage) const {
    return std::log(uniform_random(options_.seed, {number, static_cast<std::uint32_t>(options_.variables + stage),
                                                   first_stream + static_cast<std::uint32_t>(level)})) < log_ratio;
  }

  static constexpr std::size_t surface_steps = 6;
  const SubsetOptions& options_;
  const ResponseOfPoints& response_;
  double sigma_ = 0.6;
};

}  // namespace

SubsetResult subset_simulation(const SubsetOptions& options, const ResponseOfPoints& response) {
  const auto seeds =
      static_cast<std::size_t>(std::llround(options.level_probability * static_cast<double>(options.samples)));
  assert(seeds >= 2 && options.samples % seeds == 0 && options.variables > 0);
  LevelSamples samples;
  for (std::size_t i = 0; i < options.samples; ++i) samples.points.push_back(random_normal_point(options, i, 0));
  samples.responses = response(samples.points);
  samples.chains = options.samples;
  Chains chains(options, response);
  SubsetResult result;
  result.probability = 1.0;
  result.evaluations = options.samples;
  double square = 0.0, acceptance = 1.0;
  std::size_t evaluations = options.samples;
  for (std::size_t number = 1;; ++number) {
    std::vector<std::size_t> order = by_response(samples);
    const bool reached = samples.responses[order[seeds]] >= options.limit;
    const double threshold = reached ? options.limit : level_threshold(samples, order, seeds);
    SubsetLevel& level = result.levels.emplace_back(level_of(samples, threshold));
    level.acceptance = acceptance;
    level.evaluations = evaluations;
    result.probability *= level.probability;
    square += level.variation * level.variation;
    if (reached) break;
    result.outcome = level.probability < 1.0 ? SubsetOutcome::too_rare : SubsetOutcome::stalled;
    if (number == options.most_levels || level.probability == 1.0) break;
    order.resize(std::min(seeds, count_beyond(samples, threshold)));
    std::sort(order.begin(), order.end());
    acceptance = chains.run(number, threshold, order, options.samples - seeds, samples);
    evaluations = samples.points.size() - samples.chains;
    result.evaluations += evaluations;
    result.outcome = SubsetOutcome::found;
  }
  result.variation = std::sqrt(square);
  result.points = std::move(samples.points);
  result.responses = std::move(samples.responses);
  return result;
}

}  // namespace railtab
