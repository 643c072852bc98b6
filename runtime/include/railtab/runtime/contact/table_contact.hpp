#pragma once

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Contact patches of a wheel from a geometry table: the table names the branches and gives each a starting pair, the
/// common-normal Newton polishes it on the stored profiles, and the online search answers where the table cannot be
/// trusted. Const, allocation-free, thread-safe.
class TableContact {
 public:
  /// Builds the pair and the online search from the profiles stored in the table. @throws InputError
  explicit TableContact(GeometryTable table);

  /// As ContactSearch::patches; patches from the fallback have an online source.
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose, double near_miss = 0.0) const noexcept;

  /// The table's own answer. @return false where it has none (outside, lowered further than the cell is trusted, a
  /// start that does not lead to its pair); `result`, empty at the call, is then without meaning.
  [[nodiscard]] bool patches_from_table(const WheelsetPose& pose, double near_miss,
                                        ContactPatches& result) const noexcept;

  [[nodiscard]] const GeometryTable& table() const noexcept { return table_; }
  [[nodiscard]] const ContactSearch& search() const noexcept { return search_; }

 private:
  GeometryTable table_;
  ContactSearch search_;
};

/// The patches to which the starts of a table's branches lead, whether or not there are others; added to `result`, in
/// increasing y_rail. @return false where a start leads nowhere, too far, or to the pair of another one.
[[nodiscard]] bool add_branch_patches(const WheelRailPair& pair, const GeometryTable::Lookup& lookup,
                                      const WheelsetPose& pose, const PoseTrigonometry& trig, double near_miss,
                                      ContactPatches& result) noexcept;

}  // namespace railtab
