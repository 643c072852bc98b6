// Rails over spans that turn, as on the rolling-stock test plant of [MontenegroCalcada2023, section 5], with a
// published coach: largest car-body accelerations like Figs. 27 and 28 and contact forces like Fig. 25. Writes
// rolling_rig.csv, rolling_rig_vertical.svg, rolling_rig_lateral.svg and rolling_rig_forces.svg into the folder given.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "svg_figure.hpp"

namespace {

using namespace railtab;

constexpr double amplitude = 0.008;    // m
constexpr double approach = 15.0;      // m before the first span that turns
constexpr double after = 1.5;          // s behind it
constexpr double half_distance = 9.0;  // m: rear bogie behind the car body's centre

struct Case {
  SpanDeviationShape shape;
  SpanDeviationDirection direction;
  double span, kmh;
};

struct Result {
  double largest = 0.0;              // acceleration above the rear bogie in the deviation's direction [m/s²]
  double Q_min = 1e9, Q_max = 0.0;   // right wheel of the first wheelset [N]
  double Y_min = 1e9, Y_max = -1e9;  // [N]
  bool complete = false;
  report::Series Q, Y;  // of that wheel over time, from the first span on [kN]
};

SceneParameters scene_of(const Case& c) {
  SceneParameters scene;
  scene.train.vehicle = "chinese-high-speed-car";
  scene.train.geometric_stiffness = GeometricStiffness::omitted;  // as the published model
  scene.train.speed = c.kmh / 3.6;
  scene.train.start = -approach;
  // What moves the coach vertically is the line of the rails alone: the lean contact, of which Hertz's differs by
  // microns.
  if (c.direction == SpanDeviationDirection::vertical) scene.contact.normal = NormalContact::rigid;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";  // of the committed figures
  scene.contact.wheel = "LMA-type";
  scene.contact.rail = "CHN60";
  scene.contact.dimensions.nominal_radius = 0.4575;
  scene.contact.dimensions.flange_back = 1.353;
  scene.track_kind = TrackKind::rigid;
  scene.span_deviation = SpanDeviationParameters{c.shape, c.direction, c.span, amplitude, 0.0, 0.0};
  scene.integration.time_step = 1e-3;
  const double spans = c.shape == SpanDeviationShape::bending ? 2.0 : 1.0;
  scene.integration.duration = (approach + 20.4 + spans * c.span) / scene.train.speed + after;
  return scene;
}

Result run(const Case& c) {
  const SceneParameters scene = scene_of(c);
  const bool vertical = c.direction == SpanDeviationDirection::vertical;
  Result result;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    // u + θ × r at r = (−half_distance, 0, 0): above the rear bogie at the height of the centre of gravity
    const MotionRecord& car = r.bodies[0];
    const double a = vertical ? car.acceleration[2] + half_distance * car.acceleration[4]
                              : car.acceleration[1] - half_distance * car.acceleration[5];
    result.largest = std::max(result.largest, std::abs(a));
    const WheelRecord& wheel = r.wheels[1];
    result.Q_min = std::min(result.Q_min, wheel.Q);
    result.Q_max = std::max(result.Q_max, wheel.Q);
    result.Y_min = std::min(result.Y_min, wheel.Y);
    result.Y_max = std::max(result.Y_max, wheel.Y);
    if (r.position < -5.0) return;
    result.Q.x.push_back(r.time - approach / scene.train.speed);
    result.Q.y.push_back(1e-3 * wheel.Q);
    result.Y.x.push_back(result.Q.x.back());
    result.Y.y.push_back(1e-3 * wheel.Y);
  };
  result.complete = run_scene(scene, observer).complete;
  return result;
}

constexpr double spans[] = {10.0, 20.0, 40.0, 60.0};

std::string name(SpanDeviationShape shape) { return shape == SpanDeviationShape::bending ? "BS" : "PS"; }

void all_cases(const std::string& folder) {
  std::ofstream csv(folder + "/rolling_rig.csv");
  csv << "# Largest car-body acceleration above the rear bogie, and contact forces of the right wheel of the first\n"
         "# wheelset, over spans that turn by 8 mm; made by tests/validation/rolling_rig_figure\n"
         "direction,shape,span_m,V_kmh,acceleration_m_s2,Q_min_kN,Q_max_kN,Y_min_kN,Y_max_kN,complete\n";
  for (const auto direction : {SpanDeviationDirection::vertical, SpanDeviationDirection::lateral}) {
    const bool vertical = direction == SpanDeviationDirection::vertical;
    std::vector<report::SvgPanel> panels;
    for (const auto shape : {SpanDeviationShape::bending, SpanDeviationShape::parallel_shift}) {
      report::SvgPanel panel{name(shape), "speed [km/h]", "acceleration [m/s²]", {}, {}};
      for (const double span : spans) {
        report::Series line{fmt::format("{:.0f} m", span), {}, {}};
        for (double kmh = 100.0; kmh <= 400.0; kmh += 50.0) {
          const Result r = run({shape, direction, span, kmh});
          csv << fmt::format("{},{},{:.0f},{:.0f},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f},{}\n",
                             vertical ? "vertical" : "lateral", name(shape), span, kmh, r.largest, 1e-3 * r.Q_min,
                             1e-3 * r.Q_max, 1e-3 * r.Y_min, 1e-3 * r.Y_max, r.complete ? 1 : 0);
          csv.flush();
          line.x.push_back(kmh);
          line.y.push_back(r.complete ? r.largest : std::nan(""));
        }
        panel.lines.push_back(std::move(line));
      }
      panels.push_back(std::move(panel));
    }
    const std::string direction_name = vertical ? "vertical" : "lateral";
    std::ofstream(folder + "/rolling_rig_" + direction_name + ".svg") << report::svg_figure(
        fmt::format("Largest {} car-body acceleration above the rear bogie", direction_name), panels, 2);
  }
}

void forces(const std::string& folder) {
  std::vector<report::SvgPanel> panels;
  for (const auto direction : {SpanDeviationDirection::vertical, SpanDeviationDirection::lateral}) {
    const bool vertical = direction == SpanDeviationDirection::vertical;
    for (const double span : {20.0, 40.0}) {
      Result r = run({SpanDeviationShape::bending, direction, span, 300.0});
      report::Series& line = vertical ? r.Q : r.Y;
      line.label = vertical ? "Q" : "Y";
      panels.push_back({fmt::format("{} force, BS, {:.0f} m", vertical ? "vertical" : "lateral", span),
                        "time [s]",
                        "force [kN]",
                        {line},
                        {}});
    }
  }
  std::ofstream(folder + "/rolling_rig_forces.svg")
      << report::svg_figure("Contact forces of the right wheel of the first wheelset at 300 km/h", panels, 2);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: rolling_rig_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    forces(argv[1]);
    all_cases(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
