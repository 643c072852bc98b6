// Missing and invented minima of a table, planted: the exact overlap of the outlines finds them.

#include "railtab/tablegen/outline_certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/intersection/outline_overlap.hpp"

namespace railtab {
namespace {

/// Of a wheel that touches with tread and flange at once, apart from each other.
const GeometryTableData& table() {
  static const GeometryTableData data = [] {
    GeometrySweepOptions options;
    options.lateral = {5e-3, 7e-3};
    options.yaw = {-10e-3, 10e-3};
    GeometryTableData table = sweep_geometry(
        ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "conic-arc-stand-in", 1.0 / 40)),
                                    ProfileCurve(standard_profile(ProfileKind::rail, "JIS60-stand-in", 1.0 / 40)), {})),
        options);
    certify_merged_geometry_table(table);
    return table;
  }();
  return data;
}

OutlineCertificate certificate(const GeometryTableData& data) {
  return certify_outlines(TableContact{GeometryTable(data)});
}

constexpr std::size_t numbers_per_branch = branch_terms(true, false) * branch_quantities;

/// The table without one branch of a leaf.
GeometryTableData without_branch(GeometryTableData data, std::uint32_t leaf, std::size_t branch) {
  const std::size_t before = std::accumulate(data.leaf_branch.begin(), data.leaf_branch.begin() + leaf, std::size_t{0});
  const auto first = data.coefficient.begin() + static_cast<std::ptrdiff_t>((before + branch) * numbers_per_branch);
  data.coefficient.erase(first, first + static_cast<std::ptrdiff_t>(numbers_per_branch));
  --data.leaf_branch[leaf];
  return data;
}

/// A pose of a leaf at fractions -1..1 of its box, as deep as it is trusted.
WheelsetPose deepest(const GeometryTable& table, const CellBox& box, double a, double b) {
  WheelsetPose pose;
  pose.y = box.at(0, a);
  pose.yaw = std::sqrt(box.at(1, b));
  const GeometryTable::Lookup lookup = table.lookup(pose.y, 0.0, pose.yaw, 0.0);
  pose.z = lookup.first_touch + lookup.trusted_lowering;
  return pose;
}

/// At nine of these.
bool has_two_regions(const TableContact& contact, const OutlineOverlap& outlines, const CellBox& box) {
  for (const double a : {-0.5, 0.0, 0.5}) {
    for (const double b : {-0.5, 0.0, 0.5}) {
      if (outlines.regions(deepest(contact.table(), box, a, b)).size() != 2) return false;
    }
  }
  return true;
}

TEST(OutlineCertificate, FindsAPlantedMissingMinimum) {
  const GeometryTableData& data = table();
  const TableContact contact{GeometryTable(data)};
  const OutlineOverlap outlines(contact.search().pair());
  const OutlineCertificate whole = certificate(data);
  ASSERT_TRUE(whole.mismatches.empty());
  int planted = 0;
  for (std::int64_t root = 0; root < root_cells(data); ++root) {
    const std::vector<TableLeaf> leaves = leaves_below(data, root);
    const auto leaf = std::find_if(leaves.begin(), leaves.end(),
                                   [&](const TableLeaf& l) { return has_two_regions(contact, outlines, l.box); });
    if (leaf == leaves.end()) continue;
    int found = 0;
    for (std::size_t branch = 0; branch < data.leaf_branch[leaf->number]; ++branch) {
      const OutlineCertificate damaged = certificate(without_branch(data, leaf->number, branch));
      EXPECT_EQ(damaged.poses, whole.poses);
      found += static_cast<int>(!damaged.mismatches.empty());
      for (const auto& m : damaged.mismatches) EXPECT_EQ(m.leaf, leaf->number);
    }
    EXPECT_GE(found, 2) << "of the branches of leaf " << leaf->number << ", one in each region";
    ++planted;
  }
  std::printf("%d leaves, %ld poses\n", planted, static_cast<long>(whole.poses));
  EXPECT_GT(planted, 2);
}

// A leaf is trusted less where it disagrees; in one as large as this some pose disagrees in every pass.
TEST(OutlineCertificate, IsWhatATableIsRejectedFor) {
  const GeometryTableData& data = table();
  const TableContact contact{GeometryTable(data)};
  const OutlineOverlap outlines(contact.search().pair());
  for (std::int64_t root = 0; root < root_cells(data); ++root) {
    for (const TableLeaf& leaf : leaves_below(data, root)) {
      if (!has_two_regions(contact, outlines, leaf.box)) continue;
      for (std::size_t branch = 0; branch < data.leaf_branch[leaf.number]; ++branch) {
        GeometryTableData damaged = without_branch(data, leaf.number, branch);
        if (certificate(damaged).mismatches.empty()) continue;
        const WheelsetPose deep = deepest(contact.table(), leaf.box, 0.0, 0.0);
        const int all = contact.search().patches(deep).count;
        EXPECT_LT(TableContact{GeometryTable(damaged)}.patches(deep).count, all);
        EXPECT_THROW(certify_merged_geometry_table(damaged), ComputationError);
        EXPECT_LT(damaged.trusted_lowering[leaf.number], data.trusted_lowering[leaf.number]);
        EXPECT_EQ(TableContact{GeometryTable(damaged)}.patches(deep).count, all) << "by the online search";
        return;
      }
    }
  }
  FAIL() << "no leaf with two contacts";
}

}  // namespace
}  // namespace railtab
