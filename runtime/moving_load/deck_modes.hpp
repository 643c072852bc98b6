#pragma once

#include "railtab/runtime/moving_load/modal_deck.hpp"

namespace railtab {

/// Up to which deck accelerations count, from the first and third frequency; all [Hz]. [EN1990A2, A2.4.4.2.1]
[[nodiscard]] double cut_off_frequency(double first, double third) noexcept;

/// @param omega rising [rad/s]
[[nodiscard]] int count_dynamic_modes(const Eigen::ArrayXd& omega, const DynamicModes& modes);

/// Where the largest motions are sought: the line in even intervals, then other places with their shapes, places ×
/// modes.
void set_points(int intervals, const Eigen::MatrixXd& other_shapes, const std::vector<double>& other_x,
                ModalDeck& deck);

}  // namespace railtab
