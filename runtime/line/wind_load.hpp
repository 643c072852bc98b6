#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "railtab/runtime/line/body_load.hpp"

namespace railtab {

/// Aerodynamic coefficients of a vehicle over the yaw angle of the wind that it meets, as wind tunnels give them
/// (EN 14067-6): F = C A ρv²/2 and M = C A ℓ ρv²/2 at the middle of the vehicle on the track's axis, at the rail-head
/// tops. For wind from the left, axes x forward, y right, z down; wind from the right is its mirror image.
struct Aerodynamics {
  std::string source;                       ///< file, for messages
  double area = 10.0;                       ///< A [m²]
  double length = 3.0;                      ///< ℓ [m]
  std::vector<double> yaw;                  ///< strictly increasing from 0, to at most π [rad]
  std::vector<ForceAndMoment> coefficient;  ///< at these; C_Fx and whatever has no column are 0

  /// Linear between the angles. @pre 0 <= angle <= yaw.back()
  [[nodiscard]] ForceAndMoment at(double angle) const noexcept;
};

/// Read coefficients: columns yaw[deg] or [rad], then any of C_Fy, C_Fz, C_Mx, C_My, C_Mz, each [1] or [-]
/// (docs/file_formats/histories.md). @throws InputError with file and line
[[nodiscard]] Aerodynamics read_aerodynamics(const std::filesystem::path& file);

/// Wind over the ground.
struct Wind {
  double direction = 0.0;  ///< where it comes from, from the direction of travel to the left, −π to π [rad]
  double density = 1.225;  ///< ρ of the air [kg/m³]
};

/// The yaw angle of the wind that a train meets, −π to π, and its speed [m/s].
struct RelativeWind {
  double yaw, speed;
};
/// @param train_speed, wind_speed [m/s]
[[nodiscard]] RelativeWind relative_wind(const Wind& wind, double train_speed, double wind_speed) noexcept;

/// Quasi-steady force and moment at a point `height` above the rail-head tops. @pre the yaw angle is in the table
[[nodiscard]] ForceAndMoment wind_load(const Aerodynamics& vehicle, const Wind& wind, double train_speed,
                                       double wind_speed, double height) noexcept;

/// Speed of the wind over time or over the position of the vehicle, linear between the points.
struct WindHistory {
  LoadArgument argument = LoadArgument::time;
  std::vector<double> points, speed;  ///< [s] or [m], [m/s]
};
/// Read a history of wind: columns t[s] or x[m], and U in [m/s] or [km/h], 0 to 200 m/s. @throws InputError
[[nodiscard]] WindHistory read_wind_history(const std::filesystem::path& file, double start = 0.0);
/// The same history with points at these times or positions too. @param at increasing
[[nodiscard]] WindHistory with_points(WindHistory history, const std::vector<double>& at);
/// A speed that rises and falls with one_minus_cosine().
[[nodiscard]] WindHistory wind_gust(double peak, double start, double duration);

/// The load of a history of wind, as straight lines that are off by at most 1e-4 of the largest load.
/// @param train_speed [m/s] at a point of the history
/// @throws InputError where a yaw angle lies beyond the coefficients
[[nodiscard]] LoadHistory wind_load_history(const Aerodynamics& vehicle, const Wind& wind, const WindHistory& history,
                                            const std::function<double(double)>& train_speed, double height);

}  // namespace railtab
