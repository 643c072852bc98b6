#include "scene_figure.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>

#include "railtab/runtime/scene/scene_run.hpp"
#include "run_error.hpp"
#include "scenes.hpp"

namespace railtab::work_precision {

namespace {

struct Variant {
  std::string method, setting;
  SceneParameters scene;
  bool standard = false;
  bool joined = false;
};

std::vector<Variant> variants(const SceneParameters& base, const SceneTables& tables, bool quick) {
  std::vector<Variant> result;
  const auto add = [&](const std::string& method, ContactMode mode, const std::string& law, double step) {
    Variant v{method, law, base};
    v.scene.contact.mode = mode;
    if (mode == ContactMode::table) v.scene.contact.table = tables.geometry;
    v.scene.contact.creep_law = law;
    v.scene.integration.time_step = step;
    if (law == "published table") {
      v.scene.contact.creep_law = "table";
      v.scene.contact.creep_table = tables.paper_creep;
    }
    const double standard_step = IntegrationParameters{}.time_step;
    if (step != standard_step) v.setting += fmt::format(", {:g} ms", 1e3 * step);
    v.standard = mode == ContactMode::table && law == ContactParameters{}.creep_law && step == standard_step;
    result.push_back(v);
  };
  const double step = IntegrationParameters{}.time_step;
  std::vector<std::string> laws{"linear", "polach", "table", "fastsim"};
  if (quick) laws = {"polach", "table"};
  if (!tables.paper_creep.empty()) laws.push_back("published table");
  for (const std::string& law : laws) {
    if (!tables.geometry.empty()) add("geometry table", ContactMode::table, law, step);
    add("online search", ContactMode::online, law, step);
    add("published search", ContactMode::paper, law, step);
  }
  if (tables.geometry.empty()) return result;
  const auto add_reduced = [&](const std::string& setting, const ReductionParameters& reduction) {
    add("reduced structure", ContactMode::table, ContactParameters{}.creep_law, step);
    result.back().setting += ", " + setting;
    result.back().scene.reduction = reduction;
    result.back().standard = false;
  };
  add_reduced("window of 20 m", {.kind = Reduction::window});
  if (quick) return result;
  for (const char* law : {"table", "polach"}) {
    const std::string method = fmt::format("{}, other steps", law);
    for (const double other : {4 * step, 2 * step, step / 2, step / 4}) {
      add(method, ContactMode::table, law, other);
      result.back().joined = true;
    }
  }
  return result;
}

MeasuredRun run_of(const SceneParameters& scene, double recorded) {
  SceneParameters with = scene;
  with.output.every = static_cast<int>(std::lround(recorded / scene.integration.time_step));
  return measured([&](const RunObserver& observer) { return run_scene(with, observer); });
}

struct Kind {
  Quantity quantity;
  const char *name, *title, *error_label;
};
constexpr std::array kinds{
    Kind{Quantity::wheel_forces, "scene_forces", "Whole scene, coach led by its flanges over a bridge: wheel forces",
         "error of wheel forces, rms [of the rms of their dynamic part]"},
    Kind{Quantity::car_body_acceleration, "scene_car_body", "Whole scene: car-body acceleration",
         "error of car-body acceleration, rms [of its rms]"},
    Kind{Quantity::deck_acceleration, "scene_deck", "Whole scene: deck acceleration",
         "error of deck acceleration, rms [of its rms]"}};

std::string note_of(const RunSummary& s) {
  return fmt::format("look-ups {:.0f} ms of wall time, {} queries; {} halved steps", 1e3 * s.seconds_lookup,
                     s.contact_queries, s.halved_steps);
}

}  // namespace

std::vector<WorkFigure> scene_figures(const SceneTables& tables, bool quick) {
  const std::filesystem::path track =
      std::filesystem::temp_directory_path() / fmt::format("railtab_wavy_track_{}.csv", getpid());
  write_wavy_track(track);
  SceneParameters base = coach_over_bridge(track);
  if (quick) base.integration.duration = 0.1;
  const double recorded = 4.0 * base.integration.time_step;
  SceneParameters finest = base;
  finest.contact.creep_law = "table";
  finest.integration.time_step /= quick ? 4.0 : 16.0;
  finest.integration.alpha = 0.0;
  const MeasuredRun reference = run_of(finest, recorded);

  const std::vector<Variant> all = variants(base, tables, quick);
  const std::vector<MeasuredRun> last =
      median_runs(all.size(), quick, [&](std::size_t i) { return run_of(all[i].scene, recorded); });
  std::filesystem::remove(track);

  std::vector<WorkFigure> figures;
  for (const Kind& kind : kinds) {
    WorkFigure figure{
        .name = kind.name, .title = kind.title, .y_label = kind.error_label, .advice = "", .least_error = 1e-9};
    figure.x_label = "processor time of the run, 0.6 s";
    figure.advice =
        "Take the geometry table and the creep table: the forces are those of the online search, in less time. "
        "The creep law decides the error of the forces; a smaller step does not reduce Polach's. The published "
        "search's error comes from the jumps of its contact pairs, whatever the law.";
    for (std::size_t i = 0; i < all.size(); ++i) {
      const RunError error = run_error(reference, last[i], kind.quantity);
      if (!std::isfinite(error.rms)) continue;
      figure.points.push_back({all[i].method, all[i].setting, 1e9 * last[i].seconds, error.rms, error.largest,
                               note_of(last[i].summary), all[i].standard, all[i].joined});
    }
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace railtab::work_precision
