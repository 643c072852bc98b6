#pragma once

#include "railtab/runtime/contact/loaded_wheel.hpp"

namespace railtab {

/// How the penetration of a patch follows a small motion of the wheel: the pair of profile points stays.
struct PenetrationGradient {
  double angle = 0.0;               ///< contact angle [rad]
  double x = 0.0;                   ///< of the contact point, relative to the wheelset centre [m]
  double arm_y = 0.0, arm_z = 0.0;  ///< likewise, in rail-head axes [m]

  PenetrationGradient() = default;
  PenetrationGradient(const WheelRailPair& pair, const ContactPatch& patch, const WheelsetPose& pose) noexcept;
  /// To first order, the displacement of the wheel's particle along the normal into the rail [m].
  [[nodiscard]] double change(const WheelsetPose& from, const WheelsetPose& to) const noexcept;
};

/// The contact of one wheel at the start of a time step: pose and patches as those of a right wheel, forces in the
/// track frame.
struct ContactMemory {
  struct Patch {
    PenetrationGradient gradient;
    double penetration;  ///< [m]
    Vector9 force;       ///< as WheelForce::patch
  };
  WheelsetPose pose;
  std::array<Patch, ContactPatches::capacity> patch;  ///< the first `count`
  int count = 0;
  LoadedMemory loaded;  ///< of the contact by the loaded table

  [[nodiscard]] Vector9 force() const noexcept;  ///< of all patches and the loaded contact
};

[[nodiscard]] ContactMemory remembered(const WheelRailPair& pair, const WheelsetPose& pose,
                                       const ContactPatches& patches, const WheelForce& force) noexcept;

/// Descent of the wheel against its rail that changes the elastic energy of a contact as a change of pose does, to
/// first order [m]; 0 without contact.
/// @param normal forces of the patches [N]
[[nodiscard]] double equivalent_descent(const ContactMemory& contact, std::span<const double> normal,
                                        const WheelsetPose& from, const WheelsetPose& to) noexcept;

/// Mean of d^{3/2} over a step in which d goes from d0 to d1 at constant rate, d < 0 counting as lift-off, relative to
/// the mean of its two ends:
///   (2/5)(d1^{5/2} - d0^{5/2})/(d1 - d0) / ((d0^{3/2} + d1^{3/2})/2), 0.8 to 1 while contact lasts.
/// With the first factor times K_h as its force, a Hertz spring's work is the difference of its energy (2/5) K_h
/// d^{5/2} whatever the step: the discrete gradient [Gonzalez1996].
[[nodiscard]] double hertz_mean_factor(double d0, double d1) noexcept;

/// Mean force of a wheel over a step: of every patch the mean of both ends times hertz_mean_factor(), normal and creep
/// forces alike, so that Coulomb's bound holds for the means. Patches at the end are followed back to the start's pose,
/// and those at the start forward, each along its own normal: none is matched with another, so that patches may appear
/// and vanish within the step.
/// @param end forces of `patches` at `pose`
/// @return as WheelForce: on the wheelset 6, on the rail head 3
[[nodiscard]] Vector9 mean_force(const WheelRailPair& pair, const ContactMemory& start, const WheelsetPose& pose,
                                 const ContactPatches& patches, const WheelForce& end) noexcept;

}  // namespace railtab
