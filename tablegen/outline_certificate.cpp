#include "railtab/tablegen/outline_certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/intersection/outline_overlap.hpp"

namespace railtab {

namespace {

/// Fractions 0..1 of the four dimensions, which fill them evenly.
std::array<double, 4> fractions(std::int64_t n) {
  constexpr std::array<double, 4> step{0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
  std::array<double, 4> result{};
  for (std::size_t a = 0; a < result.size(); ++a) result[a] = std::fmod(step[a] * static_cast<double>(n), 1.0);
  return result;
}

}  // namespace

OutlineCertificate certify_outlines(const TableContact& contact, int pass) {
  constexpr std::int64_t poses_per_leaf = 2, most_leaves = 100'000;  // of a root cell: for numbers of their own
  constexpr double margin = 20e-6;                                   // m: a leaf's other poses begin it earlier
  const GeometryTable& table = contact.table();
  const GeometryTableData& data = table.data();
  const OutlineOverlap outlines(contact.search().pair());
  const std::int64_t roots = root_cells(data);
  OutlineCertificate result;
#pragma omp parallel
  {
    OutlineCertificate own;
#pragma omp for schedule(dynamic, 4)
    for (std::int64_t root = 0; root < roots; ++root) {
      std::int64_t n = (root + pass * roots) * poses_per_leaf * most_leaves;
      for (const TableLeaf& leaf : leaves_below(data, root)) {
        for (std::int64_t k = 0; k < poses_per_leaf; ++k) {
          const std::array<double, 4> part = fractions(++n);
          const auto at = [&](std::size_t axis) { return leaf.box.at(axis, 2.0 * part[axis] - 1.0); };
          WheelsetPose pose;
          pose.roll = at(2);
          pose.yaw = std::sqrt(at(1));
          pose.y = at(0) + data.nominal_radius * pose.roll;
          const GeometryTable::Lookup lookup = table.lookup(pose.y, 0.0, pose.yaw, pose.roll);
          // The first as deep as the leaf is trusted, where most contacts exist.
          const double lowering = (k == 0 ? 1.0 : part[3]) * lookup.trusted_lowering;
          pose.z = lookup.first_touch + lowering;
          ContactPatches patches;
          if (lookup.count == 0 || contact.answer(pose, 0.0, patches) == TableAnswer::none) continue;
          const RegionComparison comparison = compare(outlines.regions(pose), patches);
          ++own.poses;
          own.in_band += static_cast<std::int64_t>(comparison.in_band);
          if (!comparison.mismatch) continue;
          own.mismatches.push_back({leaf.number, std::max(0.0, lowering - comparison.height - margin)});
        }
      }
    }
#pragma omp critical(outline_certificate)
    {
      result.poses += own.poses;
      result.in_band += own.in_band;
      result.mismatches.insert(result.mismatches.end(), own.mismatches.begin(), own.mismatches.end());
    }
  }
  std::sort(result.mismatches.begin(), result.mismatches.end(),
            [](const auto& a, const auto& b) { return a.leaf < b.leaf; });
  return result;
}

}  // namespace railtab
