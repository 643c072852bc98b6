#include <utility>

#include "fmu_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"

namespace railtab::fmu {

fmi::DrivenTrack driven_track(const SceneParameters& scene) {
  if (scene.track_kind == TrackKind::rigid) {
    throw input_error("scene: track.kind", "\"rigid\"", "\"flexible\" or \"imported\": an FMU is of track and bridges");
  }
  if (!scene.ground_motion.empty()) {
    throw input_error("scene: ground_motion", "ground that moves", "none: an FMU has supports at rest");
  }
  fmi::DrivenTrack track;
  track.name = scene.name;
  track.scheme = {scene.integration.alpha, scene.integration.time_step, ContactForceRule::endpoint};
  const VsiModel train = train_model(scene);
  for (int w = 0; w < train.wheelsets(); ++w) track.wheelset_x.push_back(train.wheelset_x(w, 0.0));
  SceneParameters loaded = scene;
  loaded.contact.normal = NormalContact::hertz;  // forces act between nodes, along y too
  track.structure = scene_structure(loaded);
  return track;
}

}  // namespace railtab::fmu
