#pragma once

namespace railtab {

/// Which contact forces stand in Eq. 12.
enum class ContactForceRule {
  endpoint,  ///< those at the end of the step, as in the published method; a Hertz spring gains or loses energy
  energy,    ///< such that each step has their mean over the step's path: a Hertz spring keeps its energy
};

/// HHT-alpha time integration [HHT1977]: M a'' + (1+α)R(t+Δt) − αR(t) = (1+α)F(t+Δt) − αF(t) (Eq. 12);
/// α = 0 is Newmark's average acceleration [Newmark1959].
///
/// With the predictors of one step, displacement ã and velocity ṽ, the motion at t+Δt is
///   a = ã + Δ,  v = ṽ + velocity_rate·Δ,  a'' = acceleration_rate·Δ.
struct HhtScheme {
  double alpha = 0.0;      ///< -1/3..0
  double time_step = 0.0;  ///< [s]
  ContactForceRule contact_force = ContactForceRule::endpoint;

  [[nodiscard]] constexpr double beta() const noexcept { return 0.25 * (1.0 - alpha) * (1.0 - alpha); }
  [[nodiscard]] constexpr double gamma() const noexcept { return 0.5 - alpha; }
  [[nodiscard]] constexpr double load_weight() const noexcept { return 1.0 + alpha; }
  [[nodiscard]] constexpr double velocity_rate() const noexcept { return gamma() / (beta() * time_step); }
  [[nodiscard]] constexpr double acceleration_rate() const noexcept { return 1.0 / (beta() * time_step * time_step); }
};

}  // namespace railtab
