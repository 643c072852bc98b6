#pragma once

#include <array>
#include <string>
#include <vector>

#include "railtab/fmi/driven_track.hpp"

namespace railtab::fmi {

enum class Causality { input, output };

/// A variable of the FMU, a real number. Its value reference is its place in track_variables().
struct TrackVariable {
  std::string name, unit, description;
  Causality causality = Causality::input;
  double start = 0.0;  ///< of inputs
};

/// Per wheelset: x, then Y, Q, Mx of the left wheel and of the right one.
inline constexpr std::size_t inputs_per_wheelset = 7;
/// Per wheel: y, z, roll of the rail head, their rates, yaw and pitch.
inline constexpr std::size_t outputs_per_wheel = 8;
/// Per node of the structure: y, z and their accelerations.
inline constexpr std::size_t outputs_per_node = 4;

/// Inputs by wheelsets, front first; then outputs by wheels, left before right, and by nodes.
[[nodiscard]] std::vector<TrackVariable> track_variables(const DrivenTrack& track);

}  // namespace railtab::fmi
