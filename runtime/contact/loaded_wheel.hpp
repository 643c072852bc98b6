#pragma once

#include <cstdint>
#include <span>

#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/tables/loaded_table.hpp"

namespace railtab {

/// The elastic contact of a wheel at the start of a time step, as a right wheel's.
struct LoadedMemory {
  double weight = 0.0;  ///< share of the loaded table in the contact; 0: none
  WheelsetPose pose;
  double energy = 0.0;                              ///< U [J]
  Eigen::Vector4d force = Eigen::Vector4d::Zero();  ///< LoadedLookup::force
  Vector9 rest = Vector9::Zero();                   ///< creep and damping forces, weighted
  Vector9 total = Vector9::Zero();                  ///< all forces, weighted, of the wheel as it is (track frame)
};

/// Forces of a wheel, with what the next step wants to know of its loaded contact.
struct LoadedWheelForce : WheelForce {
  LoadedMemory memory;
};

/// Forces of the loaded contact of one wheel: elastic forces are the derivative of the tabulated energy. Each part of
/// the contact has its creep force, by the model's law for its ellipse (LoadedPartOf), from the creepage at the mean
/// point of the wheel in contact; parts that merge count as one ellipse by the depth of the saddle between them
/// (docs/theory/contact_table.md).
/// @param lookup at the pose that relative_pose() returns
[[nodiscard]] LoadedWheelForce loaded_wheel_force(const WheelContactModel& model, WheelSide side,
                                                  const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                                  const LoadedLookup& lookup) noexcept;

/// The parts that bear load as patches, for records: penetration is the approach of a Hertzian contact with the same
/// energy and force, (5/2) U/N.
[[nodiscard]] ContactPatches loaded_patches(const WheelRailPair& pair, const WheelsetPose& pose,
                                            const LoadedLookup& lookup) noexcept;

/// Mean over a time step, from its start to the state of `lookup`, with the table's shares w at both ends: of the
/// elastic forces F̄ = ½(w₀F₀ + w₁F₁) + w₀w₁ (U₁ − U₀ − ½(F₀ + F₁)·Δq) M⁻¹Δq/(Δq·M⁻¹Δq), within the table the discrete
/// gradient of the energy [Gonzalez1996], whose work is the change of the energy; of creep and damping forces the mean
/// of both ends, in proportion to the normal force's.
[[nodiscard]] Vector9 loaded_mean_force(const WheelContactModel& model, WheelSide side, const LoadedMemory& start,
                                        const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                        const LoadedLookup& lookup) noexcept;

/// Forces with their derivative in a time step.
struct LoadedWheelResponse {
  LoadedWheelForce force;
  Matrix9 tangent;  ///< as wheel_force_tangent(): of the force, or of its mean over a step
};

/// Force and derivative from one look-up, by the chain rule from the table's derivatives, the law's and those of the
/// kinematics.
/// @param lookup, slopes at the pose that relative_pose() returns
/// @param start of the mean force over a step, or null
[[nodiscard]] LoadedWheelResponse loaded_wheel_response(const WheelContactModel& model, WheelSide side,
                                                        const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                                        const LoadedLookup& lookup, const LoadedSlopes& slopes,
                                                        const StepRates& rates, const LoadedMemory* start) noexcept;

/// A wheel and its rail.
struct WheelState {
  WheelSide side;
  WheelsetMotion wheelset;
  RailHeadMotion rail;
};

/// Whether wheels can be computed side by side: by a loaded table, without damping, with friction that does not fall.
[[nodiscard]] bool computes_side_by_side(const WheelContactModel& model) noexcept;

/// Where the answer about one of several wheels goes; nothing is written for a wheel that is not answered.
struct LoadedAnswer {
  WheelsetPose* pose = nullptr;  ///< of a right wheel
  LoadedLookup* lookup = nullptr;
  LoadedWheelForce* force = nullptr;
  Matrix9* tangent = nullptr;  ///< of loaded_wheel_responses() alone
};

/// Forces of up to WheelLanes::count wheels side by side, look-ups included. Only wheels that touch, by the table
/// alone, and where there is friction are answered.
/// @param to one for each wheel; none of the three null @pre computes_side_by_side()
/// @return whether each wheel is answered, bit by bit from the first
[[nodiscard]] std::uint32_t loaded_wheel_forces(const WheelContactModel& model, std::span<const WheelState> wheels,
                                                std::span<const LoadedAnswer> to) noexcept;
/// The same with derivatives. @pre no start of a mean force
[[nodiscard]] std::uint32_t loaded_wheel_responses(const WheelContactModel& model, std::span<const WheelState> wheels,
                                                   const StepRates& rates, std::span<const LoadedAnswer> to) noexcept;

}  // namespace railtab
