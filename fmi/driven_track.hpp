#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/vsi/hht.hpp"

namespace railtab::fmi {

/// What an FMU holds of a scene: track and bridges, the scheme of their time integration, and where the wheelsets stand
/// at first. Vehicles, contacts and irregularities are the importer's.
struct DrivenTrack {
  std::string name;                ///< of the scene
  HhtScheme scheme;                ///< with ContactForceRule::endpoint
  std::vector<double> wheelset_x;  ///< along the track, front first [m]
  StructureModel structure;        ///< matrices, rails, nodes with names and sums, places of the unknowns; nothing else
};

/// The content of resources/track: railtab's version, and all members in a fixed order.
[[nodiscard]] std::string track_bytes(const DrivenTrack& track);
/// The inverse, to the last bit.
/// @param place for messages @throws InputError where the bytes are not of this version of railtab, or end too soon
[[nodiscard]] DrivenTrack track_of_bytes(std::string_view bytes, std::string_view place);

/// The FMU's GUID, 32 hexadecimal digits: two checksums of that content, which decides all of the FMU.
[[nodiscard]] std::string track_guid(std::string_view bytes);

}  // namespace railtab::fmi
