#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/scene/scene_case.hpp"

// Track that the wheels' profiles do not fit.

namespace railtab::scene {
namespace {

void rails_beside_contacts(const SceneCase& at, Warnings& list) {
  if (!at.model.geometry || at.scene.track_kind != TrackKind::flexible) return;
  constexpr double far = 0.1;  // [m]
  const double half = at.scene.track.half_rail_distance;
  const WheelRailPair& pair = at.model.geometry->pair();
  if (std::abs(half - pair.rail_offset()) <= far) return;
  list.push_back(
      fmt::format("track.half_rail_distance = {:g} m: contact is on rail heads {:.4g} m from the track centre, at a "
                  "gauge of {:g} m",
                  half, pair.rail_offset(), pair.dimensions().track_gauge));
}

}  // namespace

const Warning rails_off_gauge{"it is more than 0.1 m off the rail heads of the contact's track gauge",
                              rails_beside_contacts};

}  // namespace railtab::scene
