#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "headline.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/shared_setup.hpp"

namespace railtab::vsi {

/// One run of many.
struct PooledRun {
  std::string name;                        ///< of its files, without their suffix
  std::function<SceneParameters()> scene;  ///< asked for in the process that runs it
  /// Its row, which ends with the line, from its results; these are read again where the headline is not enough.
  std::function<std::string(const report::Headline&, const RunSummary&, const std::filesystem::path& results)> row;
};

/// What becomes of the results of a run: they are kept, are removed once it has its row, or are never written, where
/// none are there already.
enum class PooledResults { kept, removed, unwritten };

struct RunPoolOptions {
  std::string command;                           ///< "vsi sweep", for messages
  bool quiet = false;                            ///< no line for each run that has ended
  std::function<void(double share)> progress{};  ///< of all runs together, 0..1; may be empty
  PooledResults results = PooledResults::kept;
};

/// Runs in worker processes, each of which makes one run after the other and keeps what they have in common
/// (SharedSetUp). A worker that dies loses the run that it makes, and another takes its place; every run that
/// writes results can be resumed. A run has up to three files in the folder: NAME.h5, its results, NAME.warnings, a
/// line for each of its warnings, where it has any, and NAME.row, written last.
class RunPool {
 public:
  RunPool(std::filesystem::path scene_file, std::filesystem::path folder, RunPoolOptions options);

  /// Finished runs are kept, interrupted ones resume. Input that is wrong for the first run that ends is wrong for all:
  /// the rest is not begun. @param runs of different names
  /// @return exit code: 1 where a run failed or ended early, 2 where the input of all is wrong, 130 after Ctrl-C
  int run(const std::vector<PooledRun>& runs, std::size_t processes);

  /// A run is finished when its row is there, where the train has derailed too, and so are its results where they are
  /// kept.
  [[nodiscard]] bool finished(const std::string& name) const;
  [[nodiscard]] std::filesystem::path file(const std::string& name, const char* suffix) const;

 private:
  struct Board;
  void begin_worker(Board& board, std::size_t worker, int report);
  void work(Board& board, std::size_t worker, int report) const;
  void set_aside(const std::string& name, const char* suffix, const std::string& why) const;
  void check_results(const std::string& name, const SceneParameters& scene) const;
  void set_others_aside(const std::string& name, const SceneParameters& scene) const;
  [[nodiscard]] int make(Board& board, std::size_t run, SharedSetUp& shared) const;
  [[nodiscard]] int make_row(Board& board, std::size_t run, const SceneParameters& scene, SharedSetUp& shared) const;
  void write_warnings(const std::string& name, const std::string& warnings) const;
  void say_early_end(const std::string& name, const SceneParameters& scene, const report::Headline& headline,
                     const RunSummary& summary) const;
  void say_end(const PooledRun& run, int code);

  std::filesystem::path scene_file_, folder_;
  RunPoolOptions options_;
  const std::vector<PooledRun>* runs_ = nullptr;
  std::map<int, std::size_t> workers_;  ///< numbers of the workers by their processes
};

/// The folder of the results is made, but none that would hold it: a path with a slip is rejected, as for every -o.
/// @throws InputError
void make_output_folder(const std::filesystem::path& folder);

}  // namespace railtab::vsi
