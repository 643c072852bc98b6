#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "railtab/runtime/reliability/standard_normal.hpp"
#include "railtab/runtime/reliability/subset_simulation.hpp"

namespace railtab {

/// A response y of standard normal variables whose probability of y >= limit is known in closed form.
struct KnownLimitState {
  std::string name;
  std::size_t variables;
  double exact, limit;
  std::function<double(const NormalPoint&)> response;
};

/// P(y >= limit) of y = Σu²/2 of an even number of variables: exp(−limit) Σ limit^k/k!, k < variables/2.
inline double radius_probability(std::size_t variables, double limit) {
  double term = std::exp(-limit), sum = 0.0;
  for (std::size_t k = 0; k < variables / 2; ++k) {
    sum += term;
    term *= limit / static_cast<double>(k + 1);
  }
  return sum;
}

/// Its limit, by bisection.
inline double radius_limit(std::size_t variables, double probability) {
  double low = 0.0, high = 100.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (radius_probability(variables, middle) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Linear: y = Σu/√n, P = Φ(−limit). Radius: y = Σu²/2, a limit state that encloses the origin. Two-sided: y = |u1|,
/// P = 2Φ(−limit), two regions apart.
inline std::vector<KnownLimitState> known_limit_states() {
  const auto linear = [](const NormalPoint& u) {
    double sum = 0.0;
    for (const double x : u) sum += x;
    return sum / std::sqrt(static_cast<double>(u.size()));
  };
  const auto radius = [](const NormalPoint& u) { return 0.5 * std::inner_product(u.begin(), u.end(), u.begin(), 0.0); };
  const auto two_sided = [](const NormalPoint& u) { return std::abs(u[0]); };
  std::vector<KnownLimitState> states;
  for (const double p : {1e-3, 1e-4, 1e-5}) {
    states.push_back({"linear", 2, p, -normal_quantile(p), linear});
    states.push_back({"linear", 50, p, -normal_quantile(p), linear});
    states.push_back({"radius", 2, p, radius_limit(2, p), radius});
    states.push_back({"radius", 20, p, radius_limit(20, p), radius});
    states.push_back({"two-sided", 3, p, -normal_quantile(0.5 * p), two_sided});
  }
  return states;
}

struct SubsetRepetitions {
  double mean = 0.0, bias = 0.0, variation = 0.0;  ///< of the probability: bias and deviation over the exact one
  double own_variation = 0.0;                      ///< mean of the method's own estimates
  double mean_evaluations = 0.0, least = INFINITY, greatest = 0.0;
  std::size_t most_evaluations = 0;
};

/// As many samples per level as 5000 evaluations allow, with a level more than the decades of the probability.
inline std::size_t samples_of_budget(double probability) {
  constexpr double budget = 5000.0, repeated = 0.9;  // share of a level's samples that is evaluated anew
  const double further_levels = std::ceil(-std::log10(probability) - 1e-9);
  return 10 * static_cast<std::size_t>(budget / (1.0 + repeated * further_levels) / 10.0);
}

/// Seeds 1 … repetitions.
inline SubsetRepetitions repeat_subset(const KnownLimitState& state, int repetitions) {
  const ResponseOfPoints response = [&](const std::vector<NormalPoint>& points) {
    std::vector<double> values;
    for (const NormalPoint& point : points) values.push_back(state.response(point));
    return values;
  };
  SubsetRepetitions result;
  double square = 0.0;
  const double count = repetitions;
  for (int seed = 1; seed <= repetitions; ++seed) {
    SubsetOptions options;
    options.variables = state.variables;
    options.limit = state.limit;
    options.samples = samples_of_budget(state.exact);
    options.seed = static_cast<std::uint64_t>(seed);
    const SubsetResult run = subset_simulation(options, response);
    result.mean += run.probability / count;
    square += run.probability * run.probability / count;
    result.own_variation += run.variation / count;
    result.mean_evaluations += static_cast<double>(run.evaluations) / count;
    result.most_evaluations = std::max(result.most_evaluations, run.evaluations);
    result.least = std::min(result.least, run.probability);
    result.greatest = std::max(result.greatest, run.probability);
  }
  result.bias = result.mean / state.exact - 1.0;
  result.variation = std::sqrt(std::max(0.0, square - result.mean * result.mean) * count / (count - 1.0)) / state.exact;
  return result;
}

}  // namespace railtab
