#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// Mean, quantiles and maximum of a set of absolute errors; all 0 for an empty set.
struct ErrorStatistics {
  double mean = 0, p50 = 0, p95 = 0, p99 = 0, p999 = 0, max = 0;
  [[nodiscard]] std::array<std::pair<std::string_view, double>, 6> named() const {
    return {{{"mean", mean}, {"p50", p50}, {"p95", p95}, {"p99", p99}, {"p999", p999}, {"max", max}}};
  }
};
/// Quantile p is the smallest value that a share p of the errors does not exceed.
[[nodiscard]] ErrorStatistics error_statistics(std::vector<double> errors);

/// Random queries, uniform and independent over the intervals.
struct VerificationOptions {
  int samples = 10000;  ///< 1..10^8
  std::uint64_t seed = 1;
  Interval lateral, yaw, roll;   ///< [m], [rad], [rad]
  Interval lowering{0.0, 3e-4};  ///< of the wheelset centre below first touch, >= 0 [m]
  double tolerance = 1e-8;       ///< a patch missed or invented counts if deeper than ten times this [m]
  bool timing = true;
};

/// A table held against the online search: an independent full search at every query, never started from the table.
/// Errors are those of the patches of queries that the table answered itself; absolute differences [m, rad, -].
struct GeometryVerification {
  int samples = 0;
  int answered_by_table = 0;
  int never_touching = 0;  ///< draws thrown away because the wheel does not meet the rail there
  int patches_compared = 0;
  double fallback_share = 0;        ///< of the samples: the whole profile searched
  double searched_share = 0;        ///< of the samples: answered by the table with a search about a start
  double patch_mismatch_share = 0;  ///< queries with a patch missed or invented, of those answered by the table
  /// The same against a search with a scan of 0.02 mm: the online search, too, can miss a minimum just born.
  double finer_mismatch_share = 0;
  /// The same against the exact overlap of the outlines, and the share where only a contact just born differs.
  double outline_mismatch_share = 0, outline_in_band_share = 0;
  ErrorStatistics penetration, position_rail, position_wheel, contact_angle, rolling_radius;
  ErrorStatistics normal_force_relative;  ///< Hertz, |F_table - F_online| / max(F_online, 1 kN), steel of hertz.hpp;
                                          ///< of patches that have a Hertzian ellipse
  double time_table_ns = 0;               ///< per query that the table answered, the best of several passes [ns]
  double time_online_ns = 0;              ///< online search on the same queries
  double time_with_fallback_ns = 0;       ///< per query, fallback included
  double time_paper_ns = 0;               ///< the published method's search with 1000 points, on some of them
  std::size_t bytes = 0;                  ///< memory of the look-up

  [[nodiscard]] std::array<std::pair<std::string_view, const ErrorStatistics*>, 6> errors() const {
    return {{{"penetration", &penetration},
             {"position_rail", &position_rail},
             {"position_wheel", &position_wheel},
             {"contact_angle", &contact_angle},
             {"rolling_radius", &rolling_radius},
             {"normal_force_relative", &normal_force_relative}}};
  }
};

/// Adds certified.error.<quantity>.<mean, p50, ...> of a verification to a table's statistics.
template <class Verification>
void add_certified_errors(const Verification& verification, std::vector<std::pair<std::string, double>>& statistics) {
  for (const auto& [quantity, errors] : verification.errors()) {
    for (const auto& [name, value] : errors->named()) {
      statistics.emplace_back(fmt::format("certified.error.{}.{}", quantity, name), value);
    }
  }
}

/// @throws InputError for options out of range, ComputationError where the wheel hardly ever meets the rail.
[[nodiscard]] GeometryVerification verify_geometry_table(const TableContact& contact,
                                                         const VerificationOptions& options,
                                                         const Progress& progress = {});

/// The ranges and the tolerance for which a table was generated, from its stored options.
/// @throws InputError where the table does not state them.
[[nodiscard]] VerificationOptions verification_options(const GeometryTableData& table);

}  // namespace railtab
