#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "railtab/runtime/reliability/proportion.hpp"

namespace railtab {

/// A point in standard normal space, one number per random variable.
using NormalPoint = std::vector<double>;
/// Response y of each point, in their order; the points of one call are independent, so they may run at a time.
/// Infinity counts as beyond every limit; no response may be NaN.
using ResponseOfPoints = std::function<std::vector<double>(const std::vector<NormalPoint>&)>;

struct SubsetOptions {
  std::size_t variables = 1;
  double limit = 0.0;              ///< the probability is that of y >= limit
  std::size_t samples = 1000;      ///< per level, or some fewer; samples · level_probability is a whole number >= 2
  double level_probability = 0.1;  ///< p0; 1/p0 is a whole number
  std::size_t most_levels = 10;
  std::uint64_t seed = 1;
};

enum class SubsetOutcome {
  found,
  too_rare,  ///< limit not reached in most_levels: the probability is an upper bound
  stalled    ///< all responses of a level are alike: the probability is an upper bound
};

struct SubsetLevel {
  double threshold = 0.0;    ///< y beyond which the share `probability` of the level is, or the limit
  double probability = 0.0;  ///< of threshold, given the last one
  double correlation = 0.0;  ///< γ of the chains, 0 for independent samples
  double variation = 0.0;    ///< coefficient of variation of `probability`
  double acceptance = 1.0;   ///< share of the steps that moved
  std::size_t evaluations = 0;
};

struct SubsetResult {
  SubsetOutcome outcome = SubsetOutcome::found;
  double probability = 0.0;
  double variation = 0.0;  ///< coefficient of variation, own estimate: levels taken as independent
  std::vector<SubsetLevel> levels;
  std::size_t evaluations = 0;
  /// Of the last level: points and their responses, those beyond the limit among them.
  std::vector<NormalPoint> points;
  std::vector<double> responses;
};

/// Probability of y >= limit by subset simulation [AuBeck2001]: P = Π P(y > y_j | y > y_(j−1)), each factor about p0
/// but the last, with y >= limit. y_j is the (p0 N + 1)-th largest of the level's N responses. The sample that has it
/// is not among those that go on: one at the threshold itself would make P too large by about 1/(p0 N) per level
/// [BrehierEtAl2015]. Nor are samples of equal response, such as steps of a chain that did not move: fewer than p0 N
/// may go on, with longer chains.
///
/// Samples of a level come from Markov chains that begin at those of the last level beyond its threshold b. A step of
/// delayed acceptance [ChristenFox2005] first moves by steps u' = √(1 − σ²)·u + σ·w, w standard normal
/// [PapaioannouEtAl2015], kept with the probability min(1, g(u')/g(u)), where g = 1/(1 + exp(−(ŷ − b)/s)) and ŷ is a
/// quadratic response surface through the last level, s its deviation (ResponseSurface). y of where they lead is then
/// evaluated, and the whole step kept with the probability min(1, g(u)/g(u')) if y(u') >= b. So samples have the
/// conditional distribution whatever the surface is; a good one makes them all but independent. σ, shared by all
/// chains, is adapted after each step to an acceptance of 0.44, and of 0.4 on the surface. γ and the coefficient of
/// variation: [AuBeck2001].
///
/// Deterministic: random numbers are counted by level, chain and step, so that `response` may run on any number of
/// workers and be replayed.
/// @pre options as their comments say
[[nodiscard]] SubsetResult subset_simulation(const SubsetOptions& options, const ResponseOfPoints& response);

}  // namespace railtab
