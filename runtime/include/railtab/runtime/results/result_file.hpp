#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "railtab/runtime/results/step_record.hpp"

namespace railtab {

/// Writes results as the run goes: extendible HDF5 datasets, flushed every `flush_every` records, so that a killed run
/// leaves everything up to the last flush, marked incomplete.
class ResultWriter {
 public:
  /// @throws InputError where the file cannot be created.
  ResultWriter(const std::filesystem::path& file, const ResultHeader& header, int flush_every = 200);
  ~ResultWriter();
  ResultWriter(ResultWriter&&) noexcept;
  void append(const StepRecord& record);
  void finish(const RunSummary& summary);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A whole results file in memory, for reports.
struct RunResults {
  ResultHeader header;
  RunSummary summary;
  std::vector<StepRecord> steps;
};
/// @throws InputError with file and place: missing, not a results file, of another version, truncated.
[[nodiscard]] RunResults read_results(const std::filesystem::path& file);

}  // namespace railtab
