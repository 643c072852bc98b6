#include "railtab/runtime/contact/contact_response.hpp"

#include <algorithm>
#include <array>

#include "railtab/runtime/contact/loaded_wheel.hpp"

namespace railtab {

namespace {

/// Whether the force is the mean over a step at whose start there are patches.
bool starts_by_patches(const StepRates& rates) { return rates.start && rates.start->count > 0; }

}  // namespace

WheelContact wheel_contact(const ContactGeometry& geometry, const WheelsetPose& pose) noexcept {
  WheelContact contact;
  contact.pose = pose;
  if (geometry.loaded()) contact.loaded = geometry.loaded()->lookup(pose.y, pose.z, pose.roll, pose.yaw);
  if (contact.by_patches()) contact.patches = geometry.patches(pose);
  return contact;
}

LoadedWheelForce wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                             const RailHeadMotion& rail, const WheelContact& contact) noexcept {
  const double share = contact.loaded.table_share;
  if (share == 0.0) return {wheel_force(model, side, wheelset, rail, contact.patches), {}};
  const LoadedWheelForce loaded = loaded_wheel_force(model, side, wheelset, rail, contact.loaded);
  if (share == 1.0) return loaded;
  WheelForce force = wheel_force(model, side, wheelset, rail, contact.patches);
  force.wheelset = (1.0 - share) * force.wheelset + share * loaded.wheelset;
  force.rail = (1.0 - share) * force.rail + share * loaded.rail;
  force.rail_x = -force.wheelset[0];
  force.creep_power = (1.0 - share) * force.creep_power + share * loaded.creep_power;
  force.pressure = (1.0 - share) * force.pressure + share * loaded.pressure;
  for (int i = 0; i < contact.patches.count; ++i) force.patch[static_cast<std::size_t>(i)] *= 1.0 - share;
  return {force, loaded.memory};
}

ContactPatches recorded_patches(const WheelRailPair& pair, const WheelContact& contact) noexcept {
  return contact.by_patches() ? contact.patches : loaded_patches(pair, contact.pose, contact.loaded);
}

double elastic_energy(const WheelContactModel& model, const WheelContact& contact) noexcept {
  double sum = contact.loaded.table_share * contact.loaded.energy;
  if (!contact.by_patches()) return sum;
  const PatchLoads loads = patch_loads(model.normal, *model.geometry, contact.pose, contact.patches);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    sum += (1.0 - contact.loaded.table_share) * 0.4 * loads[i].elastic_force * contact.patches.patch[i].penetration;
  }
  return sum;
}

ContactMemory contact_memory(const WheelRailPair& pair, const WheelContact& contact,
                             const LoadedWheelForce& force) noexcept {
  ContactMemory memory = remembered(pair, contact.pose, contact.patches, force);
  memory.loaded = force.memory;
  return memory;
}

Vector9 mean_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                   const RailHeadMotion& rail, const ContactMemory& start, const WheelContact& contact,
                   const WheelForce& force) noexcept {
  Vector9 mean = Vector9::Zero();
  if (contact.patches.count > 0 || start.count > 0) {
    mean = mean_force(model.geometry->pair(), start, contact.pose, contact.patches, force);
  }
  if (contact.loaded.table_share > 0.0 || start.loaded.weight > 0.0) {
    mean += loaded_mean_force(model, side, start.loaded, wheelset, rail, contact.loaded);
  }
  return mean;
}

Matrix9 wheel_force_tangent(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                            const RailHeadMotion& rail, const WheelContact& contact, const StepRates& rates) noexcept {
  const double share = contact.loaded.table_share;
  Matrix9 tangent = Matrix9::Zero();
  if (contact.by_patches() || starts_by_patches(rates)) {
    tangent = wheel_force_tangent(model, side, wheelset, rail, contact.patches, rates, 1.0 - share);
  }
  const LoadedMemory* start = rates.start ? &rates.start->loaded : nullptr;
  if (share > 0.0 || (start && start->weight > 0.0)) {
    LoadedSlopes slopes;
    const WheelsetPose& p = contact.pose;
    const LoadedLookup lookup = model.geometry->loaded()->lookup(p.y, p.z, p.roll, p.yaw, slopes);
    // a mean has the shares of its ends already
    tangent += (start ? 1.0 : share) *
               loaded_wheel_response(model, side, wheelset, rail, lookup, slopes, rates, start).tangent;
  }
  return tangent;
}

WheelResponse wheel_response(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                             const RailHeadMotion& rail, const StepRates& rates) noexcept {
  const ContactGeometry& geometry = *model.geometry;
  WheelResponse result;
  result.contact.pose = relative_pose(geometry.pair(), side, wheelset, rail);
  const WheelsetPose& p = result.contact.pose;
  if (geometry.loaded()) {
    LoadedSlopes slopes;
    result.contact.loaded = geometry.loaded()->lookup(p.y, p.z, p.roll, p.yaw, slopes);
    if (!result.contact.by_patches() && !starts_by_patches(rates)) {
      const LoadedMemory* start = rates.start ? &rates.start->loaded : nullptr;
      static_cast<LoadedWheelResponse&>(result) =
          loaded_wheel_response(model, side, wheelset, rail, result.contact.loaded, slopes, rates, start);
      return result;
    }
  }
  if (result.contact.by_patches()) result.contact.patches = geometry.patches(p);
  result.force = wheel_force(model, side, wheelset, rail, result.contact);
  result.tangent = wheel_force_tangent(model, side, wheelset, rail, result.contact, rates);
  return result;
}

void wheel_responses(const WheelContactModel& model, std::span<const WheelState> wheels, const StepRates& rates,
                     std::span<WheelResponse> responses) noexcept {
  const bool side_by_side = computes_side_by_side(model) && !rates.start;
  constexpr std::size_t most = WheelLanes::count;
  for (std::size_t first = 0; first < wheels.size(); first += most) {
    const auto some = wheels.subspan(first, std::min(most, wheels.size() - first));
    const auto to = responses.subspan(first, some.size());
    std::array<LoadedAnswer, most> answer;
    for (std::size_t i = 0; i < some.size(); ++i) {
      answer[i] = {&to[i].contact.pose, &to[i].contact.loaded, &to[i].force, &to[i].tangent};
    }
    const std::uint32_t answered =
        side_by_side && some.size() > 1 ? loaded_wheel_responses(model, some, rates, answer) : 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      if ((answered >> i & 1U) != 0) {
        to[i].contact.patches.clear();
      } else {
        to[i] = wheel_response(model, some[i].side, some[i].wheelset, some[i].rail, rates);
      }
    }
  }
}

}  // namespace railtab
