#include "scene_structure.hpp"

#include "railtab/runtime/structure/structure_import.hpp"
#include "scene_loads.hpp"

namespace railtab {

bool track_on_import(const SceneParameters& scene) noexcept {
  return scene.track_kind == TrackKind::flexible && !scene.structure.files.stiffness.empty();
}

StructureModel build_structure(const SceneParameters& scene) {
  const FeFiles& files = scene.structure.files;
  if (scene.track_kind == TrackKind::imported) {
    if (!files.nodes.empty()) return import_with_rails(scene.structure);
    return import_structure({files.mass, files.damping, files.stiffness, files.dofs});
  }
  if (track_on_import(scene)) return build_track_on_import(scene.track, scene.structure);
  return build_track_bridge(scene.track, scene.spans, structure_plane(scene));
}

}  // namespace railtab
