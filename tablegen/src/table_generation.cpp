#include <fmt/format.h>

#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/table_verification.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

constexpr int certification_samples = 2000;
constexpr std::uint64_t certification_seed = 20230601;
constexpr int halvings = 3;

void store_statistics(const GeometryVerification& v, GeometryTableData& table) {
  table.statistics.emplace_back("certified.samples", v.samples);
  table.statistics.emplace_back("certified.answered_by_table", v.answered_by_table);
  table.statistics.emplace_back("certified.fallback_share", v.fallback_share);
  table.statistics.emplace_back("certified.searched_share", v.searched_share);
  table.statistics.emplace_back("certified.finer_mismatch_share", v.finer_mismatch_share);
  table.statistics.emplace_back("certified.patch_mismatch_share", v.patch_mismatch_share);
  for (const auto& [quantity, errors] : v.errors()) {
    for (const auto& [name, value] : errors->named()) {
      table.statistics.emplace_back(fmt::format("certified.error.{}.{}", quantity, name), value);
    }
  }
}

}  // namespace

GeometryTableData generate_geometry_table(const ContactSearch& search, const GeometrySweepOptions& options,
                                          const Progress& progress) {
  GeometrySweepOptions current = options;
  GeometryVerification verification;
  for (int halving = 0; halving <= halvings; ++halving) {
    GeometryTableData table = sweep_geometry(search, current, progress);
    const TableContact contact{GeometryTable(table)};
    VerificationOptions check = verification_options(table);
    check.samples = certification_samples;
    check.seed = certification_seed;
    check.timing = false;
    verification = verify_geometry_table(contact, check);
    if (verification.penetration.p999 <= options.tolerance && verification.finer_mismatch_share == 0) {
      store_statistics(verification, table);
      return table;
    }
    current.lateral_step *= 0.5;
  }
  throw ComputationError(fmt::format(
      "geometry table: with {} mm between lateral nodes the penetration error is {} m (99.9 %) and patches are missed "
      "or "
      "invented at {} of the queries; asked for were {} m and none",
      2e3 * current.lateral_step, verification.penetration.p999, verification.finer_mismatch_share, options.tolerance));
}

}  // namespace railtab
