#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "assessment.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {

/// Has the measures of a run recorded, a millisecond apart at most.
void record_what_is_judged(SceneParameters& scene);

/// Where wheels and car bodies of a scene begin to be judged, and the friction of Nadal's limit.
[[nodiscard]] assess::RunWindow judged_window(const SceneParameters& scene);

/// Runs with contact of an assessment.
struct ContactPlan {
  SceneParameters scene;  ///< that of the runs: with room for the fade-in, what is judged recorded, the whole crossing
  std::vector<SweepRun> runs;
  assess::RunWindow window;
  std::vector<std::string> notes;  ///< what was changed of the user's scene, sentence by sentence
};

/// @param speeds [m/s] @param seeds of a random track; without one there is one run for each speed
/// @throws InputError naming the key of the scene that excludes runs at several speeds
[[nodiscard]] ContactPlan contact_plan(const SceneParameters& scene, const AxleTrain& own,
                                       const std::vector<assess::DeckAssessment>& decks,
                                       const std::vector<double>& speeds, int seeds);

/// Makes the runs that are not there yet, each in a process of its own, into `folder`, and measures them all.
/// @return exit code of the runs, see RunPool::run()
int run_contact(const ContactPlan& plan, const std::filesystem::path& scene_file, const std::filesystem::path& folder,
                int processes, const std::function<void(double)>& progress, assess::Assessment& assessment);

}  // namespace railtab::vsi
