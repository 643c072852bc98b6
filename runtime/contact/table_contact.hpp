#pragma once

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// The result of a look-up.
enum class TableAnswer : std::uint8_t {
  none,       ///< outside the table, or lowered further than the cell is trusted
  looked_up,  ///< every start has its pair
  searched,   ///< a start has no pair of its own; the online search covered its surroundings
};

/// Contact patches of a wheel from a geometry table: the table names the branches and gives each a starting pair, the
/// common-normal Newton polishes it on the stored profiles, and the online search answers where the table cannot be
/// trusted. Const, allocation-free, thread-safe.
class TableContact {
 public:
  /// Builds the pair and the online search from the profiles stored in the table. @throws InputError
  explicit TableContact(GeometryTable table);

  /// As ContactSearch::patches; patches from the fallback have an online source.
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose, double near_miss = 0.0) const noexcept;

  /// The table's own answer. Where it is `none`, `result`, empty at the call, is without meaning.
  [[nodiscard]] TableAnswer answer(const WheelsetPose& pose, double near_miss, ContactPatches& result) const noexcept;
  /// answer(), true where there is one.
  [[nodiscard]] bool patches_from_table(const WheelsetPose& pose, double near_miss,
                                        ContactPatches& result) const noexcept {
    return answer(pose, near_miss, result) != TableAnswer::none;
  }

  [[nodiscard]] const GeometryTable& table() const noexcept { return table_; }
  [[nodiscard]] const ContactSearch& search() const noexcept { return search_; }

 private:
  GeometryTable table_;
  ContactSearch search_;
  double steepest_;  ///< largest height per normal distance on any branch [-]
};

/// The patches to which the starts of a leaf's branches lead, added to `result`, empty at the call, in increasing
/// y_rail. Where a branch begins or ends in a leaf, its start may lead nowhere, too far, or to the pair of another one:
/// 0.5 mm of the wheel profile to both sides of it are searched then. `none` where that finds no patch at all, and
/// where the wheel is lowered further than the leaf is trusted.
/// @param height branches that touch lower than this are left out [m]: pose.z, and what a gap of near_miss can be high
[[nodiscard]] TableAnswer add_branch_patches(const ContactSearch& search, const GeometryLeaf& leaf,
                                             const WheelsetPose& pose, double height, double near_miss,
                                             ContactPatches& result) noexcept;

}  // namespace railtab
