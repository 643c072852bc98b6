#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>
#include <vector>

#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {

/// A deck by its modes. With w(x, t) = Σ φ_n(x) q_n(t), downwards, and modes normalised to a modal mass of 1 kg,
///   q_n″ + 2 ζ_n ω_n q_n′ + ω_n² q_n = F_n,   F_n = Σ_k P_k φ_n(x_k)                                       (ML1)
/// under axle loads P_k at x_k. The shapes along the line on which the axles stand are cubics in each of its elements:
/// φ_n(x) = Σ_j c_nj u^j, u = x − knots[e] [kg^-1/2].
struct ModalDeck {
  using Cubics = Eigen::Array<double, Eigen::Dynamic, 4>;

  std::string name;
  double start = 0.0;         ///< place of x = 0 along the track [m]
  std::vector<double> knots;  ///< from 0 to the deck's length [m], rising
  std::vector<Cubics> shape;  ///< of each element, modes × 4: c_n0 … c_n3
  /// Circular natural frequencies, rising [rad/s]. Shapes of residual flexibility beyond `known_modes` have that of the
  /// last mode.
  Eigen::ArrayXd omega;
  Eigen::ArrayXd damping;              ///< ratios of critical, 0 <= ζ < 1
  int first_bending = 0;               ///< number of the first mode that bends the deck (BendingModes)
  int third_bending = 0;               ///< of the third, or the last of fewer
  bool third_bending_unknown = false;  ///< fewer among the modes, which are not all that the deck has
  int known_modes = 0;                 ///< the first of them, natural modes
  int dynamic_modes = 0;               ///< the first of them, that vibrate; the others deflect as at rest
  /// Where the largest motions are sought: along the line first, evenly spaced, then places of an imported deck.
  std::vector<double> point_x;   ///< [m]
  Eigen::MatrixXd point_shape;   ///< points × modes [kg^-1/2]
  int points_on_line = 0;        ///< the first of them
  Eigen::ArrayXd largest_shape;  ///< of each mode over line and points, amounts [kg^-1/2]

  [[nodiscard]] double length() const noexcept { return knots.back(); }
  [[nodiscard]] int modes() const noexcept { return static_cast<int>(omega.size()); }
  [[nodiscard]] double frequency(int mode) const { return omega[mode] / (2.0 * std::numbers::pi); }  ///< [Hz]
  /// Of the first bending mode [Hz].
  [[nodiscard]] double first_frequency() const { return frequency(first_bending); }
  /// Up to which accelerations count [Hz], by the first and third bending mode. [EN1990A2, A2.4.4.2.1]
  [[nodiscard]] double cut_off() const noexcept;
  /// φ (derivative 0), dφ/dx (1) or d²φ/dx² (2) of all modes at 0 <= x <= length.
  [[nodiscard]] Eigen::ArrayXd shape_at(double x, int derivative = 0) const;
};

/// A sentence where the cut-off does without the third bending mode because that is not known; else empty.
[[nodiscard]] std::string doubtful_cut_off(const ModalDeck& deck);

/// Which modes vibrate.
struct DynamicModes {
  int count = 0;  ///< 0: all up to ModalDeck::cut_off()
};

/// A simply supported span, frequencies (nπ/L)² √(EI/m) and shapes √(2/(mL)) sin(nπx/L); the
/// same damping ratio for all modes. Cubics meet the sines in value and slope at their knots and are within 4e-6 of the
/// amplitude of those of modes that vibrate. 25 modes at least: their static deflection is within 1e-5 of the beam's.
/// Under a track beside the axis at e, twist is added: nπ/L √(GJ/J_ρ) and e √(2/(J_ρ L)) sin(nπx/L), J_ρ the rotary
/// inertia per length. Not of the track: add its mass.
/// @throws InputError naming the key
[[nodiscard]] ModalDeck simply_supported_deck(const BridgeParameters& span, const DynamicModes& modes = {});

/// The deck of an imported bridge under forces on the track's centre line, between its first and last deck node; modes
/// and their damping φᵀCφ/(2ω) from its matrices, the supports at rest. At rest the deck deflects by K⁻¹ under forces
/// at 49 even places of the line, beyond the modes by shapes of residual flexibility; a structure by modes has none of
/// these. Sought are the line and all nodes of the deck.
/// @throws InputError, ComputationError
[[nodiscard]] ModalDeck imported_deck(const ImportParameters& parameters, const DynamicModes& modes = {});

/// Whether an end of the line moves in a mode that vibrates: an axle load that comes on to the deck there acts at once.
[[nodiscard]] bool has_free_end(const ModalDeck& deck);
/// By how much 1 N that comes on to an end of the deck accelerates its line at x at once: the larger amount of both
/// ends, |Σ φ_n(end) φ_n(x)| over modes that vibrate [1/kg]; 0 without free ends. @pre 0 <= x <= length
[[nodiscard]] double sudden_acceleration(const ModalDeck& deck, double x);

/// Element of the line that holds x, clamped to the line.
[[nodiscard]] std::size_t element_at(const ModalDeck& deck, double x) noexcept;

}  // namespace railtab
