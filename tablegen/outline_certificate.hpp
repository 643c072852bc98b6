#pragma once

#include <cstdint>
#include <vector>

#include "railtab/runtime/contact/table_contact.hpp"

namespace railtab {

/// A table's patches against the exact overlap of the outlines, at poses of every leaf (RegionComparison).
struct OutlineCertificate {
  /// A leaf that misses or invents a contact.
  struct Mismatch {
    std::uint32_t leaf;  ///< in GeometryTableData::leaf_branch
    double agrees_to;    ///< lowering below first touch at which that contact begins, less a margin, not negative [m]
  };
  std::int64_t poses = 0;    ///< that the table answered
  std::int64_t in_band = 0;  ///< of these, with a contact that is just born
  std::vector<Mismatch> mismatches;
};

/// Two poses of each leaf, one lowered by what it is trusted and one by less (OpenMP over the root cells).
/// @param pass other poses in each, 0..9
[[nodiscard]] OutlineCertificate certify_outlines(const TableContact& contact, int pass = 0);

}  // namespace railtab
