#include "railtab/runtime/structure/beam_element.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace railtab {
namespace {

// places of (w_1, θ_1, w_2, θ_2) in the twelve dofs
constexpr int lateral[4] = {1, 5, 7, 11};   // y and yaw = dy/dx
constexpr int vertical[4] = {2, 4, 8, 10};  // z and pitch = -dz/dx

/// Bending matrices are written for θ = dw/dx; pitch has the opposite sign.
void add_bending(BeamMatrix& matrix, const int (&place)[4], const Eigen::Matrix4d& bending, double slope_sign) {
  const double sign[4] = {1.0, slope_sign, 1.0, slope_sign};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(place[i], place[j]) = sign[i] * sign[j] * bending(i, j);
  }
}

void add_linear(BeamMatrix& matrix, int place, double diagonal, double coupling) {
  matrix(place, place) = matrix(place + 6, place + 6) = diagonal;
  matrix(place, place + 6) = matrix(place + 6, place) = coupling;
}

}  // namespace

BeamMatrix beam_stiffness(const BeamSection& section, double L) {
  assert(L > 0);
  Eigen::Matrix4d bending;
  bending << 12, 6 * L, -12, 6 * L,         //
      6 * L, 4 * L * L, -6 * L, 2 * L * L,  //
      -12, -6 * L, 12, -6 * L,              //
      6 * L, 2 * L * L, -6 * L, 4 * L * L;
  bending /= L * L * L;
  BeamMatrix K = BeamMatrix::Zero();
  add_linear(K, 0, section.E * section.A / L, -section.E * section.A / L);
  add_linear(K, 3, section.GJ / L, -section.GJ / L);
  add_bending(K, lateral, section.E * section.Iz * bending, 1.0);
  add_bending(K, vertical, section.E * section.Iy * bending, -1.0);
  return K;
}

BeamMatrix beam_mass(const BeamSection& section, double L) {
  assert(L > 0);
  Eigen::Matrix4d bending;
  bending << 156, 22 * L, 54, -13 * L,        //
      22 * L, 4 * L * L, 13 * L, -3 * L * L,  //
      54, 13 * L, 156, -22 * L,               //
      -13 * L, -3 * L * L, -22 * L, 4 * L * L;
  bending *= section.mass * L / 420.0;
  BeamMatrix M = BeamMatrix::Zero();
  add_linear(M, 0, section.mass * L / 3, section.mass * L / 6);
  add_linear(M, 3, section.rotary_inertia * L / 3, section.rotary_inertia * L / 6);
  add_bending(M, lateral, bending, 1.0);
  add_bending(M, vertical, bending, -1.0);
  return M;
}

BeamShape beam_shape(double length, double s) noexcept {
  assert(length > 0 && s >= 0 && s <= length);
  const double t = s / length;
  const double value[4] = {1 - t * t * (3 - 2 * t), s * (1 - t) * (1 - t), t * t * (3 - 2 * t), -s * t * (1 - t)};
  const double slope_1 = 6 * t * (1 - t) / length;
  const double slope[4] = {-slope_1, (1 - t) * (1 - 3 * t), slope_1, t * (3 * t - 2)};
  BeamShape N = BeamShape::Zero();
  N(0, 0) = N(3, 3) = 1 - t;
  N(0, 6) = N(3, 9) = t;
  for (int i = 0; i < 4; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;  // pitch = -dz/dx
    N(1, lateral[i]) = value[i];
    N(5, lateral[i]) = slope[i];
    N(2, vertical[i]) = sign * value[i];
    N(4, vertical[i]) = -sign * slope[i];
  }
  return N;
}

RayleighDamping rayleigh_damping(double ratio, double omega_1, double omega_2) noexcept {
  assert(omega_1 > 0 && omega_2 > 0);
  return {2 * ratio * omega_1 * omega_2 / (omega_1 + omega_2), 2 * ratio / (omega_1 + omega_2)};
}

double simply_supported_frequency(const BeamSection& section, double length, int n) noexcept {
  const double wave_number = n * std::numbers::pi / length;
  return wave_number * wave_number * std::sqrt(section.E * section.Iy / section.mass);
}

}  // namespace railtab
