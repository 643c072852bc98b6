#pragma once

#include "railtab/runtime/moving_load/modal_force.hpp"

namespace railtab {

/// A largest amount over deck and time.
struct DeckPeak {
  double value = 0.0;  ///< amount, >= 0 [m] or [m/s²]
  double x = 0.0;      ///< on the deck [m]
  double time = 0.0;   ///< since the first axle came on to the deck [s]
};

/// What one passage of a train does to a deck.
struct PassagePeaks {
  double speed = 0.0;     ///< [m/s]
  DeckPeak acceleration;  ///< of the modes that vibrate, without filter
  DeckPeak displacement;  ///< of all modes, those that do not vibrate without inertia
  DeckPeak end_rotation;  ///< of the line's ends about the lateral axis [rad], likewise; of the samples
};

/// A train crosses a deck at rest at constant speed. In each piece of ModalForce the solution of (ML1) is known,
///   q_n(τ) = Re(z_n e^{λ_n τ}) + Σ_j d_nj τ^j,   λ = −ζω + iω√(1 − ζ²),                                  (ML2)
/// with the polynomial's coefficients d from those of the force; z continues q and q′ and so holds the free vibration
/// that all axles which have gone have left. There is no time step whose error would count: samples, at least 16 in the
/// shortest period, serve to find the peaks, which Newton iteration on the solution, in time and along the line, then
/// takes to their tops. (On a deck with a free end accelerations jump as axles come and go: there the peaks are those
/// of 64 samples in the shortest period.) After the last axle the vibration is followed until its envelope is below the
/// peaks found, for 50 periods of the first mode at most. Cost: pieces × modes exponentials, and the shapes at all
/// points where the modes' amplitudes could exceed the peak.
/// @param force that of the train on this deck @pre speed > 0 [m/s]
[[nodiscard]] PassagePeaks train_passage(const ModalDeck& deck, const ModalForce& force, double speed);

}  // namespace railtab
