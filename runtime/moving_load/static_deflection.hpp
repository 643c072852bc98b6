#pragma once

#include "railtab/runtime/moving_load/axle_train.hpp"
#include "railtab/runtime/moving_load/modal_deck.hpp"

namespace railtab {

struct StaticDeflection {
  double value = 0.0;  ///< amount, >= 0 [m]
  double x = 0.0;      ///< on the deck [m]
  double front = 0.0;  ///< of the first axle from x = 0 [m]
};

/// Largest deflection under a train or load model that stands anywhere on the deck, by all modes of the deck.
[[nodiscard]] StaticDeflection largest_static_deflection(const ModalDeck& deck, const AxleTrain& train);

}  // namespace railtab
