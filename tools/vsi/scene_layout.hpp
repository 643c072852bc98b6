#pragma once

#include <array>
#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab::vsi {

/// What stands where along the track.
struct SceneLayout {
  double track_from = 0.0, track_to = 0.0;    ///< of the modelled rails [m]; of rigid rails, where wheels run
  bool rigid = false;                         ///< rails without a model
  std::vector<std::array<double, 2>> spans;   ///< from and to [m]
  std::vector<double> wheelsets;              ///< at t = 0, front first [m]
  double travel = 0.0;                        ///< of the train in the run [m]
  std::vector<std::array<double, 2>> uneven;  ///< where an irregularity is known [m]; empty: even track
  std::vector<std::string> nodes;             ///< recorded nodes of the structure
  double duration = 0.0;                      ///< of the run [s]
};

[[nodiscard]] SceneLayout scene_layout(const SceneParameters& scene, const VsiModel& model);

/// The layout as lines of at most 80 characters, to scale.
[[nodiscard]] std::string layout_text(const SceneLayout& layout);
/// The same as a picture, an SVG file.
[[nodiscard]] std::string layout_svg(const SceneLayout& layout, const std::string& title);

}  // namespace railtab::vsi
