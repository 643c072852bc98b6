#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "assessment.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::vsi {

/// Decks of the scene with frequencies, deflection under LM71 and the need of a dynamic analysis.
/// @throws InputError where the scene has no bridge
void check_decks(const SceneParameters& scene, assess::Assessment& assessment);

/// "the scene's train (manchester-coach*8)": its vehicles from front to rear.
[[nodiscard]] std::string own_train_name(const TrainParameters& train);
/// The scene's train as constant axle loads, from its wheelsets and their static loads.
/// @throws InputError as train_model()
[[nodiscard]] AxleTrain axle_train_of(const SceneParameters& scene);

/// The trains on every deck from 40 m/s (or half the highest speed, if that is below 50 m/s) to 1.2 times the line
/// speed: even steps for the curves, the line speed, and the critical speeds. @param trains the scene's own last
/// @param progress share done; may be empty @pre check_decks()
void run_moving_loads(const std::vector<AxleTrain>& trains, int threads, const std::function<void(double)>& progress,
                      assess::Assessment& assessment);

/// Largest response of a deck to a train as moving loads at speeds up to `highest` [m/s].
struct LargestResponse {
  double acceleration = -1.0;  ///< [m/s²]
  double displacement = -1.0;  ///< [m]
  double end_rotation = -1.0;  ///< [rad]
  double speed = 0.0;          ///< of the largest acceleration [m/s]
};
/// Of each deck. @pre check_decks()
[[nodiscard]] std::vector<LargestResponse> largest_responses(const AxleTrain& train,
                                                             const std::vector<assess::DeckAssessment>& decks,
                                                             double highest);

}  // namespace railtab::vsi
