#include "railtab/runtime/contact/frictionless_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

NormalContactModel table_material(const ContactGeometry& geometry) noexcept {
  NormalContactModel normal;
  if (!geometry.loaded()) return normal;
  const double nu = normal.material.nu;
  normal.material.E = 2.0 * (1.0 - nu * nu) * geometry.loaded()->data().contact_modulus;
  return normal;
}

Vector3 frictionless_force(const ContactGeometry& geometry, const WheelsetPose& pose,
                           const NormalContactModel& normal) noexcept {
  WheelContactModel model;
  model.geometry = &geometry;
  model.normal = normal;
  model.friction = 0.0;
  model.speed = 1.0;
  WheelsetMotion motion;
  motion.displacement << 0.0, pose.y, pose.z, pose.roll, 0.0, pose.yaw;
  return wheel_force(model, WheelSide::right, motion, {}, wheel_contact(geometry, pose)).rail;
}

std::optional<double> lowering_under_load(const ContactGeometry& geometry, const WheelsetPose& touch, double load,
                                          const NormalContactModel& normal) {
  WheelsetPose pose = touch;
  const auto excess = [&](double dz) {
    pose.z = touch.z + dz;
    return frictionless_force(geometry, pose, normal)[1] - load;
  };
  // The force falls where a loaded part ends and patches go on: a long stride near the load would pass the first
  // lowering that carries it. It grows by about the square of the lowering at most.
  constexpr double shortest = 1.02, longest = 2.0, reached = 0.7;
  double low = 0.0, high = 1e-6, at_high = excess(high), at_low = -load;
  while (at_high < 0.0 && high < deepest_lowering) {
    low = high;
    at_low = at_high;
    const double share = (at_high + load) / load;
    const bool may_fall = geometry.loaded() != nullptr && share > 0.0;
    high *= may_fall ? std::clamp(std::sqrt(reached / share), shortest, longest) : longest;
    high = std::min(deepest_lowering, high);
    at_high = excess(high);
  }
  if (at_high < 0.0) return std::nullopt;
  boost::uintmax_t passes = 200;
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-15; };
  const auto [below, above] = boost::math::tools::toms748_solve(excess, low, high, at_low, at_high, close, passes);
  return 0.5 * (below + above);
}

LoweredPose lowered_pose(const ContactSearch& search, const ContactGeometry& geometry, const WheelsetPose& at,
                         Lowering by, double value, const NormalContactModel& normal,
                         const std::function<std::string()>& place) {
  if (by == Lowering::given && !(value >= 0.0 && value <= deepest_lowering)) {
    throw input_error(place(), fmt::format("dz = {}", value),
                      fmt::format("0 to {} m below first touch", deepest_lowering));
  }
  LoweredPose result{at, value};
  const double touch = search.touch_height(at.y, at.roll, at.yaw);
  if (!std::isfinite(touch)) {
    throw input_error(
        place(), fmt::format("y = {}, yaw = {}, roll = {}, where wheel and rail never meet", at.y, at.yaw, at.roll),
        "a position on the rail");
  }
  result.pose.z = touch;
  if (by == Lowering::under_load) {
    if (!(value > 0.0 && value <= largest_query_load)) {
      throw input_error(place(), fmt::format("load = {}", value),
                        fmt::format("above 0, at most {} N", largest_query_load));
    }
    const std::optional<double> lowering = lowering_under_load(geometry, result.pose, value, normal);
    if (!lowering) {
      throw input_error(place(),
                        fmt::format("load = {} N, not carried {} m below first touch", value, deepest_lowering),
                        "a load that the contact carries");
    }
    result.lowering = *lowering;
  }
  result.pose.z = touch + result.lowering;
  return result;
}

std::array<PatchLoading, ContactPatches::capacity> patch_loadings(const ContactGeometry& geometry,
                                                                  const WheelsetPose& pose,
                                                                  const ContactPatches& patches,
                                                                  const NormalContactModel& normal) noexcept {
  std::array<PatchLoading, ContactPatches::capacity> result;
  LoadedLookup loaded;
  if (geometry.loaded()) loaded = geometry.loaded()->lookup(pose.y, pose.z, pose.roll, pose.yaw);
  if (loaded.table_share < 1.0) {
    const PatchLoads loads = patch_loads(normal, geometry, pose, patches);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const double N = loads[i].elastic_force, a = loads[i].hertz.a1 * std::cbrt(N),
                   b = loads[i].hertz.b1 * std::cbrt(N);
      if (N > 0.0) result[i] = {N, a, b, 1.5 * N / (std::numbers::pi * a * b)};
    }
    return result;
  }
  for (std::size_t p = 0; p < loaded.parts && patches.count > 0; ++p) {
    const LoadedPart& part = loaded.part[p];
    const auto distance = [&](const ContactPatch& patch) { return std::abs(patch.s_rail - part.s_rail); };
    const ContactPatch* const nearest =
        std::min_element(patches.begin(), patches.end(),
                         [&](const auto& one, const auto& other) { return distance(one) < distance(other); });
    PatchLoading& of = result[static_cast<std::size_t>(nearest - patches.begin())];
    const double N = part.share * loaded.force[1] / std::cos(part.angle);
    of.pressure = std::max(of.pressure, part.pressure);
    if (N > of.normal_force) {
      of.a = part.a;
      of.b = part.b;
    }
    of.normal_force += N;
  }
  return result;
}

}  // namespace railtab
