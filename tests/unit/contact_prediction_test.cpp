// Newton's method of the contacts begins where the tangents of the last step lead, and ends by a tangent where that is
// right within the tolerance: few evaluations per step, with the forces of far more.

#include <gtest/gtest.h>

#include <algorithm>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/contact_law.hpp"

namespace railtab {
namespace {

VsiModel rough_line() {
  SceneParameters scene;
  scene.train.speed = 20.0;
  scene.contact.mode = ContactMode::online;
  scene.track.length_before = 40.0;
  scene.track.length_after = 20.0;
  scene.spans.clear();
  scene.integration.duration = 1.0;
  scene.spectrum.emplace();
  scene.spectrum->name = "german-low";
  return build_model(scene);
}

struct Steps {
  double evaluations = 0.0;    // per wheel and step
  double largest_error = 0.0;  // of a stored force against that at the motion which the step ends with [N, N m]
  Eigen::VectorXd force;       // at the end
};

Steps run(const VsiModel& model, double force_tolerance, int steps) {
  const HhtScheme scheme{.alpha = -0.05, .time_step = 1e-3};
  StepLimits limits;
  limits.newton.force_tolerance = force_tolerance;
  VsiState state(model);
  EXPECT_TRUE(steady_start(model, state).converged);
  StepOperators operators(model, scheme);
  StepWorkspace workspace(model);
  const std::unique_ptr<ContactLaw> contacts = make_contact_law(model);
  Steps result{};
  long queries = 0;
  for (int i = 0; i < steps; ++i) {
    operators.update_for_time(model, state.time + scheme.time_step, {0, model.structure->dofs()});
    const StepReport report = advance(model, operators, limits, state, *contacts, workspace);
    EXPECT_EQ(report.outcome, StepOutcome::accepted);
    queries += report.counts.queries;
    const Eigen::VectorXd error = contacts->evaluated(state).end_force - state.contact.end_force;
    result.largest_error = std::max(result.largest_error, error.cwiseAbs().maxCoeff());
  }
  result.evaluations = static_cast<double>(queries) / (2.0 * model.wheelsets() * steps);
  result.force = state.contact.end_force;
  return result;
}

TEST(ContactPrediction, FewEvaluationsGiveTheForcesOfTheMotion) {
  constexpr double tolerance = 5.0;  // N
  const VsiModel model = rough_line();
  const Steps coarse = run(model, tolerance, 100), fine = run(model, 1e-3 * tolerance, 100);
  testing::measured("contact.evaluations", coarse.evaluations);
  testing::measured("contact.evaluations_fine", fine.evaluations);
  testing::measured("contact.force_error", coarse.largest_error);
  EXPECT_LT(coarse.evaluations, 2.2);
  EXPECT_LT(coarse.largest_error, 2.0 * tolerance);
  EXPECT_LT(fine.largest_error, 2e-3 * tolerance);
  EXPECT_LT((coarse.force - fine.force).cwiseAbs().maxCoeff(), 2.0 * tolerance);
}

}  // namespace
}  // namespace railtab
