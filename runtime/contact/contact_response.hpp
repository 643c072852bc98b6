#pragma once

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/mean_force.hpp"

namespace railtab {

/// Contact of one wheel at a pose: by the loaded table, by patches, or in the table's margin by both, each with its
/// share of the force.
struct WheelContact {
  WheelsetPose pose;       ///< of a right wheel
  ContactPatches patches;  ///< none where the loaded table answers alone
  LoadedLookup loaded;     ///< table_share 0 where it does not answer

  [[nodiscard]] bool touches() const noexcept { return patches.count > 0 || loaded.energy > 0.0; }
  [[nodiscard]] bool by_patches() const noexcept { return loaded.table_share < 1.0; }
};

[[nodiscard]] WheelContact wheel_contact(const ContactGeometry& geometry, const WheelsetPose& pose) noexcept;

/// @param contact at the pose that relative_pose() returns
[[nodiscard]] LoadedWheelForce wheel_force(const WheelContactModel& model, WheelSide side,
                                           const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                           const WheelContact& contact) noexcept;

/// What records show of a contact: its patches, or the parts of the loaded one.
[[nodiscard]] ContactPatches recorded_patches(const WheelRailPair& pair, const WheelContact& contact) noexcept;

/// Elastic energy: of patches (2/5) F d [J].
[[nodiscard]] double elastic_energy(const WheelContactModel& model, const WheelContact& contact) noexcept;

[[nodiscard]] ContactMemory contact_memory(const WheelRailPair& pair, const WheelContact& contact,
                                           const LoadedWheelForce& force) noexcept;

/// Mean force over a step that ends at `contact` with `force`.
[[nodiscard]] Vector9 mean_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                 const RailHeadMotion& rail, const ContactMemory& start, const WheelContact& contact,
                                 const WheelForce& force) noexcept;

/// Derivative of the force, or of the mean force, in a time step (the other wheel_force_tangent()). In the margin of
/// the loaded table without the slope of its share.
[[nodiscard]] Matrix9 wheel_force_tangent(const WheelContactModel& model, WheelSide side,
                                          const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                          const WheelContact& contact, const StepRates& rates) noexcept;

/// The contact of a wheel, its force and the derivative (wheel_force_tangent()).
struct WheelResponse : LoadedWheelResponse {
  WheelContact contact;
};

/// All three for about the price of the derivative: one look-up where the loaded table answers.
[[nodiscard]] WheelResponse wheel_response(const WheelContactModel& model, WheelSide side,
                                           const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                           const StepRates& rates) noexcept;

/// The same of several wheels, of which those that the loaded table answers alone are computed side by side.
/// @param responses one for each
void wheel_responses(const WheelContactModel& model, std::span<const WheelState> wheels, const StepRates& rates,
                     std::span<WheelResponse> responses) noexcept;

}  // namespace railtab
