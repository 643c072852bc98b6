#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// A spring-damper layer: stiffness and viscous damping along x, y, z of one piece of it.
struct SupportParameters {
  double kx, ky, kz;  ///< [N/m], > 0
  double cx, cy, cz;  ///< [N s/m], >= 0
  bool operator==(const SupportParameters&) const = default;
};

/// One rail as an Euler–Bernoulli beam that twists and warps; the defaults are 60E1 (EN 13674-1).
struct RailBeamParameters {
  double E = 210e9;               ///< [Pa]
  double A = 76.70e-4;            ///< [m²]
  double Iy = 3038e-8;            ///< vertical bending [m⁴]
  double Iz = 512e-8;             ///< lateral bending [m⁴]
  double GJ = 195.87e3;           ///< torsional stiffness [N m²]; published for CHN60, a rail of the same size
  double warping_length = 0.135;  ///< λ = √(E I_ω/GJ) [m]; that of the section's outline (docs/theory/structure.md)
  double mass = 60.21;            ///< [kg/m]
  double rotary_inertia = 0.279;  ///< about x [kg m²/m]: steel's density times (Iy + Iz)
  double height = 0.172;          ///< rail-head top to rail foot [m]
  double head_height = 0.0911;    ///< rail-head top above the centroid [m], < height
  double mass_damping = 0.0;      ///< Rayleigh, times M [1/s]
  double stiffness_damping = 2e-6;  ///< Rayleigh, times K [s]: 0.6 % of critical at 1 kHz
  bool operator==(const RailBeamParameters&) const = default;
};

/// Rigid sleeper with six dofs. Inertia defaults: a homogeneous bar 2.5 m × 0.26 m × 0.20 m.
struct SleeperParameters {
  double mass = 251.0;   ///< [kg] [Zhai2004]
  double Jx = 131.0;     ///< [kg m²]
  double Jy = 2.25;      ///< [kg m²]
  double Jz = 132.0;     ///< [kg m²]
  double height = 0.20;  ///< [m]; its centre of gravity at half of it
  bool operator==(const SleeperParameters&) const = default;
};

/// Whether rails move along x, and sleepers along x, in pitch and in yaw. No force of a run acts along x on the track:
/// these motions follow the rails' bending alone, through springs at the arm of the rail's foot. Left out, they are
/// held, pads have no spring along x, and the ballast on a deck none and no damper.
enum class LongitudinalMotion {
  automatic,  ///< left out where that changes the rail heads' compliance by at most 1 % (longitudinal_change())
  kept,
  left_out,
};

/// Ballasted track: two rails on pads on rigid sleepers on ballast. Default sources: vertical values [Zhai2004],
/// lateral values of an open vehicle–track data set for the CHN60 track; longitudinal taken equal to lateral.
struct TrackParameters {
  RailBeamParameters rail;
  SleeperParameters sleeper;
  double sleeper_spacing = 0.6;      ///< [m]
  double half_rail_distance = 0.75;  ///< track centre to rail-head centre [m]
  int elements_per_bay = 0;          ///< rail elements between sleepers, 1..20; 0: two
  LongitudinalMotion longitudinal = LongitudinalMotion::automatic;
  double length_before = 60.0;  ///< track before x = 0 [m]; rounded up to whole bays
  double length_after = 60.0;   ///< track after the end of the last span, or after x = 0 where there is none [m]

  SupportParameters pad{30e6, 30e6, 65e6, 50e3, 50e3, 75e3};  ///< one pad, between rail foot and sleeper top
  double pad_roll_stiffness = 122e3;  ///< about x [N m/rad]: kz spread over a foot of 0.15 m, kz·b²/12
  double pad_roll_damping = 140.0;    ///< about x [N m s/rad]: likewise from cz

  double half_ballast_distance = 0.75;  ///< track centre to the ballast spring under each sleeper half [m]
  /// Under one sleeper half, to the ground. Vertical: the ballast and sub-ballast of [Zhai2004] in series (137.75 and
  /// 77.5 MN/m; 58.8 and 31.15 kN s/m), the ballast's own mass left out.
  SupportParameters ballast_ground{50e6, 50e6, 49.6e6, 40e3, 40e3, 20.4e3};
  /// Under one sleeper half, to the deck: the ballast alone.
  SupportParameters ballast_deck{50e6, 50e6, 137.75e6, 40e3, 40e3, 58.8e3};

  void validate() const;  ///< @throws InputError
  bool operator==(const TrackParameters&) const = default;
};

/// One simply supported span: x, y, z and roll held at its first end, y, z and roll at its second, on the beam axis.
/// Defaults: Chinese 32 m prestressed box girder; its mass includes the superimposed load (first frequency 5.12 Hz).
struct BridgeParameters {
  double length = 32.0;           ///< [m]
  double E = 34.5e9;              ///< [Pa]
  double G = 14.4e9;              ///< [Pa]: E/(2(1 + 0.2))
  double A = 8.8889;              ///< [m²]
  double Iy = 10.947;             ///< vertical bending [m⁴]
  double Iz = 86.216;             ///< lateral bending [m⁴]
  double J = 22.65;               ///< torsion constant [m⁴]
  double mass = 33.9e3;           ///< with ballast and superimposed load, without rails and sleepers [kg/m]
  double rotary_inertia = 370e3;  ///< about x [kg m²/m]: mass times (Iy + Iz)/A
  double damping_ratio = 0.01;    ///< at the first two vertical bending frequencies, 0..0.5 (EN 1991-2: prestressed)
  int elements = 32;              ///< even, 2..1000
  double axis_depth = 1.9;        ///< rail-head top down to the beam axis [m]
  double track_offset = 0.0;      ///< track centre right (y > 0) of the beam axis [m]

  void validate() const;  ///< @throws InputError
  bool operator==(const BridgeParameters&) const = default;
};

/// Two continuous rails on discrete pads and sleepers, on ballast springs to the ground and, between x = 0 and the end
/// of the last span, to a 3D beam bridge whose spans follow each other without a gap.
///
/// Sleepers stand at whole multiples of the spacing; one at start <= x < end of a span rests on that span, joined by
/// rigid arms to the beam axis (Hermite interpolation between deck nodes, no degrees of freedom of its own). At the two
/// ends of the model the rails' x, pitch, yaw and twist rate are held (symmetry: the track goes on beyond), all else is
/// free.
///
/// Named nodes, spans counted from 1: "deck-midspan-<i>" (beam axis), "rail-left-midspan-<i>" and
/// "rail-right-midspan-<i>" (nearest rail node); with `report`, positions along the track [m], "deck-<x>",
/// "rail-left-<x>" and "rail-right-<x>" in their place; without a span "rail-left-origin" and "rail-right-origin" at
/// x = 0.
/// Displacements are measured from the state of rest under the structure's own weight. Supports: the ground under every
/// sleeper that stands on it, and both ends of every span, which the ground moves along y and z.
/// @pre no span with a track offset where only the vertical plane is built
/// @throws InputError naming the key
[[nodiscard]] StructureModel build_track_bridge(const TrackParameters& track,
                                                const std::vector<BridgeParameters>& spans,
                                                MotionPlane plane = MotionPlane::spatial,
                                                const std::vector<double>& report = {},
                                                DeckRecord record = DeckRecord::named_nodes);

}  // namespace railtab
