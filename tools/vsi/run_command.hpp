#pragma once

#include <functional>
#include <string>
#include <vector>

#include "headline.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/shared_setup.hpp"

namespace railtab::vsi {

struct RunOptions {
  std::string output;
  bool json = false, quiet = false, resume = false;
  /// Of a run among many: told its end and all its warnings, in place of the program's own words; may be empty.
  std::function<void(const report::Headline&, const RunSummary&, const std::vector<std::string>& warnings)> ended{};
  std::function<bool()> stop{};                  ///< whether to end after this step, besides Ctrl-C; may be empty
  std::function<void(double share)> progress{};  ///< of the steps done, 0..1; may be empty
  SharedSetUp* shared = nullptr;                 ///< as of run_scene()
};

/// Runs a scene and writes its results; with `resume` it goes on from the checkpoint that they hold, and leaves
/// complete results alone. @return exit code. @throws InputError as run_scene(), and where the results in the way are
/// another run's
int run_to_file(const SceneParameters& scene, const RunOptions& options);

/// Runs a scene for its headline alone: writes no results, cannot be resumed. @return exit code
/// @throws InputError as run_scene()
int run_without_results(const SceneParameters& scene, const RunOptions& options);

}  // namespace railtab::vsi
