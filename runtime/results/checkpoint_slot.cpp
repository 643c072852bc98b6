#include "railtab/runtime/results/checkpoint_slot.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/file_checksum.hpp"

namespace railtab {
namespace {

constexpr std::size_t counters = 4, head = 6;
constexpr double most_exact = 9007199254740992.0;  // 2^53: whole numbers are exact up to it
constexpr double half_range = 4294967296.0;        // 2^32: each half of the checksum is exact in a double

std::uint64_t slot_checksum(std::span<const double> counts, std::span<const double> state) {
  return word_checksum(std::as_bytes(state), word_checksum(std::as_bytes(counts)));
}

}  // namespace

std::vector<double> encode_checkpoint(long sequence, long step, std::size_t records, std::span<const double> state) {
  std::vector<double> slot{static_cast<double>(sequence), static_cast<double>(step), static_cast<double>(records),
                           static_cast<double>(state.size())};
  const std::uint64_t sum = slot_checksum(slot, state);
  slot.push_back(static_cast<double>(sum >> 32));
  slot.push_back(static_cast<double>(sum & 0xffffffffU));
  slot.insert(slot.end(), state.begin(), state.end());
  return slot;
}

std::optional<CheckpointSlot> decode_checkpoint(std::span<const double> slot) {
  if (slot.size() < head) return std::nullopt;
  const double high = slot[counters];
  const double low = slot[counters + 1];
  if (!(high >= 0 && high < half_range && low >= 0 && low < half_range)) return std::nullopt;
  const std::uint64_t sum = (static_cast<std::uint64_t>(high) << 32) | static_cast<std::uint64_t>(low);
  const double length = slot[counters - 1];
  const auto counts = [](double value) { return value >= 0.0 && value <= most_exact && value == std::floor(value); };
  if (!std::all_of(slot.begin(), slot.begin() + counters, counts)) return std::nullopt;
  if (!(length >= 0 && length <= static_cast<double>(slot.size() - head))) return std::nullopt;
  const std::span<const double> state = slot.subspan(head, static_cast<std::size_t>(length));
  if (sum != slot_checksum(slot.first(counters), state)) return std::nullopt;
  return CheckpointSlot{static_cast<long>(slot[0]),
                        {static_cast<long>(slot[1]), static_cast<std::size_t>(slot[2]), {state.begin(), state.end()}}};
}

}  // namespace railtab
