#include <array>
#include <string_view>

#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/scene/key_warnings.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"

namespace railtab::scene {
namespace {

/// The member reached from the draft's track by a chain of member pointers.
template <auto... chain>
auto& of_track(SceneDraft& draft) {
  return (draft.parameters.track.*....*chain);
}

template <auto member>
auto& of_span(SceneDraft& draft) {
  return draft.span.*member;
}

std::string structure_left_out(const SceneParameters& scene) {
  if (scene.track_kind != TrackKind::rigid) return {};
  return "degrees of freedom of a structure and their factorisation: the track is rigid";
}
std::string bridge_left_out(const SceneParameters& scene) {
  const bool bridge = track_on_import(scene) || !scene.spans.empty() || scene.track_kind == TrackKind::imported;
  return bridge ? "" : "bridge: the scene has none";
}

KeyRow track_kind_key() {
  return {"track.kind",
          "",
          "flexible: rails, sleepers, ballast; imported: rails of an imported structure",
          choice<TrackKind>(
              [](SceneDraft& d) -> TrackKind& { return d.parameters.track_kind; },
              {{"rigid", TrackKind::rigid}, {"flexible", TrackKind::flexible}, {"imported", TrackKind::imported}}),
          {},
          {},
          structure_left_out};
}

KeyRow longitudinal_key() {
  return {"track.longitudinal", "",
          "motions of rails and sleepers along x; auto: left out where that changes the rail heads' static compliance "
          "by at most 1 %",
          choice<LongitudinalMotion>(of_track<&TrackParameters::longitudinal>,
                                     {{"auto", LongitudinalMotion::automatic},
                                      {"kept", LongitudinalMotion::kept},
                                      {"left-out", LongitudinalMotion::left_out}})};
}

std::vector<KeyRow> layout_keys() {
  return {
      {"track.sleeper_spacing", "m", "sleeper spacing",
       NumberKey{of_track<&TrackParameters::sleeper_spacing>, {0.2, 5.0}}},
      {"track.half_rail_distance",
       "m",
       "distance of the rail-head centres from the track centre",
       NumberKey{of_track<&TrackParameters::half_rail_distance>, {0.25, 1.1}},
       {},
       {&rails_off_gauge}},
      {"track.elements_per_bay", "1", "rail elements between sleepers; 0: one; under wheels that follow the rails, two",
       IntegerKey{of_track<&TrackParameters::elements_per_bay>, 0, 20}},
      longitudinal_key(),
      {"track.length_before", "m", "track before x = 0, rounded up to whole bays",
       NumberKey{of_track<&TrackParameters::length_before>, {0.1, 1e4}}},
      {"track.length_after", "m", "track after the last span, or x = 0",
       NumberKey{of_track<&TrackParameters::length_after>, {0.1, 1e4}}},
      {"track.pad_roll_stiffness", "N m/rad", "of one pad about x",
       NumberKey{of_track<&TrackParameters::pad_roll_stiffness>, {1.0, 1e12}}},
      {"track.pad_roll_damping", "N m s/rad", "of one pad about x",
       NumberKey{of_track<&TrackParameters::pad_roll_damping>, {0.0, 1e9}}},
      {"track.half_ballast_distance", "m", "distance of the ballast springs from the track centre",
       NumberKey{of_track<&TrackParameters::half_ballast_distance>, {0.1, 3.0}}},
  };
}

std::vector<KeyRow> rail_keys() {
  return {
      {"track.rail.E", "Pa", "Young's modulus",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::E>, {1e10, 1e13}}},
      {"track.rail.A", "m²", "cross-sectional area",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::A>, {1e-4, 1.0}}},
      {"track.rail.Iy", "m⁴", "second moments of area, vertical and lateral bending",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::Iy>, {1e-8, 0.1}}},
      {"track.rail.Iz", "m⁴", "second moments of area, vertical and lateral bending",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::Iz>, {1e-8, 0.1}}},
      {"track.rail.GJ", "N m²", "torsional stiffness",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::GJ>, {100.0, 1e12}}},
      {"track.rail.warping_length", "m", "√(E I_ω/GJ), of the warping stiffness E I_ω",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::warping_length>, {0.02, 2.0}}},
      {"track.rail.mass", "kg/m", "mass per length",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::mass>, {1.0, 1e4}}},
      {"track.rail.rotary_inertia", "kg m²/m", "rotary inertia about x, per length",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::rotary_inertia>, {1e-4, 1e3}}},
      {"track.rail.height", "m", "height from foot to top",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::height>, {0.01, 1.0}}},
      {"track.rail.head_height", "m", "height of the top above the centroid, at most track.rail.height",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::head_height>, {0.001, 1.0}}},
      {"track.rail.mass_damping", "1/s", "Rayleigh damping, of the mass",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::mass_damping>, {0.0, 1e4}}},
      {"track.rail.stiffness_damping", "s", "Rayleigh damping, of the stiffness",
       NumberKey{of_track<&TrackParameters::rail, &RailBeamParameters::stiffness_damping>, {0.0, 1.0}}},
  };
}

std::vector<KeyRow> sleeper_keys() {
  return {
      {"track.sleeper.mass", "kg", "mass",
       NumberKey{of_track<&TrackParameters::sleeper, &SleeperParameters::mass>, {1.0, 1e5}}},
      {"track.sleeper.Jx", "kg m²", "moments of inertia",
       NumberKey{of_track<&TrackParameters::sleeper, &SleeperParameters::Jx>, {0.01, 1e5}}},
      {"track.sleeper.Jy", "kg m²", "moments of inertia",
       NumberKey{of_track<&TrackParameters::sleeper, &SleeperParameters::Jy>, {0.01, 1e5}}},
      {"track.sleeper.Jz", "kg m²", "moments of inertia",
       NumberKey{of_track<&TrackParameters::sleeper, &SleeperParameters::Jz>, {0.01, 1e5}}},
      {"track.sleeper.height", "m", "height",
       NumberKey{of_track<&TrackParameters::sleeper, &SleeperParameters::height>, {0.01, 2.0}}},
  };
}

// A value beyond these is off by orders of magnitude: another unit, or a slip of the pen.
constexpr Range spring{1e5, 1e13}, damper{0.0, 1e9};

/// Six keys of one layer of springs and dampers.
template <SupportParameters TrackParameters::*layer>
std::vector<KeyRow> support_keys(const std::array<std::string_view, 6>& paths) {
  return {
      {paths[0], "N/m", "stiffness", NumberKey{of_track<layer, &SupportParameters::kx>, spring}},
      {paths[1], "N/m", "stiffness", NumberKey{of_track<layer, &SupportParameters::ky>, spring}},
      {paths[2], "N/m", "stiffness", NumberKey{of_track<layer, &SupportParameters::kz>, spring}},
      {paths[3], "N s/m", "damping", NumberKey{of_track<layer, &SupportParameters::cx>, damper}},
      {paths[4], "N s/m", "damping", NumberKey{of_track<layer, &SupportParameters::cy>, damper}},
      {paths[5], "N s/m", "damping", NumberKey{of_track<layer, &SupportParameters::cz>, damper}},
  };
}

std::vector<KeyRow> span_keys() {
  return {
      {"bridge.count", "1", "equal spans", IntegerKey{[](SceneDraft& d) -> int& { return d.span_count; }, 1, 1000}},
      {"bridge.length",
       "m",
       "length",
       NumberKey{of_span<&BridgeParameters::length>, {0.5, 1e3}},
       {},
       {&span_with_few_sleepers},
       bridge_left_out},
      {"bridge.E", "Pa", "Young's modulus", NumberKey{of_span<&BridgeParameters::E>, {1e9, 1e13}}},
      {"bridge.G", "Pa", "shear modulus", NumberKey{of_span<&BridgeParameters::G>, {1e8, 1e13}}},
      {"bridge.A", "m²", "cross-sectional area", NumberKey{of_span<&BridgeParameters::A>, {1e-3, 1e4}}},
      {"bridge.Iy", "m⁴", "second moments of area, vertical and lateral bending",
       NumberKey{of_span<&BridgeParameters::Iy>, {1e-6, 1e5}}},
      {"bridge.Iz", "m⁴", "second moments of area, vertical and lateral bending",
       NumberKey{of_span<&BridgeParameters::Iz>, {1e-6, 1e5}}},
      {"bridge.J", "m⁴", "torsion constant", NumberKey{of_span<&BridgeParameters::J>, {1e-8, 1e5}}},
      {"bridge.mass",
       "kg/m",
       "mass per length with ballast and superimposed load, without rails and sleepers",
       NumberKey{of_span<&BridgeParameters::mass>, {100.0, 1e7}},
       {},
       {&span_unlike_a_bridge}},
      {"bridge.rotary_inertia", "kg m²/m", "rotary inertia about x, per length",
       NumberKey{of_span<&BridgeParameters::rotary_inertia>, {0.1, 1e9}}},
      {"bridge.damping_ratio",
       "1",
       "damping ratio at the first two vertical bending frequencies",
       NumberKey{of_span<&BridgeParameters::damping_ratio>, {0.0, 0.5}},
       {&without_damping_type}},
      {"bridge.damping_type", "", "lower bound of the damping ratio, EN 1991-2, Table 6.6",
       TextKey{[](SceneDraft& d) -> std::string& { return d.span_damping_type; }, bridge_damping_types}},
      {"bridge.elements", "1", "beam elements of the span, an even number",
       IntegerKey{of_span<&BridgeParameters::elements>, 2, 1000}},
      {"bridge.axis_depth",
       "m",
       "depth of the beam axis below the rail-head tops",
       NumberKey{of_span<&BridgeParameters::axis_depth>, {-100.0, 100.0}},
       {},
       {&span_far_from_track}},
      {"bridge.track_offset", "m", "distance of the track centre from the beam axis, to the right",
       NumberKey{of_span<&BridgeParameters::track_offset>, {-100.0, 100.0}}},
  };
}

std::vector<KeyRow> reduction_rows() {
  return {
      {"structure.reduction", "", "active degrees of freedom: all, or those around the train", ReductionKey{}},
      {"structure.window_ahead", "m", "active track ahead of the first, behind the last wheelset",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.reduction.ahead; }, {5.0, 1e5}}},
      {"structure.window_behind", "m", "active track ahead of the first, behind the last wheelset",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.reduction.behind; }, {5.0, 1e5}}},
  };
}

}  // namespace

std::vector<KeyRow> track_keys() {
  std::vector<KeyRow> rows =
      all_of({layout_keys(), rail_keys(), sleeper_keys(),
              support_keys<&TrackParameters::pad>(
                  {"track.pad.kx", "track.pad.ky", "track.pad.kz", "track.pad.cx", "track.pad.cy", "track.pad.cz"}),
              support_keys<&TrackParameters::ballast_ground>({"track.ballast_ground.kx", "track.ballast_ground.ky",
                                                              "track.ballast_ground.kz", "track.ballast_ground.cx",
                                                              "track.ballast_ground.cy", "track.ballast_ground.cz"}),
              applying(with_ballast_on_deck,
                       support_keys<&TrackParameters::ballast_deck>(
                           {"track.ballast_deck.kx", "track.ballast_deck.ky", "track.ballast_deck.kz",
                            "track.ballast_deck.cx", "track.ballast_deck.cy", "track.ballast_deck.cz"}))});
  return all_of({{track_kind_key()}, applying(with_flexible_track, std::move(rows))});
}

std::vector<KeyRow> bridge_keys() { return span_keys(); }

std::vector<KeyRow> reduction_keys() {
  std::vector<KeyRow> rows = reduction_rows();
  for (KeyRow& row : rows) {
    row.applies.push_back(row.path == "structure.reduction" ? &with_structure_to_reduce : &with_window);
  }
  return rows;
}

}  // namespace railtab::scene
