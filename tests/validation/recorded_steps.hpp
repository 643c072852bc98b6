#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "railtab/runtime/scene/scene_run.hpp"

namespace railtab::testing {

/// All records of a run, which must be complete.
inline std::vector<StepRecord> recorded_steps(const SceneParameters& scene) {
  std::vector<StepRecord> steps;
  RunObserver observer;
  observer.record = [&](const StepRecord& step) { steps.push_back(step); };
  const RunSummary summary = run_scene(scene, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  return steps;
}

}  // namespace railtab::testing
