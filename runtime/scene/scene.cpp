#include "railtab/runtime/scene/scene.hpp"

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"

namespace railtab {

Scene::Scene(const std::filesystem::path& file)
    : parameters_(std::make_unique<const SceneParameters>(read_scene(file))) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

RunSummary Scene::run(const std::function<void(const StepRecord&)>& record) const {
  RunObserver observer;
  if (record) observer.record = [&record](StepRecord& step) { record(step); };
  return run_scene(*parameters_, observer);
}

}  // namespace railtab
