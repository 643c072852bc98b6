#pragma once

#include <array>
#include <vector>

#include "railtab/runtime/moving_load/axle_train.hpp"
#include "railtab/runtime/moving_load/modal_deck.hpp"

namespace railtab {

/// The modal forces of a train on a deck, F_n(s) = Σ P_k φ_n(s − behind_k), as cubics of the distance s that its first
/// axle has come from x = 0, the same at all speeds. A new piece begins wherever an axle passes an end of the deck or
/// another place at which shapes have a kink, and after an element's length at the latest; the cubic has the force's
/// value and slope at both ends of its piece and is as near to it as the cubics of the shapes are to the modes.
struct ModalForce {
  using Cubic = std::array<double, 4>;
  int modes = 0;              ///< the deck's dynamic ones
  std::vector<double> start;  ///< of each piece [m], and the end of the last one
  std::vector<Cubic> cubic;   ///< [piece·modes + mode]: F = Σ c_j (s − start)^j [N kg^-1/2]
  /// What the deck's other modes do without inertia, likewise:
  int others = 0;
  std::vector<Cubic> other;                      ///< [piece·others + mode]: q = F/ω² [m kg^1/2]
  std::vector<double> other_bound;               ///< of each piece: bound of Σ |q| times the mode's largest shape [m]
  std::vector<std::array<Cubic, 2>> other_turn;  ///< of each piece: ∂w/∂x at x = 0 and at the deck's length
  [[nodiscard]] std::size_t pieces() const noexcept { return start.size() - 1; }
};
[[nodiscard]] ModalForce modal_force(const ModalDeck& deck, const AxleTrain& train);

/// The forces of all modes with the first axle at s [m], in the same units.
[[nodiscard]] Eigen::ArrayXd modal_force_at(const ModalDeck& deck, const AxleTrain& train, double s);

}  // namespace railtab
