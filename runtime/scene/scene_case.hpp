#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/line/ground_motion.hpp"
#include "railtab/runtime/scene/key_warnings.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab::scene {

/// A stretch of time [s] or of the track [m].
struct Interval {
  double low, high;
  [[nodiscard]] bool meets(const Interval& other) const { return low <= other.high && other.low <= high; }
};

/// A scene with its model, as warnings need it.
struct SceneCase {
  const SceneParameters& scene;
  const VsiModel& model;
  double duration;                    ///< [s]
  Interval wheels;                    ///< along the track, where wheelsets run [m]
  std::vector<GroundRecord> records;  ///< of scene.ground_motion
};

/// The highest speed of the run [m/s].
[[nodiscard]] double highest_speed(const SceneCase& at);
/// First natural frequency of a span as a simply supported beam [Hz].
[[nodiscard]] double first_frequency(const BridgeParameters& span);

/// "x = 0 to 40 m"
[[nodiscard]] std::string text(const Interval& interval, std::string_view name, std::string_view unit);

}  // namespace railtab::scene
