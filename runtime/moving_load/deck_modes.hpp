#pragma once

#include "railtab/runtime/moving_load/modal_deck.hpp"

namespace railtab {

/// The first and the third mode that bend a deck, or the last of fewer: those in which the mean over the deck's width
/// moves vertically by a third at least of the largest displacement. Twist and lateral bending do not.
struct BendingModes {
  int first = 0, third = 0;
  int found = 0;  ///< how many there are, 3 at most
};
/// @param share of each mode: the largest vertical motion, mean over the width, over its largest displacement anywhere
[[nodiscard]] BendingModes bending_modes(const Eigen::ArrayXd& share);

/// @param omega rising [rad/s]
[[nodiscard]] int count_dynamic_modes(const Eigen::ArrayXd& omega, const BendingModes& bending,
                                      const DynamicModes& modes);

/// Where the largest motions are sought: the line in even intervals, then other places with their shapes, places ×
/// modes.
void set_points(int intervals, const Eigen::MatrixXd& other_shapes, const std::vector<double>& other_x,
                ModalDeck& deck);

}  // namespace railtab
