#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/contact_search.hpp"

namespace railtab {

/// Beyond this lowering below first touch, the profiles are through each other [m].
inline constexpr double deepest_lowering = 0.01;

/// Beyond this vertical load [N], no wheel.
inline constexpr double largest_query_load = 1e7;

/// Rounding of the height of first touch [m]: a wheel that just touches has its patch.
inline constexpr double touch_rounding = 1e-13;

/// Normal contact of the steel that a geometry's loaded table was made for, else of the default one. Forces without
/// friction depend on the contact modulus alone.
[[nodiscard]] NormalContactModel table_material(const ContactGeometry& geometry) noexcept;

/// Force on the rail (y, z) [N] and its moment about x through the rail-head origin [N m] of a right wheel that rests
/// at a pose, without friction. @pre a loaded table has the contact modulus of `normal`
[[nodiscard]] Vector3 frictionless_force(const ContactGeometry& geometry, const WheelsetPose& pose,
                                         const NormalContactModel& normal) noexcept;

/// The least lowering below first touch at which the wheel carries a vertical load [m], 0 to deepest_lowering; none
/// where the contact does not carry it there. Where the force of a loaded table falls, a peak above the load that is
/// narrower than 2 % of the lowering is passed.
/// @param touch the pose at first touch @param load above 0 [N]
[[nodiscard]] std::optional<double> lowering_under_load(const ContactGeometry& geometry, const WheelsetPose& touch,
                                                        double load, const NormalContactModel& normal);

/// How a query says where a wheel is.
enum class Lowering { given, under_load };

/// Pose of a query, and its lowering below first touch [m].
struct LoweredPose {
  WheelsetPose pose;
  double lowering;
};
/// The pose at y, roll and yaw of `at` that is lowered by `value`, 0 to deepest_lowering [m], or carries the vertical
/// load `value`, up to largest_query_load [N].
/// @param search of the geometry's pair @param place of the query, for messages
/// @throws InputError where wheel and rail never meet, or the value is out of range
[[nodiscard]] LoweredPose lowered_pose(const ContactSearch& search, const ContactGeometry& geometry,
                                       const WheelsetPose& at, Lowering by, double value,
                                       const NormalContactModel& normal, const std::function<std::string()>& place);

/// What carries the load in one patch: normal force [N], semi-axes along and across the rolling direction [m], largest
/// pressure [Pa]. Zero where the patch bears nothing.
struct PatchLoading {
  double normal_force = 0.0, a = 0.0, b = 0.0, pressure = 0.0;
};

/// Of the patches at a pose: parts of the loaded contact count to the nearest patch along the rail; without a loaded
/// part, Hertz's ellipse of patch_loads().
[[nodiscard]] std::array<PatchLoading, ContactPatches::capacity> patch_loadings(
    const ContactGeometry& geometry, const WheelsetPose& pose, const ContactPatches& patches,
    const NormalContactModel& normal) noexcept;

}  // namespace railtab
