#include "integration_figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iterator>

#include "railtab/runtime/scene/scene_run.hpp"
#include "run_error.hpp"
#include "scenes.hpp"

namespace railtab::work_precision {

namespace {

/// Integrates a scene and records `every` steps.
using SceneRun = std::function<RunSummary(const IntegrationParameters&, int every, const RunObserver&)>;

struct Setting {
  std::string method;
  IntegrationParameters integration;
};

/// Steps and what they are compared at.
struct Steps {
  double standard;             ///< default time step of the scene [s]
  double recorded;             ///< time between records [s]: a multiple of every step
  std::vector<double> others;  ///< [s]
  double finest;               ///< of the reference [s]
};

std::vector<Setting> settings(const Steps& steps, bool quick) {
  const IntegrationParameters standard;
  std::vector<Setting> result;
  const auto add = [&](const std::string& method, double step, double alpha, double tolerance) {
    IntegrationParameters p;
    p.time_step = step;
    p.alpha = alpha;
    p.tolerance = tolerance;
    result.push_back({method, p});
  };
  std::vector<double> alphas{0.0, standard.alpha, -1.0 / 3.0};
  if (quick) alphas = {0.0, standard.alpha};
  for (const double alpha : alphas) {
    for (const double step : steps.others) add(fmt::format("alpha = {:.2g}", alpha), step, alpha, standard.tolerance);
  }
  if (quick) return result;
  for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7}) {
    add("Newton's tolerance, standard alpha", steps.standard, standard.alpha, tolerance);
  }
  return result;
}

std::string label(const Setting& setting) {
  std::string text = fmt::format("{:g} ms", 1e3 * setting.integration.time_step);
  if (setting.method.starts_with("Newton")) text += fmt::format(", {:.0e}", setting.integration.tolerance);
  return text;
}

WorkFigure figure_of(WorkFigure figure, const SceneRun& run, const Steps& steps, bool quick) {
  figure.y_label = "error of wheel forces, rms [of the rms of their dynamic part]";
  figure.x_label = "processor time of the run";
  figure.least_error = 1e-9;
  const auto every = [&](double step) { return static_cast<int>(std::lround(steps.recorded / step)); };
  IntegrationParameters finest;
  finest.alpha = 0.0;
  finest.time_step = steps.finest;
  finest.tolerance = 1e-9;
  const MeasuredRun reference =
      measured([&](const RunObserver& observer) { return run(finest, every(steps.finest), observer); });
  const std::vector<Setting> all = settings(steps, quick);
  const std::vector<MeasuredRun> last = median_runs(all.size(), quick, [&](std::size_t i) {
    return measured([&](const RunObserver& observer) {
      return run(all[i].integration, every(all[i].integration.time_step), observer);
    });
  });
  const IntegrationParameters standard;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const IntegrationParameters& p = all[i].integration;
    const RunError error = run_error(reference, last[i], Quantity::wheel_forces);
    const bool is_standard =
        p.time_step == steps.standard && p.alpha == standard.alpha && p.tolerance == standard.tolerance;
    if (!last[i].summary.complete || !std::isfinite(error.rms)) {
      figure.advice += fmt::format(" Not finished: {}, {}: {}.", all[i].method, label(all[i]), last[i].summary.message);
      continue;
    }
    const auto per_step = [&](long n) { return static_cast<double>(n) / static_cast<double>(last[i].summary.steps); };
    figure.points.push_back({all[i].method, label(all[i]), 1e9 * last[i].seconds, error.rms, error.largest,
                             fmt::format("{:.2f} Newton iterations per step; {} halved steps",
                                         per_step(last[i].summary.newton_iterations), last[i].summary.halved_steps),
                             is_standard});
  }
  return figure;
}

SceneRun of_scene(SceneParameters scene, bool quick) {
  if (quick) scene.integration.duration *= 0.1;
  return [scene](const IntegrationParameters& integration, int every, const RunObserver& observer) {
    SceneParameters with = scene;
    const double duration = scene.integration.duration;
    with.integration = integration;
    with.integration.duration = duration;
    with.output.every = every;
    return run_scene(with, observer);
  };
}

}  // namespace

std::vector<WorkFigure> integration_figures(bool quick) {
  const double step = IntegrationParameters{}.time_step;
  const std::vector<double> steps =
      quick ? std::vector{2 * step, step} : std::vector{4 * step, 2 * step, step, step / 2};
  std::vector<WorkFigure> figures;
  // The beam is crossed in 1800 default steps of 0.5 ms.
  std::vector<double> beam_steps;
  for (const double s : steps) beam_steps.push_back(beam_crossing / std::round(beam_crossing / s));
  WorkFigure beam;
  beam.name = "integration_sprung_mass";
  beam.title = "Time integration: sprung mass over a beam";
  beam.advice =
      "The system is linear: alpha = 0 (Newmark) has the smallest error at every time step, and the time step "
      "sets the error.";
  figures.push_back(figure_of(
      beam, cross_beam,
      {beam_crossing / 1800.0, beam_crossing / 225.0, beam_steps, beam_crossing / (quick ? 7200.0 : 28800.0)}, quick));
  WorkFigure hunting;
  hunting.name = "integration_hunting";
  hunting.title = "Time integration: hunting with flange impacts, coach at 100 m/s";
  hunting.advice = "The time step matters most. Alpha and Newton's tolerance matter less at the default step.";
  figures.push_back(figure_of(hunting, of_scene(hunting_coach(), quick),
                              {step, 4 * step, steps, quick ? step / 4 : step / 16}, quick));
  WorkFigure coach;
  coach.name = "integration_coach";
  coach.title = "Time integration: coach over a rough bridge";
  coach.advice =
      "The time step sets the error. A little numerical damping helps at long steps, which do not resolve the "
      "highest frequencies of the track.";
  figures.push_back(
      figure_of(coach, of_scene(coach_over_bridge(RAILTAB_SOURCE_DIR "/docs/examples/demo_irregularity.csv"), quick),
                {step, 4 * step, steps, quick ? step / 4 : step / 16}, quick));
  return figures;
}

}  // namespace railtab::work_precision
