#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

inline constexpr std::string_view results_filetype = "railtab-results";

/// Where a run can be taken up again.
struct Checkpoint {
  long step = 0;              ///< time steps done
  std::size_t records = 0;    ///< records that were written by then
  std::vector<double> state;  ///< as the solver gave it
};

/// Writes results as the run goes, so that a run ended by anything leaves a readable file with everything up to the
/// last flush, marked incomplete. Records are kept in memory between flushes.
class ResultWriter {
 public:
  enum class Grid { absent, at_the_end };  ///< the group for ParaView (vtkhdf_group.hpp)
  static constexpr int records_between_flushes = 200;
  /// The file has its name from the first flush on.
  /// @param flush_every records between flushes, >= 1
  /// @throws InputError where the file cannot be created, or another run is writing it.
  ResultWriter(const std::filesystem::path& file, const ResultHeader& header, int flush_every = records_between_flushes,
               Grid grid = Grid::absent);
  /// Continue a run that ended early: its file is cut back to the records of the checkpoint.
  /// @throws InputError as read_results, and where another run is writing the file.
  static ResultWriter resume(const std::filesystem::path& file, const Checkpoint& from,
                             int flush_every = records_between_flushes);
  /// Without finish(): flushes what was appended; the file stays incomplete.
  ~ResultWriter();
  ResultWriter(ResultWriter&&) noexcept;

  /// The record has as many wheels, bodies and nodes as the header.
  void append(const StepRecord& record);
  /// Flushes, then stores the solver's state. Two slots alternate, each with a checksum: a process that ends midway
  /// leaves the checkpoint before.
  void checkpoint(std::span<const double> state, long step);
  /// The newest whole checkpoint of a file, none where none was taken.
  /// @throws InputError as read_results.
  [[nodiscard]] static std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);
  /// @param drawn records that the group for ParaView shows, where there is one; none: it stays empty
  void finish(const RunSummary& summary, std::span<const StepRecord> drawn = {});

 private:
  struct Impl;
  explicit ResultWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A whole results file in memory, for reports.
struct RunResults {
  ResultHeader header;
  RunSummary summary;
  std::vector<StepRecord> steps;
};
/// Also of a run that is going on or was killed: what was flushed, with summary.complete false.
/// @throws InputError with file and place: missing, not a results file, of another version, truncated.
[[nodiscard]] RunResults read_results(const std::filesystem::path& file);

/// The summary alone, without the time histories. @throws InputError as read_results.
[[nodiscard]] RunSummary read_run_summary(const std::filesystem::path& file);

}  // namespace railtab
