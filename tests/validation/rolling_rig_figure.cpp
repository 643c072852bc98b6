// Rails over spans that turn, as on the rolling-stock test plant of [MontenegroCalcada2023, section 5], with a
// published coach on two pairs of profiles: car-body accelerations like Figs. 23, 24, 27 and 28 and contact forces like
// Fig. 25. Usage: rolling_rig_figure FOLDER TABLE TABLE, geometry tables of conic-arc-stand-in on JIS60-stand-in and of
// another pair. Writes rolling_rig.csv, rolling_rig_onset.csv, rolling_rig_{vertical,lateral,forces}.svg,
// rolling_rig_histories.csv and rolling_rig_histories_{vertical,lateral}.svg into the folder.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "flange_model.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/svg_figure.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"

namespace railtab {
namespace {

constexpr double amplitude = 0.008;     // m
constexpr double approach = 15.0;       // m before the first span that turns
constexpr double after = 1.5;           // s behind it
constexpr double half_distance = 9.0;   // m: rear bogie behind the car body's centre
constexpr double flange_angle = 0.3;    // rad: contact angles beyond it are flange contact
constexpr double gauge_corner = 0.022;  // m beside the rail's axis: patches beyond it are flange contact

/// How the wheel meets the rail in a run.
enum class WheelContactChoice {
  table,             ///< geometry table
  chords,            ///< online search, the root of the conic-arc wheel by two chords
  published_search,  ///< Eqs. 1 to 10
};

struct Case {
  SpanDeviationShape shape;
  SpanDeviationDirection direction;
  double span, kmh;
  std::filesystem::path table;
  WheelContactChoice contact = WheelContactChoice::table;
};

struct Result {
  std::string profiles;
  double largest = 0.0;              // acceleration above the rear bogie in the deviation's direction [m/s²]
  double Q_min = 1e9, Q_max = 0.0;   // right wheel of the first wheelset [N]
  double Y_min = 1e9, Y_max = -1e9;  // [N]
  double shift = 0.0;                // largest of a wheelset against the rails [m]
  bool flange = false, complete = false;
  report::Series acceleration, Q, Y;  // over time, from the first span on [m/s², kN]
};

SceneParameters scene_of(const Case& c) {
  SceneParameters scene;
  scene.train.vehicle = "chinese-high-speed-car";
  scene.train.geometric_stiffness = GeometricStiffness::omitted;  // as the published model
  scene.train.speed = c.kmh / 3.6;
  scene.train.start = -approach;
  scene.contact.table = c.table;
  if (c.contact == WheelContactChoice::published_search) {
    scene.contact.table.clear();
    scene.contact.mode = ContactMode::paper;
    scene.contact.wheel = "conic-arc-stand-in";
    scene.contact.rail = "JIS60-stand-in";
    scene.contact.dimensions.nominal_radius = 0.4575;
  }
  scene.track_kind = TrackKind::rigid;
  scene.span_deviation = SpanDeviationParameters{c.shape, c.direction, c.span, amplitude, 0.0, 0.0};
  const double spans = c.shape == SpanDeviationShape::bending ? 2.0 : 1.0;
  scene.integration.duration = (approach + 20.4 + spans * c.span) / scene.train.speed + after;
  scene.output.every = 1;
  return scene;
}

/// The model of the scene, with chords in place of the wheel's root where the case asks for them.
VsiModel model_of(const Case& c, const SceneParameters& scene) {
  VsiModel model = build_model(scene);
  if (c.contact != WheelContactChoice::chords) return model;
  const WheelRailPair& pair = model.geometry->pair();
  model.geometry = std::make_shared<const ContactGeometry>(ContactSearch(
      WheelRailPair(ProfileCurve(hunting::with_chords(pair.wheel().knots())), pair.rail(), pair.dimensions())));
  model.contact.geometry = model.geometry.get();
  return model;
}

bool on_flange(const WheelRecord& wheel) {
  return std::abs(wheel.angle) > flange_angle ||
         (wheel.second_normal_force > 0.0 && wheel.second_y_rail < -gauge_corner);
}

Result run(const Case& c) {
  const SceneParameters scene = scene_of(c);
  const VsiModel model = model_of(c, scene);
  const bool vertical = c.direction == SpanDeviationDirection::vertical;
  Result result;
  result.profiles = model.geometry->pair().wheel().knots().name + " on " + model.geometry->pair().rail().knots().name;
  std::vector<std::size_t> wheelsets;
  std::vector<double> offset;
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) {
    for (std::size_t i = 0; i < header.body_names.size(); ++i) {
      if (header.body_names[i].find("wheelset") == std::string::npos) continue;
      wheelsets.push_back(i);
      offset.push_back(header.body_x[i]);
    }
  };
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
    result.flange = result.flange || std::any_of(r.wheels.begin(), r.wheels.end(), on_flange);
    for (std::size_t i = 0; i < wheelsets.size(); ++i) {
      const double rail = model.rail_line(RailSide::right, r.position + offset[i]).y;
      result.shift = std::max(result.shift, std::abs(r.bodies[wheelsets[i]].displacement[1] - rail));
    }
    if (r.position < -5.0) return;
    const double time = r.time - approach / scene.train.speed;
    const std::array values{a, 1e-3 * wheel.Q, 1e-3 * wheel.Y};
    const std::array series{&result.acceleration, &result.Q, &result.Y};
    for (std::size_t k = 0; k < series.size(); ++k) {
      series[k]->x.push_back(time);
      series[k]->y.push_back(values[k]);
    }
  };
  result.complete = run_scene(scene, model, observer).complete;
  return result;
}

/// Least and largest value of every so many steps, for lines in figures.
report::Series thinned(const report::Series& series) {
  constexpr std::size_t steps = 10;
  report::Series result{series.label, {}, {}};
  for (std::size_t i = 0; i < series.x.size(); i += steps) {
    const auto begin = series.y.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = series.y.begin() + static_cast<std::ptrdiff_t>(std::min(i + steps, series.y.size()));
    auto [first, second] = std::minmax_element(begin, end);
    if (second < first) std::swap(first, second);
    for (const auto extreme : {first, second}) {
      result.x.push_back(series.x[static_cast<std::size_t>(extreme - series.y.begin())]);
      result.y.push_back(*extreme);
    }
  }
  return result;
}

/// The part of a line between two times.
report::Series between(const report::Series& series, double begin, double end) {
  report::Series result{series.label, {}, {}};
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (series.x[i] < begin || series.x[i] > end) continue;
    result.x.push_back(series.x[i]);
    result.y.push_back(series.y[i]);
  }
  return result;
}

constexpr double spans[] = {10.0, 20.0, 40.0, 60.0};
constexpr SpanDeviationShape shapes[] = {SpanDeviationShape::bending, SpanDeviationShape::parallel_shift};
constexpr SpanDeviationDirection directions[] = {SpanDeviationDirection::vertical, SpanDeviationDirection::lateral};

std::string name(SpanDeviationShape shape) { return shape == SpanDeviationShape::bending ? "BS" : "PS"; }
std::string name(SpanDeviationDirection direction) {
  return direction == SpanDeviationDirection::vertical ? "vertical" : "lateral";
}

/// Least lateral shift of the centred wheelset at which its flange touches [m].
double flange_gap(const std::filesystem::path& table) {
  const VsiModel model =
      build_model(scene_of({SpanDeviationShape::bending, SpanDeviationDirection::lateral, 20.0, 100.0, table}));
  const ContactSearch search(model.geometry->pair());
  for (double y = 0.0; y < 15e-3; y += 1e-5) {
    const double slope = search.first_touch(y, rigid_position(search, y, 0.0).roll, 0.0).z_touch_dy;
    if (std::abs(std::atan(slope)) > flange_angle) return y;
  }
  return std::nan("");
}

void all_cases(const std::string& folder, const std::vector<std::filesystem::path>& tables) {
  std::string csv =
      "# Largest car-body acceleration above the rear bogie, contact forces of the right wheel of the first wheelset,\n"
      "# and largest lateral shift of a wheelset against the rails, over spans that turn by 8 mm; made by\n"
      "# tests/validation/rolling_rig_figure\n"
      "profiles,direction,shape,span_m,V_kmh,acceleration_m_s2,Q_min_kN,Q_max_kN,Y_min_kN,Y_max_kN,shift_mm,flange,"
      "complete\n";
  std::string onset =
      "# Lowest of the speeds 100, 150, ... 400 km/h with flange contact over lateral deviations, 0: none, and the\n"
      "# lateral shift at which the flange touches; made by tests/validation/rolling_rig_figure\n"
      "profiles,shape,span_m,onset_kmh,gap_mm\n";
  for (const auto direction : directions) {
    std::vector<report::SvgPanel> panels;
    for (const std::filesystem::path& table : tables) {
      const double gap = 1e3 * flange_gap(table);
      for (const auto shape : shapes) {
        report::SvgPanel panel{"", "speed [km/h]", "acceleration [m/s²]", {}, {}};
        for (const double span : spans) {
          report::Series line{fmt::format("{:.0f} m", span), {}, {}};
          double first = 0.0;
          std::string profiles;
          for (double kmh = 100.0; kmh <= 400.0; kmh += 50.0) {
            const Result r = run({shape, direction, span, kmh, table});
            profiles = r.profiles;
            csv += fmt::format("{},{},{},{:.0f},{:.0f},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},{},{}\n", profiles,
                               name(direction), name(shape), span, kmh, r.largest, 1e-3 * r.Q_min, 1e-3 * r.Q_max,
                               1e-3 * r.Y_min, 1e-3 * r.Y_max, 1e3 * r.shift, r.flange ? 1 : 0, r.complete ? 1 : 0);
            if (r.flange && first == 0.0) first = kmh;
            line.x.push_back(kmh);
            line.y.push_back(r.complete ? r.largest : std::nan(""));
          }
          panel.title = fmt::format("{}, {}", name(shape), profiles);
          panel.lines.push_back(std::move(line));
          if (direction == SpanDeviationDirection::lateral)
            onset += fmt::format("{},{},{:.0f},{:.0f},{:.2f}\n", profiles, name(shape), span, first, gap);
        }
        panels.push_back(std::move(panel));
      }
    }
    const bool vertical = direction == SpanDeviationDirection::vertical;
    write_text_file(folder + "/rolling_rig_" + name(direction) + ".svg",
                    report::svg_figure(fmt::format("Fig. {}: largest {} car-body acceleration above the rear bogie",
                                                   vertical ? 27 : 28, name(direction)),
                                       panels, 2));
  }
  write_text_file(folder + "/rolling_rig.csv", csv);
  write_text_file(folder + "/rolling_rig_onset.csv", onset);
}

/// Figs. 23 and 24.
void histories(const std::string& folder, const std::vector<std::filesystem::path>& tables) {
  std::string csv =
      "# Car-body acceleration above the rear bogie at 300 km/h over spans that turn by 8 mm, time from the first\n"
      "# wheelset's arrival at the first span on; made by tests/validation/rolling_rig_figure\n"
      "direction,shape,span_m,profiles,t_s,acceleration_m_s2\n";
  for (const auto direction : directions) {
    std::vector<report::SvgPanel> panels;
    for (const auto shape : shapes) {
      for (const double span : {20.0, 40.0}) {
        report::SvgPanel panel{
            fmt::format("{}, span of {:.0f} m", name(shape), span), "time [s]", "acceleration [m/s²]", {}, {}};
        for (const std::filesystem::path& table : tables) {
          Result r = run({shape, direction, span, 300.0, table});
          r.acceleration.label = r.profiles;
          constexpr std::size_t every = 40;  // steps of 0.5 ms
          for (std::size_t i = 0; i < r.acceleration.x.size(); i += every) {
            csv += fmt::format("{},{},{:.0f},{},{:.3f},{:.4f}\n", name(direction), name(shape), span, r.profiles,
                               r.acceleration.x[i], r.acceleration.y[i]);
          }
          panel.lines.push_back(thinned(r.acceleration));
        }
        panels.push_back(std::move(panel));
      }
    }
    const bool vertical = direction == SpanDeviationDirection::vertical;
    write_text_file(folder + "/rolling_rig_histories_" + name(direction) + ".svg",
                    report::svg_figure(fmt::format("Fig. {}: {} car-body acceleration above the rear bogie at 300 km/h",
                                                   vertical ? 23 : 24, name(direction)),
                                       panels, 2));
  }
  write_text_file(folder + "/rolling_rig_histories.csv", csv);
}

/// Fig. 25.
void forces(const std::string& folder, const std::vector<std::filesystem::path>& tables) {
  std::string csv =
      "# Contact forces of the right wheel of the first wheelset at 300 km/h, BS, by wheel and contact search; made "
      "by\n"
      "# tests/validation/rolling_rig_figure\n"
      "direction,span_m,contact,Q_min_kN,Q_max_kN,Y_min_kN,Y_max_kN,shift_mm,flange,complete\n";
  struct Choice {
    const char* label;
    const std::filesystem::path& table;
    WheelContactChoice contact;
  };
  const Choice choices[] = {{"realistic wheel", tables[0], WheelContactChoice::table},
                            {"simplified wheel", tables[0], WheelContactChoice::chords},
                            {"published search", tables[0], WheelContactChoice::published_search},
                            {"LMA-type on CHN60", tables[1], WheelContactChoice::table}};
  std::vector<report::SvgPanel> panels;
  report::SvgPanel impact_Y{"Lateral force, lateral deviation, BS of 20 m: impact", "time [s]", "Y [kN]", {}, {}};
  report::SvgPanel impact_Q{"Vertical force, lateral deviation, BS of 20 m: impact", "time [s]", "Q [kN]", {}, {}};
  for (const auto direction : directions) {
    const bool vertical = direction == SpanDeviationDirection::vertical;
    for (const double span : {20.0, 40.0}) {
      report::SvgPanel panel{fmt::format("{} force, {} deviation, BS of {:.0f} m", vertical ? "Vertical" : "Lateral",
                                         name(direction), span),
                             "time [s]",
                             vertical ? "Q [kN]" : "Y [kN]",
                             {},
                             {}};
      for (const Choice& choice : choices) {
        Result r = run({SpanDeviationShape::bending, direction, span, 300.0, choice.table, choice.contact});
        csv += fmt::format("{},{:.0f},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},{},{}\n", name(direction), span,
                           choice.label, 1e-3 * r.Q_min, 1e-3 * r.Q_max, 1e-3 * r.Y_min, 1e-3 * r.Y_max, 1e3 * r.shift,
                           r.flange ? 1 : 0, r.complete ? 1 : 0);
        report::Series& line = vertical ? r.Q : r.Y;
        line.label = choice.label;
        panel.lines.push_back(thinned(line));
        if (vertical || span > 20.0) continue;
        constexpr double begin = 0.29, end = 0.36;  // s: the first impact
        impact_Y.lines.push_back(between(r.Y, begin, end));
        r.Q.label = choice.label;
        impact_Q.lines.push_back(between(r.Q, begin, end));
      }
      panels.push_back(std::move(panel));
    }
  }
  panels.push_back(std::move(impact_Y));
  panels.push_back(std::move(impact_Q));
  write_text_file(folder + "/rolling_rig_forces.csv", csv);
  write_text_file(
      folder + "/rolling_rig_forces.svg",
      report::svg_figure("Fig. 25: contact forces of the right wheel of the first wheelset at 300 km/h", panels, 2));
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: rolling_rig_figure FOLDER TABLE TABLE\n", stderr);
    return 2;
  }
  try {
    const std::vector<std::filesystem::path> tables{argv[2], argv[3]};
    railtab::forces(argv[1], tables);
    railtab::histories(argv[1], tables);
    railtab::all_cases(argv[1], tables);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "rolling_rig_figure: %s\n", e.what());
    return 1;
  }
}
