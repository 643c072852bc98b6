#pragma once

#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// Where wheels and car bodies begin to be judged [m]: assessment.begin; without it where the train starts, or where
/// the random track has faded in.
[[nodiscard]] double judging_begin(const SceneParameters& scene);

/// ResultHeader::judged of a run: from assessment.begin, or where the track has faded in, to assessment.end; empty
/// where the scene has none of these. A stretch of no length where an assessment's own fade-in is longer than that.
[[nodiscard]] std::vector<double> judged_stretch(const SceneParameters& scene);

}  // namespace railtab
