#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "assess_stages.hpp"
#include "assessment.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::vsi {

/// A train of an assessment.
struct AssessTrain {
  std::string name;  ///< as the user wrote it
  AxleTrain axles;   ///< as moving forces
  /// The scene with this train, where it is one of vehicles: it can run with contact.
  std::optional<SceneParameters> scene;
  bool own = false;  ///< the scene's
};

/// Trains by name: "hslm-a" for its ten, other axle trains and files as of find_axle_train(), or vehicles from front to
/// rear, as of train.consist, joined by "+": "traxx-locomotive+ordinary-coach*8". Last of all the scene's own train.
/// @param folder that files are relative to
/// @throws InputError where a train is not known or does not move
[[nodiscard]] std::vector<AssessTrain> assess_trains(const SceneParameters& scene,
                                                     const std::vector<std::string>& names,
                                                     const std::filesystem::path& folder);

/// A train to run with contact.
struct GoverningTrain {
  const AssessTrain* train;
  /// Largest response of each deck to it as moving forces; none where no other train was compared with it.
  std::vector<LargestResponse> responses;
};

/// Of the trains of vehicles those whose moving forces give the largest acceleration, displacement or end rotation of a
/// deck at speeds up to `highest` [m/s]; each once. @pre one of them is of vehicles
[[nodiscard]] std::vector<GoverningTrain> governing_trains(const std::vector<AssessTrain>& trains,
                                                           const std::vector<assess::DeckAssessment>& decks,
                                                           double highest);

}  // namespace railtab::vsi
