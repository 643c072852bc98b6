#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace railtab {

/// Quantities that are followed all over a deck.
enum class DeckQuantity {
  displacement,         ///< vertical, down, of every node of the deck, and of a built-in one under the track [m]
  roll,                 ///< about the track's direction, between the two sides of the ballast [rad]
  twist,                ///< change of the cross level over 3 m from x on, over a gauge of 1.435 m [m]
  end_rotation,         ///< of the ends about the lateral axis [rad]
  horizontal_rotation,  ///< of the ends about the vertical axis [rad]
  joint_step,           ///< vertical offset of an end against the next deck or the ground, under the ballast [m]
  joint_gap,            ///< longitudinal, likewise [m]
  bending_moment,       ///< about the lateral axis of a section, positive: sagging [N m]
  shear_force,          ///< vertical, of a section: positive where what is behind it presses down on what is before [N]
};
[[nodiscard]] std::string_view quantity_name(DeckQuantity quantity) noexcept;  ///< "displacement", "end_rotation", …
[[nodiscard]] std::string_view quantity_unit(DeckQuantity quantity) noexcept;  ///< SI

/// One of them at one place.
struct DeckChannel {
  DeckQuantity quantity = DeckQuantity::displacement;
  double x = 0.0, y = 0.0;  ///< along the track, right of its centre [m]
};

/// All that is followed of a structure's decks, linear in the degrees of freedom u: R u. What the translations of
/// supports add is StructureSupports::carried_deck.
struct DeckChannels {
  std::vector<DeckChannel> channel;                   ///< those of one quantity follow each other
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows;  ///< R, channels × dofs
};

/// Whether a model gets channels: they take time and memory where nobody asks for them.
enum class DeckRecord { named_nodes, everywhere };

/// A sum of degrees of freedom with factors; support_dof() stands for translations of supports.
using DofSum = std::vector<std::pair<int, double>>;
/// Adds factor·sum to `to`.
void add_sum(const DofSum& sum, double factor, DofSum& to);

/// A channel under assembly.
struct DeckRow {
  DeckChannel at;
  DofSum sum;
};

}  // namespace railtab
