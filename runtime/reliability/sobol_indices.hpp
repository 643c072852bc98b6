#pragma once

#include <functional>

#include "railtab/runtime/reliability/proportion.hpp"
#include "railtab/runtime/reliability/sampling.hpp"

namespace railtab {

/// Response of each point of the unit cube, in their order; the points of one call are independent.
using ResponseOfUnitPoints = std::function<std::vector<double>(const UnitPoints&)>;

struct SobolOptions {
  std::size_t variables = 1;
  std::size_t samples = 1000;  ///< N; the response is asked for N·(variables + 2) times
  std::size_t replicates = 500;
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

struct SobolIndices {
  std::vector<ConfidenceInterval> first;  ///< share of the variance that the variable causes alone
  std::vector<ConfidenceInterval> total;  ///< the same with all its interactions
  double mean = 0.0, variance = 0.0;      ///< of the response
};

/// First-order and total Sobol' indices by direct sampling [SaltelliEtAl2010]: two matrices A and B of points, and for
/// each variable i the matrix AB_i, A with the column i of B. With f less its mean and its variance V,
///
///     S_i = Σ f(B)·(f(AB_i) − f(A)) / (N·V),     T_i = Σ (f(A) − f(AB_i))² / (2·N·V)
///
/// A and B are halves of one Latin hypercube. Intervals are percentiles of a bootstrap over the N rows,
/// of the replicates with variance. @throws ComputationError where all f(A) and f(B) are one value
[[nodiscard]] SobolIndices sobol_indices(const SobolOptions& options, const ResponseOfUnitPoints& response);

}  // namespace railtab
