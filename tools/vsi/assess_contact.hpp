#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "assess_trains.hpp"
#include "assessment.hpp"
#include "run_folder.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {

/// Has the measures of a run recorded, a millisecond apart at most.
void record_what_is_judged(SceneParameters& scene);

/// Has all nodes of the decks followed at every step, accelerations low-passed at `cut_off` [Hz], or at a lower
/// frequency where steps are too long for it; without a bridge whose nodes are known only the recorded nodes are
/// judged.
/// @return whether they are followed, and low-passed at `cut_off`
bool follow_deck(SceneParameters& scene, double cut_off);

/// Where wheels and car bodies of a scene begin to be judged, and the friction of Nadal's limit: of friction along the
/// track the largest. @throws InputError as read_rail_friction()
[[nodiscard]] assess::RunWindow judged_window(const SceneParameters& scene);

/// Runs with contact of one train of an assessment.
struct ContactPlan {
  std::string train;
  bool own = false;       ///< the scene's
  SceneParameters scene;  ///< that of the runs: with room for the fade-in, what is judged recorded, the whole crossing
  std::vector<SweepRun> runs;
  assess::RunWindow window;
  std::vector<std::string> notes;  ///< what was changed of the user's scene, sentence by sentence
};

/// @param train with a scene @param speeds [m/s]
/// @param seeds of a random track; without one there is one run for each speed
/// @throws InputError naming the key of the scene that excludes runs at several speeds
[[nodiscard]] ContactPlan contact_plan(const AssessTrain& train, const std::vector<assess::DeckAssessment>& decks,
                                       const std::vector<double>& speeds, int seeds);

/// Gives the runs of all plans names of their own: those of trains other than the scene's begin with the train's.
void name_runs(std::vector<ContactPlan>& plans);

/// Makes the runs that are not there yet, each in a process of its own, into `folder`.
class ContactRuns {
 public:
  /// @param plans outlive it
  ContactRuns(const std::vector<ContactPlan>& plans, std::filesystem::path scene_file, std::filesystem::path folder,
              const std::function<void(double)>& progress);
  /// A part of the runs. @return exit code of the runs, see RunPool::run()
  int make(const PartOf& shard, int processes);
  [[nodiscard]] RunCount count(const PartOf& shard) const;
  /// Measures of all runs; those that are not there are noted.
  void measure(assess::Assessment& assessment) const;

 private:
  const std::vector<ContactPlan>& plans_;
  RunPool pool_;
};

}  // namespace railtab::vsi
