// Wheel unloading of a coach on a viaduct under a gust and in an earthquake: runs docs/examples/wind.toml and
// earthquake.toml and writes wind_unloading.svg, earthquake_unloading.svg and wind_and_earthquake.csv into the folder
// given.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/report/svg_figure.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace {

using namespace railtab;

struct Unloading {
  RunSummary summary;
  std::vector<double> time, shift;           // [s]; car body, lateral [mm]
  std::array<std::vector<double>, 2> side;   // mean unloading of the left and of the right wheels [-]
  std::array<std::vector<double>, 2> least;  // of the first wheelset's left and right wheel [-]
  double largest = 0.0, derailment = 0.0;
};

Unloading run(const std::string& file) {
  Unloading u;
  std::vector<double> static_load;
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) { static_load = header.static_wheel_load; };
  long step = 0;
  observer.record = [&](const StepRecord& r) {
    std::array<double, 2> mean{};
    for (std::size_t w = 0; w < r.wheels.size(); ++w) {
      const double unloading = 1.0 - r.wheels[w].Q / static_load[w];
      mean[w % 2] += 2.0 * unloading / static_cast<double>(r.wheels.size());
      u.largest = std::max(u.largest, unloading);
      if (r.wheels[w].Q > 0.1 * static_load[w]) {
        u.derailment = std::max(u.derailment, std::abs(r.wheels[w].Y) / r.wheels[w].Q);
      }
    }
    if (step++ % 10 != 0) return;
    u.time.push_back(r.time);
    u.shift.push_back(1e3 * r.bodies[0].displacement[1]);
    for (std::size_t k = 0; k < 2; ++k) {
      u.side[k].push_back(mean[k]);
      u.least[k].push_back(1.0 - r.wheels[k].Q / static_load[k]);
    }
  };
  u.summary = run_scene(read_scene(file), observer);
  return u;
}

report::SvgPanel panel(const Unloading& u, const std::string& title, const std::array<std::vector<double>, 2>& data) {
  return {title, "time [s]", "unloading (Q0 − Q)/Q0", {{"left", u.time, data[0]}, {"right", u.time, data[1]}}, {}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: wind_earthquake_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::string folder = argv[1];
    std::ofstream csv(folder + "/wind_and_earthquake.csv");
    csv << "# Wheel unloading over time, made by tests/validation/wind_earthquake_figure from docs/examples\n"
           "scene,t_s,unloading_left,unloading_right,car_body_y_mm\n";
    std::ofstream extremes(folder + "/wind_and_earthquake_extremes.csv");
    extremes << "# Of all wheels and steps, made by tests/validation/wind_earthquake_figure from docs/examples\n"
                "scene,complete,t_s,unloading,Y_over_Q,halved_steps,stop_engaged_s\n";
    for (const std::string name : {"wind", "earthquake"}) {
      const Unloading u = run(std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/" + name + ".toml");
      extremes << fmt::format("{},{},{:.3f},{:.4f},{:.4f},{},{}\n", name, u.summary.complete ? 1 : 0, u.time.back(),
                              u.largest, u.derailment, u.summary.halved_steps,
                              u.summary.stops ? fmt::format("{:.3f}", u.summary.stops->first_time) : "");
      for (std::size_t i = 0; i < u.time.size(); i += 5) {
        csv << fmt::format("{},{:.3f},{:.4f},{:.4f},{:.2f}\n", name, u.time[i], u.side[0][i], u.side[1][i], u.shift[i]);
      }
      std::ofstream(folder + "/" + name + "_unloading.svg") << report::svg_figure(
          name == "wind" ? "A coach on a viaduct under a gust" : "A coach on a viaduct in an earthquake",
          {panel(u, "mean of all wheels of a side", u.side), panel(u, "first wheelset", u.least)}, 1);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
