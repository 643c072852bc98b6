#pragma once

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

// implementer: RailBeam (60E1), TrackParameters (pads, sleepers, ballast, spacing, elements per bay, length before and
// after), BridgeParameters (spans, section, mass, damping, deck height), each with units, defaults, source, validate().
struct TrackParameters {
  void validate() const;
};
struct BridgeParameters {
  void validate() const;
};

/// Two rails on discrete pads and sleepers, on ballast springs to the ground and, between x = 0 and the end of the last
/// span, to a 3D beam bridge. @throws InputError
[[nodiscard]] StructureModel build_track_bridge(const TrackParameters& track, const std::vector<BridgeParameters>& spans);

}  // namespace railtab
