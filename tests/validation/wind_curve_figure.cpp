// Characteristic wind curves: the speed of wind from the side at which a wheel is unloaded by 90 %, over the speed of
// travel, of docs/examples/wind_curve.toml with two of the library's vehicles: in the scene's gust, in one five times
// as long, and by the closed form of a train that does not lean. Writes wind_curves.csv and wind_curves.svg into the
// folder given.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "railtab/runtime/line/wind_load.hpp"
#include "railtab/runtime/reliability/threshold_search.hpp"
#include "railtab/runtime/report/svg_figure.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace {

using namespace railtab;

constexpr double limit = 0.9, beyond = std::numeric_limits<double>::infinity();
constexpr double wind_step = 0.25;  // m/s
constexpr std::size_t winds = 321;  // up to 80 m/s

struct Vehicle {
  std::string name;
  double radius;  // of its wheels [m]
};

SceneParameters scene_of(const Vehicle& vehicle, double speed_kmh) {
  return read_scene(std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/wind_curve.toml",
                    {{"train.vehicle", fmt::format("\"{}\"", vehicle.name)},
                     {"train.speed_kmh", fmt::format("{}", speed_kmh)},
                     {"contact.dimensions.nominal_radius", fmt::format("{}", vehicle.radius)}});
}

double unloading(const StepRecord& record, const std::vector<double>& static_load) {
  double largest = 0.0;
  for (std::size_t w = 0; w < record.wheels.size(); ++w) {
    largest = std::max(largest, 1.0 - record.wheels[w].Q / static_load[w]);
  }
  return largest;
}

/// In a gust (1 − cos)/2 that rises within half of its duration [s].
double in_gust(SceneParameters scene, double wind, double duration) {
  scene.loads[0].wind_speed = wind;
  scene.loads[0].gust_duration = duration;
  scene.integration.duration = scene.loads[0].start + 0.5 * duration + 1.5;
  std::vector<double> static_load;
  double largest = 0.0;
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) { static_load = header.static_wheel_load; };
  observer.record = [&](const StepRecord& record) { largest = std::max(largest, unloading(record, static_load)); };
  return run_scene(scene, observer).complete ? largest : beyond;
}

/// (M + F_z s/2)/(n s/2 Q0), with s = 1.5 m between the contact points of the wheels and n/2 wheels on each side.
double without_leaning(const SceneParameters& scene, double wind) {
  const VsiModel model = build_model(scene);
  const LoadParameters& load = scene.loads[0];
  Aerodynamics coefficients = read_aerodynamics(load.aerodynamics);
  coefficients.area = load.area;
  coefficients.length = load.length;
  const ForceAndMoment at_rails =
      wind_load(coefficients, {load.wind_direction * std::numbers::pi / 180.0}, model.contact.speed, wind, 0.0);
  constexpr double between = 1.5;  // m
  const double wheels = 2.0 * static_cast<double>(model.vehicle.wheelsets.size());
  return (at_rails[3] / (0.5 * between) - at_rails[2]) / (wheels * static_wheel_load(model.vehicle, 0));
}

/// Wind speed at which the unloading reaches the limit [m/s].
template <class Unloading>
double threshold(const Unloading& of_wind) {
  const auto values = [&](const std::vector<SearchPoint>& points) {
    std::vector<double> found;
    for (const SearchPoint& p : points) found.push_back(of_wind(wind_step * static_cast<double>(p.point)));
    return found;
  };
  const ThresholdSearch search = search_thresholds(1, winds, limit, values).front();
  if (search.reached == 0 || search.reached == winds) return std::numeric_limits<double>::quiet_NaN();
  const double below = search.values.at(search.reached - 1), at = search.values.at(search.reached);
  if (!std::isfinite(at)) return std::numeric_limits<double>::quiet_NaN();
  return wind_step * (static_cast<double>(search.reached - 1) + (limit - below) / (at - below));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: wind_curve_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::string folder = argv[1];
    std::ofstream csv(folder + "/wind_curves.csv");
    csv << "# Wind at which a wheel is unloaded by 90 %, made by tests/validation/wind_curve_figure\n"
           "vehicle,speed_kmh,without_leaning,gust_20s,gust_4s\n";
    std::vector<report::SvgPanel> panels;
    for (const Vehicle& vehicle : {Vehicle{"manchester-coach", 0.46}, Vehicle{"china-star-power-car", 0.525}}) {
      std::vector<double> speeds, upright, slow, gust;
      for (double speed = 40.0; speed <= 200.0; speed += 40.0) {
        const SceneParameters scene = scene_of(vehicle, speed);
        speeds.push_back(speed);
        upright.push_back(threshold([&](double wind) { return without_leaning(scene, wind); }));
        slow.push_back(threshold([&](double wind) { return in_gust(scene, wind, 20.0); }));
        gust.push_back(threshold([&](double wind) { return in_gust(scene, wind, 4.0); }));
        csv << fmt::format("{},{:.0f},{:.2f},{:.2f},{:.2f}\n", vehicle.name, speed, upright.back(), slow.back(),
                           gust.back());
      }
      panels.push_back({vehicle.name,
                        "speed of travel [km/h]",
                        "speed of the wind [m/s]",
                        {{"does not lean, constant wind", speeds, upright},
                         {"gust of 20 s", speeds, slow},
                         {"gust of 4 s", speeds, gust}},
                        {}});
    }
    std::ofstream(folder + "/wind_curves.svg") << report::svg_figure("Characteristic wind curves", panels, 2);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
