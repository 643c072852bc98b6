#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {
namespace {

constexpr double longest_track = 1e4, longest_span = 1e3;  // [m]: more than any run needs
constexpr double shortest_span = 0.5;                      // [m]: as of an imported deck

void check_support(const std::string& place, const SupportParameters& support) {
  require_positive(place + ".kx", support.kx, "N/m");
  require_positive(place + ".ky", support.ky, "N/m");
  require_positive(place + ".kz", support.kz, "N/m");
  require_not_negative(place + ".cx", support.cx, "N s/m");
  require_not_negative(place + ".cy", support.cy, "N s/m");
  require_not_negative(place + ".cz", support.cz, "N s/m");
}

void check_rail(const RailBeamParameters& rail) {
  require_positive("track.rail.E", rail.E, "Pa");
  require_positive("track.rail.A", rail.A, "m²");
  require_positive("track.rail.Iy", rail.Iy, "m⁴");
  require_positive("track.rail.Iz", rail.Iz, "m⁴");
  require_positive("track.rail.GJ", rail.GJ, "N m²");
  require_between("track.rail.warping_length", rail.warping_length, 0.02, 2.0, "m");
  require_positive("track.rail.mass", rail.mass, "kg/m");
  require_positive("track.rail.rotary_inertia", rail.rotary_inertia, "kg m²/m");
  require_positive("track.rail.height", rail.height, "m");
  require_positive("track.rail.head_height", rail.head_height, "m");
  require_between("track.rail.head_height", rail.head_height, 0.0, rail.height, "m");
  require_not_negative("track.rail.mass_damping", rail.mass_damping, "1/s");
  require_not_negative("track.rail.stiffness_damping", rail.stiffness_damping, "s");
}

void check_sleeper(const SleeperParameters& sleeper) {
  require_positive("track.sleeper.mass", sleeper.mass, "kg");
  require_positive("track.sleeper.Jx", sleeper.Jx, "kg m²");
  require_positive("track.sleeper.Jy", sleeper.Jy, "kg m²");
  require_positive("track.sleeper.Jz", sleeper.Jz, "kg m²");
  require_positive("track.sleeper.height", sleeper.height, "m");
}

}  // namespace

void TrackParameters::validate() const {
  check_rail(rail);
  check_sleeper(sleeper);
  require_between("track.sleeper_spacing", sleeper_spacing, 0.05, 10.0, "m");
  require_between("track.half_rail_distance", half_rail_distance, 0.25, 1.1, "m");
  require_between("track.elements_per_bay", elements_per_bay, 0, 20, "-");
  require_positive("track.length_before", length_before, "m");
  require_between("track.length_before", length_before, 0.0, longest_track, "m");
  require_positive("track.length_after", length_after, "m");
  require_between("track.length_after", length_after, 0.0, longest_track, "m");
  check_support("track.pad", pad);
  require_positive("track.pad_roll_stiffness", pad_roll_stiffness, "N m/rad");
  require_not_negative("track.pad_roll_damping", pad_roll_damping, "N m s/rad");
  require_between("track.half_ballast_distance", half_ballast_distance, 0.1, 3.0, "m");
  check_support("track.ballast_ground", ballast_ground);
  check_support("track.ballast_deck", ballast_deck);
}

void BridgeParameters::validate() const {
  require_between("bridge.length", length, shortest_span, longest_span, "m");
  require_positive("bridge.E", E, "Pa");
  require_positive("bridge.G", G, "Pa");
  require_positive("bridge.A", A, "m²");
  require_positive("bridge.Iy", Iy, "m⁴");
  require_positive("bridge.Iz", Iz, "m⁴");
  require_positive("bridge.J", J, "m⁴");
  require_positive("bridge.mass", mass, "kg/m");
  require_positive("bridge.rotary_inertia", rotary_inertia, "kg m²/m");
  require_between("bridge.damping_ratio", damping_ratio, 0.0, 0.5, "-");
  if (elements < 2 || elements > 1000 || elements % 2 != 0) {
    throw input_error("bridge.elements", fmt::format("{}", elements), "an even number from 2 to 1000");
  }
  require_between("bridge.axis_depth", axis_depth, -100.0, 100.0, "m");
  require_between("bridge.track_offset", track_offset, -100.0, 100.0, "m");
}

}  // namespace railtab
