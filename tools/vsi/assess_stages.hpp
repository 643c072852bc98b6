#pragma once

#include <functional>
#include <optional>

#include "assessment.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::vsi {

/// Decks of the scene with frequencies, deflection under LM71 and the need of a dynamic analysis.
/// @throws InputError where the scene has no bridge
void check_decks(const SceneParameters& scene, assess::Assessment& assessment);

/// The scene's train as constant axle loads, from its wheelsets and their static loads.
/// @throws InputError as build_model()
[[nodiscard]] AxleTrain axle_train_of(const SceneParameters& scene);

/// HSLM-A and `own` on every deck from 40 m/s (or half the highest speed, if that is below 50 m/s) to 1.2 times the
/// line speed: even steps for the curves, and the critical speeds. @param progress share done; may be empty
/// @pre check_decks()
void run_moving_loads(const std::optional<AxleTrain>& own, int threads, const std::function<void(double)>& progress,
                      assess::Assessment& assessment);

/// The speed up to `highest` [m/s] at which the scene's own train as moving loads gives the largest acceleration of a
/// deck. @pre check_decks()
[[nodiscard]] double governing_speed(const AxleTrain& own, const std::vector<assess::DeckAssessment>& decks,
                                     double highest);

}  // namespace railtab::vsi
