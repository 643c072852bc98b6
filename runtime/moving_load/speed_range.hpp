#pragma once

#include <functional>
#include <vector>

#include "railtab/runtime/moving_load/static_deflection.hpp"
#include "railtab/runtime/moving_load/train_passage.hpp"

namespace railtab {

/// Speeds at which trains cross a deck [m/s].
struct SpeedRange {
  double low = 0.0, high = 0.0;
  std::vector<double> speeds;  ///< all of them; none: refined between low and high where the peaks are
};

/// A train on a deck over the speeds.
struct TrainResponse {
  std::size_t train = 0;               ///< index of the train
  StaticDeflection standing;           ///< under the train at rest
  std::vector<PassagePeaks> passages;  ///< by speed; none for a static load model
  /// The passage with the largest acceleration, displacement. @pre there are passages
  [[nodiscard]] const PassagePeaks& critical_acceleration() const;
  [[nodiscard]] const PassagePeaks& critical_displacement() const;
};

/// All trains over a deck, passages on `threads` threads; the same numbers on any number of them.
///
/// Without a list of speeds the critical ones of each train are sought, search_critical_speeds().
/// @param finished called with the share done, from any thread but not from two at a time; may be empty
[[nodiscard]] std::vector<TrainResponse> train_responses(const ModalDeck& deck, const std::vector<AxleTrain>& trains,
                                                         const SpeedRange& range, int threads,
                                                         const std::function<void(double)>& finished = {});

}  // namespace railtab
