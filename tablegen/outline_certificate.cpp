#include "railtab/tablegen/outline_certificate.hpp"

#include <algorithm>
#include <mutex>

#include "railtab/tablegen/even_points.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/intersection/outline_overlap.hpp"
#include "railtab/tablegen/parallel_failure.hpp"

namespace railtab {

OutlineCertificate certify_outlines(const TableContact& contact, int pass) {
  constexpr std::int64_t poses_per_leaf = 2, most_leaves = 100'000;  // of a root cell: for numbers of their own
  constexpr double margin = 20e-6;                                   // m: a leaf's other poses begin it earlier
  const GeometryTable& table = contact.table();
  const GeometryTableData& data = table.data();
  const OutlineOverlap outlines(contact.search().pair());
  const std::int64_t roots = root_cells(data);
  OutlineCertificate result;
  const auto certify = [&](std::int64_t root, OutlineCertificate& own) {
    std::int64_t n = (root + pass * roots) * poses_per_leaf * most_leaves;
    for (const TableLeaf& leaf : leaves_below(data, root)) {
      for (std::int64_t k = 0; k < poses_per_leaf; ++k) {
        const std::array<double, 4> part = even_point(0.0, ++n);
        WheelsetPose pose =
            pose_in(leaf.box, {2.0 * part[0] - 1.0, 2.0 * part[1] - 1.0, 2.0 * part[2] - 1.0}, data.nominal_radius);
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
  };
  ParallelFailure failure;
  std::mutex one_at_a_time;
#pragma omp parallel
  {
    OutlineCertificate own;
#pragma omp for schedule(dynamic, 4)
    for (std::int64_t root = 0; root < roots; ++root) failure.guard([&] { certify(root, own); });
    failure.guard([&] {
      const std::scoped_lock lock(one_at_a_time);
      result.poses += own.poses;
      result.in_band += own.in_band;
      result.mismatches.insert(result.mismatches.end(), own.mismatches.begin(), own.mismatches.end());
    });
  }
  failure.rethrow();
  std::sort(result.mismatches.begin(), result.mismatches.end(),
            [](const auto& a, const auto& b) { return a.leaf < b.leaf; });
  return result;
}

}  // namespace railtab
