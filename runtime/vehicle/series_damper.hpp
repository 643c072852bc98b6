#pragma once

#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Dampers in series with a stiffness (Maxwell elements): each adds one inner degree of freedom without mass, the
/// elongation s of its spring. With e the relative displacement of the attachment points along the damper's axis,
///
///     F = k_s s = c (ė − ṡ),      |F| = k_s c ω / √(k_s² + c² ω²) at e = sin ωt
///
/// so that K gets k_s in the row of s alone and C gets c [B −1]ᵀ[B −1], e = B u.
/// @returns how many of the units' dampers have a series stiffness
[[nodiscard]] int count_series_dampers(const std::vector<Suspension>& suspension);

/// Whether the unit's damper along an axis has a series stiffness.
[[nodiscard]] bool is_in_series(const Suspension& unit, int axis) noexcept;

/// Dampers that follow a curve are left to add_force_elements() where `choice` asks for it.
/// @param first_row of their inner degrees of freedom, which the matrices have already
void add_series_dampers(VehicleModel& vehicle, const std::vector<Suspension>& suspension, int first_row,
                        ForceElementChoice choice);

/// The unit's linear dampers without those that have a series stiffness [N s/m].
[[nodiscard]] Eigen::Vector3d parallel_damping(const Suspension& unit, ForceElementChoice choice);

}  // namespace railtab
