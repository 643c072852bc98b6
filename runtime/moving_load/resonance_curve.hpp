#pragma once

#include <vector>

#include "railtab/runtime/moving_load/modal_force.hpp"

namespace railtab {

/// Free vibration that the axles of a train leave, over its speed: of each mode the amplitude g_n(v) that one axle of
/// 1 N leaves, times the largest sum of the first K axles, |Σ_k P_k e^{λ_n (t_K − t_k)}|, times the largest φ_n (and
/// ω_n²); summed over the modes. Its peaks are the resonances of the train. One speed costs a small part of a passage.
struct ResonanceCurve {
  std::vector<double> speed;         ///< even steps of 1/v, rising [m/s]
  std::vector<double> acceleration;  ///< [m/s²]
  std::vector<double> displacement;  ///< [m]
};
/// Six speeds at least in each period of the fastest beat, 1/v = 1/(f·reach), of modes that vibrate; 100 to 3000 in
/// all.
/// @pre 0 < low < high [m/s]
[[nodiscard]] ResonanceCurve resonance_curve(const ModalDeck& deck, const AxleTrain& train, double low, double high);

}  // namespace railtab
