#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// A motion of the vehicle on standing wheelsets, without gyroscopic moments.
struct VehicleMode {
  double frequency;    ///< |λ|/2π [Hz]: natural frequency, with damping below 1 above the one that is seen
  double damping;      ///< −Re λ/|λ|; 1: no oscillation, a decay with the time constant 1/|λ|
  std::string motion;  ///< after the body with the most kinetic energy: "car body bounce", "bogie pitch, in phase"
};

/// Eigenvalues λ of M ü + C u̇ + K u = 0 with the wheelsets held, in the order of |λ|. Of a pair of complex ones the one
/// with positive imaginary part. Rows without mass (dampers in series with a stiffness) add no motion of their own.
/// Car body: "lower sway" turns about a point below its centre of gravity, "upper sway" about one above.
/// @param count at most, >= 0
[[nodiscard]] std::vector<VehicleMode> natural_modes(const VehicleModel& vehicle, int count);

/// Eigenvalues λ and shapes of M ü + C u̇ + K u = 0 of some rows, the others held; matrices need not be symmetric. Rows
/// without mass need damping.
struct MotionSpectrum {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd shapes;  ///< displacements of the rows with mass, one column per value
};
[[nodiscard]] MotionSpectrum motion_spectrum(const VehicleModel& vehicle, const std::vector<int>& rows);
/// Its values alone.
[[nodiscard]] Eigen::VectorXcd motion_eigenvalues(const VehicleModel& vehicle, const std::vector<int>& rows);

}  // namespace railtab
