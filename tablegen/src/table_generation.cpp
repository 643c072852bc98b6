#include <fmt/format.h>

#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/table_verification.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

constexpr int certification_samples = 2000;
constexpr std::uint64_t certification_seed = 20230601;
constexpr int refinements = 2;

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

GeometryVerification certify(GeometryTableData& table) {
  const TableContact contact{GeometryTable(table)};
  VerificationOptions check = verification_options(table);
  check.samples = certification_samples;
  check.seed = certification_seed;
  check.timing = false;
  const GeometryVerification result = verify_geometry_table(contact, check);
  store_statistics(result, table);
  return result;
}

bool keeps_its_word(const GeometryVerification& v, double tolerance) {
  return v.penetration.p999 <= tolerance && v.finer_mismatch_share == 0;
}

}  // namespace

bool certify_geometry_table(GeometryTableData& table) { return keeps_its_word(certify(table), table.tolerance); }

GeometryTableData generate_geometry_table(const ContactSearch& search, const GeometrySweepOptions& options,
                                          const Progress& progress) {
  if (!options.shard.whole()) return sweep_geometry(search, options, progress);
  GeometrySweepOptions current = options;
  GeometryVerification verification;
  for (int refinement = 0; refinement <= refinements; ++refinement) {
    GeometryTableData table = sweep_geometry(search, current, progress);
    verification = certify(table);
    if (keeps_its_word(verification, options.tolerance)) return table;
    current.start_error *= 0.5;
    current.iterated_cell *= 0.25;
    current.fallback_cell *= 0.25;
  }
  throw ComputationError(
      fmt::format("geometry table: after {} refinements the penetration error is {} m (99.9 %) and patches are missed "
                  "or invented at "
                  "{} of the queries; asked for were {} m and none",
                  refinements, verification.penetration.p999, verification.finer_mismatch_share, options.tolerance));
}

}  // namespace railtab
