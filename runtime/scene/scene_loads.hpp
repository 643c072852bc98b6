#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Unknowns that a scene needs: the vertical plane alone where wheels follow the rails and no span stands aside of the
/// track.
[[nodiscard]] MotionPlane vehicle_plane(const SceneParameters& scene) noexcept;
[[nodiscard]] MotionPlane structure_plane(const SceneParameters& scene) noexcept;

/// Whether nothing in the scene can follow a lateral motion of the ground.
[[nodiscard]] bool lateral_ground_is_left_out(const SceneParameters& scene) noexcept;

/// Speed over time, loads on bodies, ground motion and turning spans of a scene, read into the model, whose vehicle,
/// positions and structure are there already. @throws InputError
void add_loads(const SceneParameters& scene, VsiModel& model);

/// One sentence for each of them, for the plan of a run.
[[nodiscard]] std::vector<std::string> describe_loads(const SceneParameters& scene, const VsiModel& model);

}  // namespace railtab
