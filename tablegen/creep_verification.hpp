#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tablegen/table_verification.hpp"

namespace railtab {

/// Random cases of rolling contact: a/b log-uniform; (c11 υx/3, c22 υy/3, c23 φ) of log-uniform size and uniform
/// direction on the sphere, all signs.
struct CreepVerificationOptions {
  int samples = 10000;  ///< 1..10^7
  std::uint64_t seed = 1;
  Interval ratio{0.05, 20.0};     ///< > 0
  Interval creepage{0.05, 30.0};  ///< > 0
  bool timing = true;
};

/// Errors of one law: force vector in units of μF_n, moment of μF_n √(ab).
struct CreepLawErrors {
  std::string_view name;
  ErrorStatistics force, moment;
  double time_ns = 0;  ///< per case, cases in random order [ns]
};

/// A creep table, and other laws, held against the exact solution with the table's own number of elements,
/// extrapolated, at random cases.
struct CreepVerification {
  int samples = 0;
  int outside = 0;            ///< cases that the table leaves to Polach, in whole or in part; counted as its answer
  double worst_residual = 0;  ///< of the exact solutions
  int safe_method = 0;        ///< exact solutions that Newton's method did not find
  /// Of the exact solutions themselves: size of what the extrapolation adds to the fine grid's force, 99 %.
  double extrapolated_p99 = 0;
  CreepLawErrors table;
  std::vector<CreepLawErrors> laws;  ///< FASTSIM 20 x 20 and 50 x 50, Polach, linear saturated
  double time_trajectory_ns = 0;     ///< table along a smooth path of cases [ns]
  double time_exact_ns = 0;
  std::size_t bytes = 0;
};

/// @throws InputError for options out of range, ComputationError where an exact solution does not converge.
[[nodiscard]] CreepVerification verify_creep_table(const TableCreep& law, const CreepVerificationOptions& options,
                                                   const Progress& progress = {});

}  // namespace railtab
