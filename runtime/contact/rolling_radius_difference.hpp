#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"

namespace railtab {

/// Patches of the right wheel at a pose, gaps up to `near_miss` [m] included: TableContact::patches,
/// ContactSearch::patches.
using PatchQuery = std::function<ContactPatches(const WheelsetPose& pose, double near_miss)>;

/// Whether a wheelset that shifts laterally keeps its roll, or takes the roll at which both wheels touch.
enum class WheelsetRoll {
  off,   ///< each wheel touches at its own height: the convention of EN 15302
  free,  ///< rigid wheelset, both wheels in contact
};

/// The wheel and the rail of one side, both as on the right side of the track: a left side is seen in the mirror.
struct WheelOnRail {
  PatchQuery patches;
  double rail_offset = 0.0;  ///< WheelRailPair::rail_offset() [m]
};

/// By the online search, which must outlive the result.
[[nodiscard]] WheelOnRail searched_side(const ContactSearch& search);

/// How the lateral shifts of the samples are chosen.
enum class ShiftSampling {
  refined,  ///< samples are added until straight lines between them suffice: a jump of the contact stands at its place
  even,     ///< multiples of the step alone, as in [EN15302, Annex B]: a jump is spread over one step
};

/// A wheelset without yaw that just touches both rails.
struct WheelsetContact {
  double y = 0.0;                      ///< lateral shift, to the right [m]
  double roll = 0.0;                   ///< [rad]
  ContactPatch right, left;            ///< of each wheel; the left one as seen in the mirror (as a right wheel)
  double radius_difference = 0.0;      ///< rolling radius difference: right minus left, wheel diameters included [m]
  double z_right = 0.0, z_left = 0.0;  ///< pose heights at which the wheels (of equal diameters) touch [m]
};

/// Parameters of the sampling of a wheelset's contact over lateral shift.
struct WheelsetContactOptions {
  double y_low = -0.010, y_high = 0.010;  ///< range of the lateral shift [m], y_low < 0 < y_high
  WheelsetRoll roll = WheelsetRoll::off;
  double diameter_difference = 0.0;  ///< right wheel's diameter minus left wheel's [m], |.| <= 0.02
  ShiftSampling sampling = ShiftSampling::refined;
  double step = 1e-4;       ///< distance of even samples, the widest one of refined samples [m], in 1e-6..1e-3
  double tolerance = 1e-7;  ///< refined: a straight line between samples is within this of the radius difference [m]
  /// @throws InputError naming the member out of range
  void validate() const;
};

/// Contact of both wheels over the lateral shift, in increasing y. Refined samples are added until the rolling radius
/// difference is within `tolerance` of a straight line between neighbours, or these are 1 µm apart or less: a jump of
/// the contact stands as a steep line. The range ends early where a wheel no longer meets its rail.
[[nodiscard]] std::vector<WheelsetContact> wheelset_contacts(const WheelOnRail& right, const WheelOnRail& left,
                                                             const WheelsetContactOptions& options);

/// The same where both sides are alike.
/// @param pair gives the offsets of the pair that `patches` is asked about
[[nodiscard]] std::vector<WheelsetContact> wheelset_contacts(const PatchQuery& patches, const WheelRailPair& pair,
                                                             const WheelsetContactOptions& options);

/// The same by the online search.
[[nodiscard]] std::vector<WheelsetContact> wheelset_contacts(const ContactSearch& search,
                                                             const WheelsetContactOptions& options);

/// A wheel of the pair that just touches.
struct FirstContact {
  ContactPatch patch;
  double z = 0.0;  ///< of the pose [m]
};

/// The patch with which the right wheel first touches at this lateral shift and roll, without yaw. From the height
/// `z_start`, which should not be more than a few mm off, by Newton on the deepest patch; a touch to 1e-12 m.
/// Nothing where the wheel does not meet the rail within 30 mm below z_start.
[[nodiscard]] std::optional<FirstContact> first_contact(const PatchQuery& patches, double y, double roll,
                                                        double z_start);

}  // namespace railtab
