#pragma once

#include <span>
#include <vector>

#include "railtab/runtime/measures/low_pass_bank.hpp"
#include "railtab/runtime/measures/running_extremes.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Extremes of all that is followed on a structure's decks (StructureModel::deck), over every step of a run; besides
/// the channels themselves the vertical acceleration of the deck's nodes, as it is and low-passed (LowPassBank).
/// Memory does not grow with the run.
class DeckEnvelope {
 public:
  /// @param cut_off [Hz] @param step [s] @pre samples_fast_enough(cut_off, step); the model outlives the envelope
  DeckEnvelope(const VsiModel& model, double cut_off, double step);

  /// Where quantities are followed: ResultHeader::deck.
  [[nodiscard]] std::vector<DeckPlaces> places() const;
  /// The state after a step, and the initial one; each once, in order.
  void add(const VsiState& state);
  /// After the last one: the extremes, in the order of places().
  [[nodiscard]] std::vector<DeckExtremes> finish();

  /// For checkpoints: appended to a state, and taken from it. @throws InputError where they are another deck's
  void pack(std::vector<double>& numbers) const;
  void unpack(std::span<const double> numbers);
  /// Most numbers that pack() appends.
  [[nodiscard]] std::size_t capacity() const noexcept;

 private:
  /// Channels of one quantity.
  struct Group {
    DeckQuantity quantity;
    std::size_t first, count;
  };
  [[nodiscard]] DeckExtremes extremes(const RunningExtremes& of, const Group& group) const;
  [[nodiscard]] const DeckChannels& deck() const noexcept { return model_.structure->deck; }

  const VsiModel& model_;
  double step_;
  std::vector<Group> groups_;
  Group nodes_{};              // the vertical displacements
  std::vector<int> unknowns_;  // of the channels
  Eigen::VectorXd values_, acceleration_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> node_rows_;
  long samples_ = 0;
  RunningExtremes value_extremes_, raw_, filtered_;
  LowPassBank low_pass_;
};

/// How many numbers at the end of a checkpoint's are those of an envelope. @throws InputError where there are none
[[nodiscard]] std::size_t packed_envelope(std::span<const double> numbers);

}  // namespace railtab
