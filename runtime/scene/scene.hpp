#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

struct SceneParameters;

/// A scene and its run: the door of the solver library for other programs. The keys are those of docs/guide/scene.md.
class Scene {
 public:
  /// @throws InputError with file and line: unknown key, value out of its range, missing file
  explicit Scene(const std::filesystem::path& file);
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  /// Builds the model, finds the start and integrates to the end of the scene.
  /// @param record receives the initial state, then every output.every steps, and the last step; may be empty
  /// @return why and where the run ended, and its extremes; complete = false where it could not go on
  /// @throws InputError where files of the scene are wrong, ComputationError where there is no model or no factor
  [[nodiscard]] RunSummary run(const std::function<void(const StepRecord&)>& record = {}) const;

 private:
  std::unique_ptr<const SceneParameters> parameters_;
};

}  // namespace railtab
