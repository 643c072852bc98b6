#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "command/command_line.hpp"
#include "run_pool.hpp"

namespace railtab::vsi {

/// What the row of a run in a folder begins with: "v055.556-s001,55.5556,200,1,". The column `complete` follows, then
/// numbers or nothing, last a message.
struct RunRow {
  std::string name;   ///< of the run's files, without their suffix
  std::string begin;  ///< of its row
};

struct RunCount {
  std::size_t asked = 0;  ///< different runs
  std::size_t finished = 0, ended_early = 0;
};
/// Exit code of a command whose pool has ended with `code`: 1 where runs ended early or are not finished. Runs that
/// failed because another process was computing them may have finished there meanwhile.
[[nodiscard]] int code_of_runs(int code, const RunCount& count) noexcept;

/// Row of a finished run. @throws InputError naming the file where it is not that row, with all `columns`
[[nodiscard]] std::string read_row(const RunPool& pool, const RunRow& run, std::string_view columns);
/// Whether the run came to its end, from its row. @pre the row is that of read_row()
[[nodiscard]] bool complete_of_row(const RunRow& run, std::string_view row) noexcept;
/// A text as a cell of a row: without what would end the cell or the row.
[[nodiscard]] std::string message_cell(std::string message);

/// All runs that are finished, whichever process or shard made them; their rows are added to `rows`. @throws InputError
RunCount count_rows(const RunPool& pool, const std::vector<RunRow>& runs, std::string_view columns, std::string& rows);

/// Warnings of the finished runs, each once with the runs that have it; warnings that differ in their numbers alone
/// count as one, which is that of the first run.
[[nodiscard]] std::vector<std::string> warnings_of_runs(const RunPool& pool, const std::vector<RunRow>& runs);
/// @param command "vsi sweep"
void print_warnings(std::string_view command, const std::vector<std::string>& warnings);

/// A folder holds the runs of one scene and of the same contents of the files that it names, or is bound to them here
/// by its file scene.toml. @param scene the file of the scene; text, files what it reads
/// @throws InputError with the first difference, and where that file scene.toml is the scene itself
void check_same_scene(const std::filesystem::path& scene, std::string text,
                      const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder);

/// What processes left that were killed while they wrote: of finished runs too, which nothing is written of any more.
void remove_abandoned_runs(const std::vector<RunRow>& runs, const std::vector<std::string>& others,
                           const std::filesystem::path& folder);

/// Every N-th of the runs, from the I-th on.
template <class Run>
[[nodiscard]] std::vector<Run> own_part(const std::vector<Run>& all, const PartOf& shard) {
  std::vector<Run> own;
  for (auto i = static_cast<std::size_t>(shard.index - 1); i < all.size(); i += static_cast<std::size_t>(shard.count)) {
    own.push_back(all[i]);
  }
  return own;
}

}  // namespace railtab::vsi
