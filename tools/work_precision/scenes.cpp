#include "scenes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <string>

#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"

namespace railtab::work_precision {

void write_wavy_track(const std::filesystem::path& file) {
  constexpr double height = 16.0, length = 20.0, begin = 10.0;  // mm as the file, m
  std::ifstream rough(RAILTAB_SOURCE_DIR "/docs/examples/demo_irregularity.csv");
  std::string wavy;
  for (std::string line; std::getline(rough, line);) {
    double x, y_left, z_left, y_right, z_right;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &x, &y_left, &z_left, &y_right, &z_right) == 5) {
      const bool in_waves = x > begin && x < begin + 2.0 * length;
      const double wave =
          in_waves ? 0.5 * height * (1.0 - std::cos(2.0 * std::numbers::pi * (x - begin) / length)) : 0.0;
      line = fmt::format("{},{},{},{},{}", x, y_left + wave, z_left, y_right + wave, z_right);
    }
    wavy += line + '\n';
  }
  write_text_file(file, wavy);
}

SceneParameters coach_over_bridge(const std::filesystem::path& irregularity) {
  SceneParameters scene;
  scene.train.speed = 50.0;
  scene.train.start = 0.0;
  scene.contact.mode = ContactMode::online;
  scene.track.length_before = 30.0;
  scene.track.length_after = 30.0;
  scene.spans.resize(1);
  scene.spans[0].length = 20.0;
  scene.irregularity = irregularity;
  scene.integration.duration = 0.6;
  return scene;
}

SceneParameters hunting_coach() {
  SceneParameters scene;
  scene.train.speed = 100.0;
  scene.train.initial_lateral_shift = 5e-3;
  scene.contact.mode = ContactMode::online;
  scene.contact.wheel = "conic-arc-stand-in";
  scene.train.start = 0.0;
  scene.track.length_before = 40.0;
  scene.track.length_after = 70.0;
  scene.integration.duration = 0.5;
  return scene;
}

RunSummary cross_beam(const IntegrationParameters& integration, int record_every, const RunObserver& observer) {
  const DofIndices heave{held, held, 0, held, held, held};
  VsiModel model;
  model.vehicle = assemble_vehicle(
      {"sprung mass",
       {{"wheelset", 1e-3, {1.0, 1.0, 1.0}, {0.0, 0.0, -0.46}}, {"mass", 5750.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}}},
       {{0, 1, {0.0, 0.0, -0.7}, {0.0, 0.0, 1595e3}, {0.0, 0.0, 0.0}}},
       {0},
       {heave, heave},
       0.46,
       10.0});
  model.vehicle_x = {0.0};
  model.structure = share(build_simple_beam({.length = 25.0, .E = 2.87e9, .I = 2.90, .mass = 2303.0, .elements = 40}));
  model.contact.speed = 25.0 / beam_crossing;
  model.normal_contact = NormalContact::rigid;
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) return {};
  return simulate(model, integration, beam_crossing, record_every, state, observer);
}

}  // namespace railtab::work_precision
