#pragma once

#include <filesystem>
#include <string>

#include "railtab/fmi/driven_track.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::fmu {

/// Track and bridges of a scene with the places of its train's wheelsets.
/// @throws InputError where the scene has no structure, or ground that moves
[[nodiscard]] fmi::DrivenTrack driven_track(const SceneParameters& scene);

/// modelDescription.xml of FMI 2.0 (2.2, 4.3). @param guid track_guid()
[[nodiscard]] std::string model_description(const fmi::DrivenTrack& track, const std::string& guid);

/// Writes the FMU whole or not at all, the same bytes for the same scene: model description, library, track, licence,
/// and the scene's text as documentation.
/// @throws InputError where `file` is there and no FMU of railtab, ComputationError where it cannot be written
void write_fmu(const std::filesystem::path& file, const fmi::DrivenTrack& track, const std::string& scene_text);

/// Whether a file is an FMU of railtab.
[[nodiscard]] bool is_fmu(const std::filesystem::path& file);

}  // namespace railtab::fmu
