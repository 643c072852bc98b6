#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "railtab/tablegen/contact_elements.hpp"
#include "railtab/tablegen/ellipse_of_pressure.hpp"

namespace railtab {

/// A connected part of the contact area.
struct ContactBand {
  int elements = 0;
  double area = 0.0;                                ///< [m²]
  double normal_force = 0.0;                        ///< ∫ p dA [N]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< ∫ p n dA, on the rail, track axes [N]
  double largest_pressure = 0.0;                    ///< [Pa]
  // Centre of pressure: means of x and of the arc lengths on rail and wheel, weighted by pressure.
  double x = 0.0;  ///< relative to the wheelset centre [m]
  double s_rail = 0.0, y_rail = 0.0, z_rail = 0.0;
  double s_wheel = 0.0, y_wheel = 0.0, z_wheel = 0.0;
  double rolling_radius = 0.0;  ///< nominal radius + z_wheel [m]
  double angle = 0.0;           ///< contact angle: that of the band's force [rad]
  PressureMoments moments;      ///< of elements whose pressure is constant
  /// Ellipse that rolls as the area does (EllipseOfPressure). A yawed wheel's is sheared, x = skew·s + ...; a is its
  /// semi-axis along x at one s, so that π a b is its area [m].
  double a = 0.0, b = 0.0;
  double skew = 0.0;                                            ///< ⟨x s⟩/⟨s²⟩ [-]
  double x_low = 0.0, x_high = 0.0, s_low = 0.0, s_high = 0.0;  ///< extent of its elements [m]
};

/// The bands of a pressure in increasing s: elements with pressure that touch, also at a corner, are of one band.
/// @param band set to the place of each element's band, −1 without pressure
[[nodiscard]] std::vector<ContactBand> contact_bands(const WheelRailPair& pair, const ContactElements& elements,
                                                     const Eigen::VectorXd& pressure, std::vector<int>& band);

}  // namespace railtab
