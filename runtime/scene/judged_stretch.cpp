#include "railtab/runtime/scene/judged_stretch.hpp"

#include <algorithm>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

namespace {

double fade_in(const SceneParameters& scene) { return scene.spectrum ? scene.spectrum->fade_length() : 0.0; }

}  // namespace

double judging_begin(const SceneParameters& scene) {
  return scene.assessment.begin.value_or(scene.train.start + fade_in(scene));
}

std::vector<double> judged_stretch(const SceneParameters& scene) {
  const AssessmentParameters& assessment = scene.assessment;
  const bool has_begin = assessment.begin || fade_in(scene) > 0.0;
  if (!has_begin && !assessment.end) return {};
  const double first = has_begin ? judging_begin(scene) : -off_the_line;
  return {first, std::max(first, assessment.end.value_or(off_the_line))};
}

}  // namespace railtab
