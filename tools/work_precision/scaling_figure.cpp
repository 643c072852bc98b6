#include "scaling_figure.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <ctime>

#include "interleaved_timing.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "run_error.hpp"

namespace railtab::work_precision {

namespace {

constexpr int steps = 40;
constexpr double longest_side = 10000.0;  // m, of the track before and after the bridge: the scene's limit
constexpr double coach_length = 26.0;     // m, more than that of any vehicle here

struct TrackRun {
  long unknowns = 0;
  int wheels = 0;
  double setup_seconds = 0.0, step_seconds = 0.0;  ///< processor time; of one step
};

// A train on smooth track of a length, from rest, 40 steps.
TrackRun run_on_track(double length, int coaches, const std::filesystem::path& table, int elements_per_bay = 0) {
  SceneParameters scene;
  scene.train.count = coaches;
  scene.train.speed = 50.0;
  scene.train.start = 0.0;
  scene.contact.mode = table.empty() ? ContactMode::online : ContactMode::table;
  scene.contact.table = table;
  const double train = coaches * coach_length;
  scene.track.elements_per_bay = elements_per_bay;
  scene.track.length_before = std::min(longest_side, std::max(train, 0.5 * (length + train)));
  scene.track.length_after = std::max(4.0, length - scene.track.length_before);
  scene.integration.duration = steps * scene.integration.time_step;
  const std::clock_t begin = std::clock();
  const VsiModel model = build_model(scene);
  VsiState state(model);
  TrackRun result;
  if (!static_equilibrium(model, state).converged) return result;
  const MeasuredRun run = measured([&](const RunObserver& observer) {
    return simulate(model, scene.integration, scene.integration.duration, steps, state, observer);
  });
  const double total = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!run.summary.complete) return result;
  result.unknowns = model.structure->dofs();
  result.wheels = 2 * model.wheelsets();
  result.setup_seconds = total - run.seconds;
  result.step_seconds = run.seconds / steps;
  return result;
}

WorkFigure size_figure(const std::string& name, const std::string& title, const std::string& x_label,
                       const std::string& y_label, const std::string& advice) {
  WorkFigure figure;
  figure.name = name;
  figure.title = title;
  figure.x_label = x_label;
  figure.y_label = y_label;
  figure.advice = advice;
  figure.kind = FigureKind::time_over_size;
  return figure;
}

}  // namespace

std::vector<WorkFigure> scaling_figures(const std::filesystem::path& geometry_table, bool quick) {
  WorkFigure step = size_figure("scaling_step", "Scaling: a step over the degrees of freedom of the structure",
                                "degrees of freedom of the structure", "processor time per step [s]",
                                "A step costs one back-substitution and the contacts: in proportion to the track "
                                "on long tracks, to the wheels on short ones. Model as much track as the train "
                                "needs and no more.");
  WorkFigure setup = size_figure("scaling_setup", "Scaling: the set-up over the degrees of freedom of the structure",
                                 "degrees of freedom of the structure", "processor time of model, rest and factors [s]",
                                 "The set-up grows with the track, and with the wheels through the rails' "
                                 "compliance at rest, which couples every wheel with every other: for long "
                                 "trains it is the larger part of a short run.");
  WorkFigure wheels = size_figure("scaling_wheels", "Scaling: a step over the wheels of the train", "wheels",
                                  "processor time per step [s]",
                                  "The contacts cost the same for every wheel. The structure's part, which "
                                  "remains for a short train on a long track, does not depend on the wheels.");
  std::vector<double> lengths{40.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0, 19500.0};  // m
  std::vector<int> trains{1, 8, 32};
  if (quick) {
    lengths = {40.0, 100.0};
    trains = {1, 2};
  }
  for (const int coaches : trains) {
    for (const double length : lengths) {
      if (length < coaches * coach_length + 4.0) continue;
      const TrackRun run = run_on_track(length, coaches, geometry_table);
      if (run.wheels == 0) continue;
      const std::string method = fmt::format("{} wheels", run.wheels);
      const std::string setting = fmt::format("{:g} km", 1e-3 * length);
      const auto unknowns = static_cast<double>(run.unknowns);
      step.points.push_back({method, setting, unknowns, run.step_seconds, 0.0, ""});
      setup.points.push_back({method, setting, unknowns, run.setup_seconds, 0.0, ""});
    }
  }
  if (!quick) {  // the longest track with finer rails
    constexpr int finer = 3;
    const TrackRun run = run_on_track(lengths.back(), 1, geometry_table, finer);
    const std::string method = fmt::format("{} wheels", run.wheels);
    const std::string setting = fmt::format("{:g} km, {} rail elements per bay", 1e-3 * lengths.back(), finer);
    const auto unknowns = static_cast<double>(run.unknowns);
    step.points.push_back({method, setting, unknowns, run.step_seconds, 0.0, ""});
    setup.points.push_back({method, setting, unknowns, run.setup_seconds, 0.0, ""});
  }
  const double length = quick ? 100.0 : 1000.0;
  for (int coaches = 1; coaches <= (quick ? 2 : 32); coaches *= 2) {
    const TrackRun run = run_on_track(length, coaches, geometry_table);
    if (run.wheels == 0) continue;
    wheels.points.push_back({fmt::format("{:g} km of track", 1e-3 * length), fmt::format("{} coaches", coaches),
                             static_cast<double>(run.wheels), run.step_seconds, 0.0,
                             fmt::format("{:.1f} µs per wheel", 1e6 * run.step_seconds / run.wheels)});
  }
  return {step, setup, wheels};
}

WorkFigure threads_figure(bool quick) {
  WorkFigure figure =
      size_figure("scaling_threads", "Scaling: a geometry table over threads", "threads", "wall time of the table [s]",
                  "The root cells of a sweep are independent: use as many threads as there are cores. A run is "
                  "serial; use further cores for further runs.");
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  GeometrySweepOptions options;
  options.iterated_cell = 1e-3;
  options.fallback_cell = 1e-4;
  if (quick) options.lateral = {-1e-3, 1e-3};
  const int most = omp_get_num_procs();
  std::vector<int> threads{1};
  while (2 * threads.back() <= most) threads.push_back(2 * threads.back());
  std::vector<std::function<double()>> passes;
  for (const int n : threads) {
    passes.push_back([&search, &options, n] {
      omp_set_num_threads(n);
      return static_cast<double>(sweep_geometry(search, options).node.size());
    });
  }
  const std::vector<double> seconds = interleaved_medians(passes, quick ? 1 : 5);
  omp_set_num_threads(most);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    figure.points.push_back({"sweep of S1002 on 60E1, coarse cells", "", static_cast<double>(threads[i]), seconds[i],
                             0.0, fmt::format("{:.2f} times as fast as one thread", seconds[0] / seconds[i])});
  }
  return figure;
}

}  // namespace railtab::work_precision
