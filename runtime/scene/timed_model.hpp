#pragma once

#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// A model and what building it takes, which the summary of its run counts as set-up.
class TimedModel {
 public:
  explicit TimedModel(const SceneParameters& scene, SharedSetUp* shared = nullptr)
      : model_(build(scene, shared, seconds_)) {}
  [[nodiscard]] const VsiModel& model() const noexcept { return model_; }
  [[nodiscard]] RunSummary counted(RunSummary summary) const {
    summary.seconds_setup += seconds_;
    summary.seconds_total += seconds_;
    return summary;
  }

 private:
  static VsiModel build(const SceneParameters& scene, SharedSetUp* shared, double& seconds) {
    const Stopwatch watch(seconds);
    return build_model(scene, shared);
  }
  double seconds_ = 0.0;
  VsiModel model_;
};

}  // namespace railtab
