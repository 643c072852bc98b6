#pragma once

#include <array>
#include <complex>

#include "railtab/runtime/moving_load/modal_force.hpp"

namespace railtab {

/// One mode within a piece: q(τ) = Re(z e^{λτ}) + d0 + d1 τ + d2 τ² + d3 τ³, (ML2).
class ModalMotion {
 public:
  ModalMotion() = default;
  /// @param omega > 0 [rad/s] @param damping 0 <= ζ < 1
  ModalMotion(double omega, double damping) noexcept;

  /// Continues the motion q0, q0′ under the force Σ F_j s^j, s = speed·τ.
  void begin(double q0, double dq0, const ModalForce::Cubic& force, double speed) noexcept;
  /// e^{λ·step}
  [[nodiscard]] std::complex<double> factor(double step) const noexcept;
  /// Moves to τ; `turned` is e^{λ(τ − τ before)}.
  void move(double tau, std::complex<double> turned) noexcept {
    z_ *= turned;
    tau_ = tau;
  }
  [[nodiscard]] std::complex<double> free_part() const noexcept { return z_; }
  [[nodiscard]] double q() const noexcept { return z_.real() + d_[0] + tau_ * (d_[1] + tau_ * (d_[2] + tau_ * d_[3])); }
  [[nodiscard]] double velocity() const noexcept {
    return lambda_.real() * z_.real() - lambda_.imag() * z_.imag() + d_[1] + tau_ * (2.0 * d_[2] + 3.0 * tau_ * d_[3]);
  }
  [[nodiscard]] double acceleration() const noexcept {
    return lambda2_.real() * z_.real() - lambda2_.imag() * z_.imag() + 2.0 * d_[2] + 6.0 * tau_ * d_[3];
  }
  /// d^k q/dτ^k, k = 0 … 4, at τ + ahead.
  [[nodiscard]] std::array<double, 5> derivatives(double ahead) const noexcept;

 private:
  std::complex<double> lambda_, lambda2_, z_;
  double omega2_ = 1.0, damping2_ = 0.0;  // ω², 2ζω
  std::array<double, 4> d_{};
  double tau_ = 0.0;
};

}  // namespace railtab
