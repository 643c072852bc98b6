#include "railtab/runtime/moving_load/modal_motion.hpp"

#include <cmath>

namespace railtab {

ModalMotion::ModalMotion(double omega, double damping) noexcept
    : lambda_(-damping * omega, omega * std::sqrt(1.0 - damping * damping)),
      lambda2_(lambda_ * lambda_),
      omega2_(omega * omega),
      damping2_(2.0 * damping * omega) {}

void ModalMotion::begin(double q0, double dq0, const ModalForce::Cubic& force, double speed) noexcept {
  const double v = speed, c = damping2_;
  d_[3] = force[3] * v * v * v / omega2_;
  d_[2] = (force[2] * v * v - 3.0 * c * d_[3]) / omega2_;
  d_[1] = (force[1] * v - 2.0 * c * d_[2] - 6.0 * d_[3]) / omega2_;
  d_[0] = (force[0] - c * d_[1] - 2.0 * d_[2]) / omega2_;
  const double re = q0 - d_[0];
  z_ = {re, (lambda_.real() * re - (dq0 - d_[1])) / lambda_.imag()};
  tau_ = 0.0;
}

std::complex<double> ModalMotion::factor(double step) const noexcept {
  return std::polar(std::exp(lambda_.real() * step), lambda_.imag() * step);
}

std::array<double, 5> ModalMotion::derivatives(double ahead) const noexcept {
  std::complex<double> z = z_ * factor(ahead);
  const double t = tau_ + ahead;
  std::array<double, 5> result{d_[0] + t * (d_[1] + t * (d_[2] + t * d_[3])),
                               d_[1] + t * (2.0 * d_[2] + 3.0 * t * d_[3]), 2.0 * d_[2] + 6.0 * t * d_[3], 6.0 * d_[3],
                               0.0};
  for (double& value : result) {
    value += z.real();
    z *= lambda_;
  }
  return result;
}

}  // namespace railtab
