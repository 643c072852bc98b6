#pragma once

#include "railtab/runtime/moving_load/modal_deck.hpp"

namespace railtab {

/// The first and the third mode that bend a deck under its axles, or the last of fewer: those that move the line of the
/// axles by a tenth at least of their largest displacement. Twist about the line and lateral bending do not.
struct BendingModes {
  int first = 0, third = 0;
};
/// @param share of each mode: its largest vertical motion on the line over its largest displacement anywhere [-]
[[nodiscard]] BendingModes bending_modes(const Eigen::ArrayXd& share);

/// @param omega rising [rad/s]
[[nodiscard]] int count_dynamic_modes(const Eigen::ArrayXd& omega, const BendingModes& bending,
                                      const DynamicModes& modes);

/// Where the largest motions are sought: the line in even intervals, then other places with their shapes, places ×
/// modes.
void set_points(int intervals, const Eigen::MatrixXd& other_shapes, const std::vector<double>& other_x,
                ModalDeck& deck);

}  // namespace railtab
