#pragma once

#include <filesystem>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::work_precision {

/// The rough track of the demo with two waves of alignment, 20 m long and 16 mm high, from x = 10 m on, written to
/// `file`: the flanges of a coach lead it through them.
void write_wavy_track(const std::filesystem::path& file);

/// A coach (S1002 on 60E1 1:40, online search) at 50 m/s over ballasted track and a 20 m span, 0.6 s.
[[nodiscard]] SceneParameters coach_over_bridge(const std::filesystem::path& irregularity);

/// A coach with conical treads on smooth ballasted track at 100 m/s, all its wheelsets 5 mm beside the centre at t = 0:
/// they hunt and strike the rails with their flanges, 0.5 s. On rigid rails nothing would damp the wheels' vibration on
/// their contact springs after a blow, and runs would differ by its phase.
[[nodiscard]] SceneParameters hunting_coach();

/// The sprung mass of [YangYau1997] over its simple beam, from rest: 100 km/h, 25 m.
[[nodiscard]] RunSummary cross_beam(const IntegrationParameters& integration, int record_every,
                                    const RunObserver& observer);
inline constexpr double beam_crossing = 25.0 / (100.0 / 3.6);  // s

}  // namespace railtab::work_precision
