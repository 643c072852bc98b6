#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "railtab/runtime/contact/rolling_radius_difference.hpp"

namespace railtab {

/// Rolling radius difference Δr (right minus left) over the lateral shift of a wheelset, straight between samples.
///
/// Invariant: at least two samples, y strictly increasing, all finite.
class RadiusDifferenceCurve {
 public:
  /// @throws InputError naming the sample that breaks the invariant
  RadiusDifferenceCurve(std::vector<double> y, std::vector<double> radius_difference);
  explicit RadiusDifferenceCurve(std::span<const WheelsetContact> contacts);

  [[nodiscard]] const std::vector<double>& y() const noexcept { return y_; }                           ///< [m]
  [[nodiscard]] const std::vector<double>& radius_difference() const noexcept { return difference_; }  ///< [m]

  /// Δr at y, which must lie within the samples [m].
  [[nodiscard]] double at(double y) const noexcept;
  /// ∫ Δr dy from the first sample to y [m²]; exact for the straight lines.
  [[nodiscard]] double integral(double y) const noexcept;

 private:
  [[nodiscard]] std::size_t interval(double y) const noexcept;

  std::vector<double> y_, difference_, integral_;
};

enum class ConicityStatus : std::uint8_t {
  found,
  outside,  ///< the wave would leave the range of the samples
  no_wave,  ///< no closed wave of this amplitude: Δr does not drive the wheelset back (negative conicity)
};

struct EquivalentConicity {
  double tan_gamma = 0.0;            ///< equivalent conicity tan γe [-]; NaN unless found
  double y_low = 0.0, y_high = 0.0;  ///< ends of the wave [m]: y_high − y_low = 2·amplitude
  ConicityStatus status = ConicityStatus::outside;
};

/// Equivalent conicity [EN15302]: that of the coned wheelset whose kinematic wave has the same wavelength.
///
/// The kinematic motion is y'' = −Δr(y)/(e r0) along the track (e: distance of the contact points, r0: radius). A
/// wave of amplitude ŷ runs between the two ends, 2ŷ apart, at which ∫Δr dy is the same; of several such waves the
/// one whose middle is nearest to y = 0. With its wavelength λ, tan γe = (π/λ)²·2 e r0, in which e r0 cancels. The
/// integral over the wave is exact for the curve's straight lines.
/// @param amplitude ŷ [m], > 0
[[nodiscard]] EquivalentConicity conicity_of_wave(const RadiusDifferenceCurve& curve, double amplitude) noexcept;

/// The simpler method: half the slope of the straight line fitted to Δr by least squares over the same wave. Where no
/// wave exists, over ±ŷ about the zero of Δr nearest to y = 0, with the status that the wave has; tan_gamma is then
/// finite, and negative for negative conicity.
[[nodiscard]] EquivalentConicity conicity_of_regression(const RadiusDifferenceCurve& curve, double amplitude) noexcept;

}  // namespace railtab
