#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/tablegen/creep_job.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {

/// What a shard or partial file says of itself; all of it must agree for numbers to be used together.
struct CreepShardHeader {
  CreepJob job;
  std::string program_version;
  std::string case_list;   ///< checksum of the cases of the whole table, hexadecimal
  std::int64_t cases = 0;  ///< of the shard; of the table where there is none

  /// "poisson" -> "0.28", ...: what messages name where two headers differ.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> named() const;
};

[[nodiscard]] CreepShardHeader creep_shard_header(const CreepJob& job, std::span<const CreepCase> cases,
                                                  std::span<const CreepLine> own, std::string program_version);

/// @throws InputError "FILE: poisson: found 0.3, expected 0.28 as in OTHER" at the first difference.
/// @param shard compare the number of the shard, too
void require_same_job(const CreepShardHeader& found, const std::filesystem::path& file,
                      const CreepShardHeader& expected, std::string_view other, bool shard);

/// The file of a job under way.
[[nodiscard]] ArrayFileWriter create_creep_partial(const std::filesystem::path& file, const CreepShardHeader& header);
void append(ArrayFileWriter& partial, std::span<const SolvedCreepCase> solved);

/// Whole or not at all, sealed.
void write_creep_shard(const std::filesystem::path& file, const CreepShardHeader& header,
                       std::span<const SolvedCreepCase> solved);

struct CreepShard {
  CreepShardHeader header;
  std::vector<SolvedCreepCase> solved;  ///< of a partial file, those of the last flush
};
/// @param filetype creep_shard_filetype or creep_partial_filetype. @throws InputError
[[nodiscard]] CreepShard read_creep_shard(const std::filesystem::path& file, std::string_view filetype);

inline constexpr int creep_shard_format_version = 2;

}  // namespace railtab
