#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab {

/// A checkpoint as the numbers of a slot: sequence number, step, records, length of the state, upper and lower half of
/// the word_checksum() over these four and the state, the state.
struct CheckpointSlot {
  long sequence = 0;  ///< counts the checkpoints of a run from 1
  Checkpoint checkpoint;
};
[[nodiscard]] std::vector<double> encode_checkpoint(long sequence, long step, std::size_t records,
                                                    std::span<const double> state);
/// None where the slot is empty or was not written to its end.
[[nodiscard]] std::optional<CheckpointSlot> decode_checkpoint(std::span<const double> slot);

}  // namespace railtab
