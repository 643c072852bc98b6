#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/outline_certificate.hpp"
#include "railtab/tablegen/table_verification.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {

namespace {

constexpr int certification_samples = 2000;
constexpr std::uint64_t certification_seed = 20230601;
constexpr int refinements = 2;

/// What a table was held against.
struct Certificate {
  GeometryVerification queries;
  OutlineCertificate outlines;  ///< the last
  std::int64_t poses = 0;       ///< of all of these
  std::int64_t mismatches = 0;  ///< mended ones
};

void store_statistics(const Certificate& certificate, GeometryTableData& table) {
  const GeometryVerification& v = certificate.queries;
  table.statistics.emplace_back("certified.samples", v.samples);
  table.statistics.emplace_back("certified.answered_by_table", v.answered_by_table);
  table.statistics.emplace_back("certified.fallback_share", v.fallback_share);
  table.statistics.emplace_back("certified.searched_share", v.searched_share);
  table.statistics.emplace_back("certified.finer_mismatch_share", v.finer_mismatch_share);
  table.statistics.emplace_back("certified.patch_mismatch_share", v.patch_mismatch_share);
  table.statistics.emplace_back("certified.outlines.poses", static_cast<double>(certificate.poses));
  table.statistics.emplace_back("certified.outlines.in_band", static_cast<double>(certificate.outlines.in_band));
  table.statistics.emplace_back("certified.outlines.mismatches", static_cast<double>(certificate.mismatches));
  add_certified_errors(v, table.statistics);
}

/// Leaves that disagree with the exact overlap are trusted only as far as they agree, until none does.
void withdraw_from_mismatches(GeometryTableData& table, Certificate& certificate) {
  constexpr int passes = 4;
  for (int pass = 0; pass < passes; ++pass) {
    certificate.outlines = certify_outlines(TableContact{GeometryTable(table)}, pass);
    certificate.poses += certificate.outlines.poses;
    if (certificate.outlines.mismatches.empty()) return;
    certificate.mismatches += static_cast<std::int64_t>(certificate.outlines.mismatches.size());
    for (const OutlineCertificate::Mismatch& m : certificate.outlines.mismatches) {
      float& trusted = table.trusted_lowering[m.leaf];
      trusted = std::min(trusted, static_cast<float>(m.agrees_to));
    }
  }
}

Certificate certify(GeometryTableData& table) {
  Certificate result;
  withdraw_from_mismatches(table, result);
  const TableContact contact{GeometryTable(table)};
  VerificationOptions check = verification_options(table);
  check.samples = certification_samples;
  check.seed = certification_seed;
  check.timing = false;
  result.queries = verify_geometry_table(contact, check);
  store_statistics(result, table);
  return result;
}

bool meets_tolerance(const Certificate& c, double tolerance) {
  return c.queries.penetration.p999 <= tolerance && c.queries.finer_mismatch_share == 0 &&
         c.outlines.mismatches.empty();
}

std::string shortfall(const Certificate& c, double tolerance) {
  return fmt::format(
      "the penetration error is {:.3g} m (99.9 %), and patches are missed or spurious at {:.3g} of the queries and at "
      "{} of {} poses held against the exact overlap of the outlines; permitted are {:.3g} m and none",
      c.queries.penetration.p999, c.queries.finer_mismatch_share, c.outlines.mismatches.size(), c.outlines.poses,
      tolerance);
}

using Sweep = std::function<GeometryTableData(const GeometrySweepOptions&, int refinement)>;

GeometryTableData refined_until_it_meets_tolerance(const GeometrySweepOptions& options, const Sweep& sweep) {
  Certificate certificate;
  for (int refinement = 0; refinement <= refinements; ++refinement) {
    GeometryTableData table = sweep(options.refined(refinement), refinement);
    certificate = certify(table);
    if (meets_tolerance(certificate, options.tolerance)) return table;
  }
  throw ComputationError(fmt::format(
      "geometry table: after {} refinements {}. Ask for less (--tolerance), start finer (--refinement), or smooth "
      "measured profiles (--smoothing)",
      refinements, shortfall(certificate, options.tolerance)));
}

std::filesystem::path part_file(const std::filesystem::path& file, int refinement, int part) {
  return fmt::format("{}.part-{}-{}", file.string(), refinement, part);
}

/// Shards of one process: as many as may be lost in a kill.
constexpr int parts_of_a_table = 8;

/// Whether somebody else's file has the name of a part, or a link: it is neither read nor replaced, and the part is not
/// kept.
bool is_taken(const std::filesystem::path& place) {
  return std::filesystem::is_symlink(place) || (std::filesystem::exists(place) && !is_array_file(place));
}

/// A part that an earlier run has left, if it is one of this table.
std::optional<GeometryTableData> earlier_part(const std::filesystem::path& file, const GeometryTableData& heading) {
  if (!std::filesystem::exists(file) || is_taken(file)) return {};
  try {
    GeometryTableData part = read_geometry_table(file);
    if (part.shard == heading.shard && difference_of_parts(heading, part).empty()) return part;
  } catch (const InputError&) {  // incomplete or of another version: generated again
  }
  return {};
}

GeometryTableData sweep_in_parts(const ContactSearch& search, const GeometrySweepOptions& options, int refinement,
                                 const TableProvenance& provenance, const std::filesystem::path& file,
                                 const Progress& progress) {
  GeometrySweepOptions own = options;
  const auto count =
      static_cast<int>(std::min<std::int64_t>(parts_of_a_table, root_cells(geometry_heading(search, options))));
  std::vector<GeometryTableData> parts;
  for (int part = 1; part <= count; ++part) {
    own.shard = {part, count};
    const std::filesystem::path place = part_file(file, refinement, part);
    GeometryTableData heading = geometry_heading(search, own);
    heading.provenance = provenance;
    std::optional<GeometryTableData> found = earlier_part(place, heading);
    if (!found) {
      found = sweep_geometry(search, own, [&](double share) {
        if (progress) progress((part - 1 + share) / count);
      });
      found->provenance = provenance;
      if (!is_taken(place)) write_geometry_table(place, *found);
    }
    parts.push_back(std::move(*found));
  }
  GeometryTableData table = merge_geometry_tables(std::move(parts));
  require_contact(table);
  return table;
}

}  // namespace

GeometrySweepOptions GeometrySweepOptions::refined(int times) const {
  GeometrySweepOptions finer = *this;
  finer.start_error *= std::pow(0.5, times);
  finer.iterated_cell *= std::pow(0.25, times);
  finer.fallback_cell *= std::pow(0.25, times);
  return finer;
}

void certify_merged_geometry_table(GeometryTableData& table) {
  const Certificate certificate = certify(table);
  if (meets_tolerance(certificate, table.tolerance)) return;
  throw ComputationError(
      fmt::format("{}. Make all shards anew with --refinement one higher, or the table in one piece, which refines "
                  "by itself",
                  shortfall(certificate, table.tolerance)));
}

GeometryTableData generate_geometry_table(const ContactSearch& search, const GeometrySweepOptions& options,
                                          const Progress& progress) {
  if (!options.shard.whole()) return sweep_geometry(search, options, progress);
  return refined_until_it_meets_tolerance(
      options, [&](const GeometrySweepOptions& current, int) { return sweep_geometry(search, current, progress); });
}

void generate_geometry_table_file(const ContactSearch& search, const GeometrySweepOptions& options,
                                  const TableProvenance& provenance, const std::filesystem::path& file,
                                  const Progress& progress) {
  GeometryTableData table;
  if (options.shard.whole()) {
    table = refined_until_it_meets_tolerance(options, [&](const GeometrySweepOptions& current, int refinement) {
      return sweep_in_parts(search, current, refinement, provenance, file, progress);
    });
  } else {
    table = sweep_geometry(search, options, progress);
  }
  table.provenance = provenance;
  write_geometry_table(file, table);
  for (int refinement = 0; refinement <= refinements; ++refinement) {
    for (int part = 1; part <= parts_of_a_table; ++part) {
      const std::filesystem::path place = part_file(file, refinement, part);
      if (!is_taken(place)) std::filesystem::remove(place);
    }
  }
}

}  // namespace railtab
