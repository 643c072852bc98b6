#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {

struct RunPoolOptions {
  std::string command;                           ///< "vsi sweep", for messages
  bool quiet = false;                            ///< no line for each run that has ended
  std::function<void(double share)> progress{};  ///< of all runs together, 0..1; may be empty
};

/// Runs in processes of their own: one that dies takes no other with it, and every one can be resumed. A run has two
/// files in the folder: NAME.h5, its results, and NAME.row, written last.
class RunPool {
 public:
  /// @param scene of all runs; scene_of() makes each run's own. It outlives the pool.
  RunPool(const SceneParameters& scene, std::filesystem::path scene_file, std::filesystem::path folder,
          RunPoolOptions options);

  /// Finished runs are kept, interrupted ones resume. Input that is wrong for the first run that ends is wrong for all:
  /// the rest is not begun.
  /// @return exit code: 1 where a run failed or ended early, 2 where the input of all is wrong, 130 after Ctrl-C
  int run(const std::vector<SweepRun>& runs, std::size_t processes);

  /// A run is finished when its row is there, where the train has derailed too, and so are its results.
  [[nodiscard]] bool finished(const SweepRun& run) const;
  [[nodiscard]] std::filesystem::path file(const SweepRun& run, const char* suffix) const;

 private:
  int begin(const SweepRun& run, double* share);
  void set_aside(const SweepRun& run, const char* suffix, const std::string& why) const;
  void check_results(const SweepRun& run, const SceneParameters& scene) const;
  void set_others_aside(const SweepRun& run, const SceneParameters& scene) const;
  [[nodiscard]] int in_own_process(const SweepRun& run, double* share) const;
  int wait();
  int ended(int process, int status);

  const SceneParameters& scene_;
  std::filesystem::path scene_file_, folder_;
  RunPoolOptions options_;
  bool one_ended_ = false;  ///< with another exit code than that of wrong input
  std::map<int, const SweepRun*> going_;
};

/// The folder of the results is made, but none that would hold it: a path with a slip is rejected, as for every -o.
/// @throws InputError
void make_output_folder(const std::filesystem::path& folder);

}  // namespace railtab::vsi
