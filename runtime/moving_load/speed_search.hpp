#pragma once

#include "railtab/runtime/moving_load/train_passage.hpp"

namespace railtab {

/// Passages of a train between two speeds [m/s], by speed, among them those with its largest acceleration and
/// displacement; at most 25. Begins with five even speeds, both ends with them. Then the response over the speed is
/// estimated as the resonance curve, together with the least response found so that it has no zeros, times a factor
/// that is linear between the passages and makes it exact at them; the next passage is where the estimate, raised by up
/// to 5 % with the distance from the next known speed, is highest. Ends where that is below 1.002 times the largest
/// found.
[[nodiscard]] std::vector<PassagePeaks> search_critical_speeds(const ModalDeck& deck, const AxleTrain& train,
                                                               double low, double high);

}  // namespace railtab
