// Hunting with flanges, like Figs. 19 and 20 of [MontenegroCalcada2023]: lateral shift and lateral force of model C
// with realistic and simplified wheels beside the equations of motion; wheel and rail in the run without and with
// flange contact; first flange contact by the yaw of the start. Writes hunting_flange.csv, hunting_flange.svg,
// hunting_profiles.svg and hunting_start.csv into the folder given.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flange_model.hpp"
#include "profile_drawing.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/svg_figure.hpp"

namespace railtab::hunting {
namespace {

constexpr double time_step = 1e-3, duration = 3.6, forces_from = 2.4;  // s
constexpr std::size_t every = 2;                                       // steps between rows

/// In mm from the rail's crown, and above it.
constexpr DrawingWindow head{-62.0, 42.0, -32.0, 18.0}, root{-50.0, -28.0, -12.0, 0.0};

/// The left wheel where the run has it at a record, seen from behind.
report::SvgPanel left_wheel(const std::string& title, const FlangeRun& run, std::size_t i) {
  const WheelRailPair pair = flanged_pair(FlangeRoot::realistic);
  Outline wheel = outline_of(pair.wheel());
  for (std::size_t k = 0; k < wheel.y.size(); ++k) {
    // From the wheelset's centre, as a right wheel: shift and roll change their signs.
    const double y = pair.tape_circle_offset() + wheel.y[k], z = pair.nominal_radius() + wheel.z[k];
    const double roll = -run.roll[i];
    wheel.y[k] = y * std::cos(roll) - z * std::sin(roll) - run.y[i] - pair.rail_offset();
    wheel.z[k] = y * std::sin(roll) + z * std::cos(roll) + run.z[i] - pair.nominal_radius();
  }
  return {fmt::format("{}, t = {:.3f} s", title, run.t[i]),
          "from the crown, to the right [mm]",
          "above the rail [mm]",
          {drawing("left wheel", wheel, -1.0, head), drawing("rail", outline_of(pair.rail()), -1.0, head)},
          {},
          report::SvgScale::equal};
}

/// Record of the largest lateral force on the left rail in the first impact of the left flange, and the last one before
/// it at which the wheelset passed the track's centre.
std::pair<std::size_t, std::size_t> left_impact(const FlangeRun& run) {
  const auto impact =
      std::find_if(run.impacts.begin(), run.impacts.end(), [](const auto& i) { return i.approach < 0; });
  if (impact == run.impacts.end()) throw std::runtime_error("no impact of the left flange");
  std::size_t largest = 0, centre = 0;
  for (std::size_t i = 1; i < run.t.size() && run.t[i] <= impact->end; ++i) {
    if (run.t[i] < impact->begin && run.y[i - 1] * run.y[i] <= 0.0) centre = i;
    if (run.t[i] >= impact->begin && (largest == 0 || std::abs(run.Y_left[i]) > std::abs(run.Y_left[largest])))
      largest = i;
  }
  return {centre, largest};
}

void write_profiles(const std::string& folder, const FlangeRun& realistic) {
  const auto [centre, impact] = left_impact(realistic);
  const WheelRailPair smooth = flanged_pair(FlangeRoot::realistic), chords = flanged_pair(FlangeRoot::simplified);
  const auto placed = [](const WheelRailPair& pair) {  // where the centred wheelset stands
    Outline wheel = outline_of(pair.wheel());
    const double z = rigid_position(ContactSearch(pair), 0.0, 0.0).z;
    for (double& y : wheel.y) y += pair.tape_circle_offset() - pair.rail_offset();
    for (double& height : wheel.z) height += z;
    return wheel;
  };
  const auto both = [&](const std::string& title, const DrawingWindow& window) {
    return report::SvgPanel{title,
                            "from the crown, to the right [mm]",
                            "above the rail [mm]",
                            {drawing("realistic wheel", placed(smooth), 1.0, window),
                             drawing("rail", outline_of(smooth.rail()), 1.0, window),
                             drawing("simplified wheel", placed(chords), 1.0, window)},
                            {},
                            report::SvgScale::equal};
  };
  write_text_file(
      folder + "/paper/hunting_profiles.svg",
      report::svg_figure("Stand-in profiles of model C: conic-arc-stand-in on JIS60-stand-in 1:40",
                         {left_wheel("Fig. 19c: flange clear", realistic, centre),
                          left_wheel("Fig. 19d: flange impact", realistic, impact),
                          both("Fig. 20c: right wheel, centred", head), both("Fig. 20c, root of the wheel", root)},
                         2));
}

void write_starts(const std::string& folder) {
  std::string csv =
      "# Model C at 250 km/h by the yaw of the start: how far the wheelset swings at first; first flange contact, the\n"
      "# lateral shift then and the largest lateral force of that impact, of the realistic and the simplified wheel; "
      "made\n"
      "# by tests/validation/flange_figure\n"
      "start_yaw_mrad,first_swing_mm,touch_s,touch_simplified_s,shift_mm,shift_simplified_mm,Y_kN,Y_simplified_kN\n";
  for (const double yaw : {0.2e-3, 0.4e-3, 0.6e-3, 0.8e-3, 1.0e-3, 1.2e-3}) {
    constexpr double first_swing = 0.25, longest = 9.0;  // s
    const auto run = [&](FlangeRoot wheel) {
      return run_flanged(flanged_wheelset(wheel), ContactForceRule::energy, time_step, yaw, longest);
    };
    const FlangeRun runs[] = {run(FlangeRoot::realistic), run(FlangeRoot::simplified)};
    const auto shift_at_touch = [](const FlangeRun& r) {
      const auto i = std::lower_bound(r.t.begin(), r.t.end(), r.impacts.at(0).begin - 1e-9) - r.t.begin();
      return 1e3 * std::abs(r.y[static_cast<std::size_t>(i)]);
    };
    double swing = 0.0;
    for (std::size_t i = 0; runs[0].t[i] < first_swing; ++i) swing = std::max(swing, std::abs(runs[0].y[i]));
    csv +=
        fmt::format("{:.1f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.1f},{:.1f}\n", 1e3 * yaw, 1e3 * swing,
                    runs[0].impacts.at(0).begin, runs[1].impacts.at(0).begin, shift_at_touch(runs[0]),
                    shift_at_touch(runs[1]), 1e-3 * runs[0].impacts[0].largest_Y, 1e-3 * runs[1].impacts[0].largest_Y);
  }
  write_text_file(folder + "/paper/hunting_start.csv", csv);
}

void write(const std::string& folder) {
  const FlangeRun realistic = run_flanged(flanged_wheelset(FlangeRoot::realistic), ContactForceRule::energy, time_step,
                                          flange_start_yaw, duration);
  const FlangeRun simplified = run_flanged(flanged_wheelset(FlangeRoot::simplified), ContactForceRule::energy,
                                           time_step, flange_start_yaw, duration);
  const EquationsOfMotion equations(flange_speed);
  EquationsOfMotion::State s{0.0, flange_speed * flange_start_yaw, flange_start_yaw, 0.0};

  std::string csv =
      "# Hunting of model C at 250 km/h, made by tests/validation/flange_figure: lateral shift of the wheelset and "
      "lateral "
      "force\n# on the right rail, both to the right\n"
      "t_s,y_equations_mm,y_realistic_mm,y_simplified_mm,Y_realistic_kN,Y_simplified_kN\n";
  std::vector<report::Series> shift{{"realistic", {}, {}}, {"simplified", {}, {}}, {"equations of motion", {}, {}}};
  std::vector<report::Series> force{{"realistic", {}, {}}, {"simplified", {}, {}}};
  for (std::size_t i = 0; i < realistic.t.size(); ++i) {
    const double t = realistic.t[i];
    if (i % every == 0) {
      csv += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{:.2f},{:.2f}\n", t, 1e3 * s[0], 1e3 * realistic.y[i],
                         1e3 * simplified.y[i], 1e-3 * realistic.Y_right[i], 1e-3 * simplified.Y_right[i]);
      const double y[] = {realistic.y[i], simplified.y[i], s[0]};
      for (std::size_t k = 0; k < shift.size(); ++k) {
        shift[k].x.push_back(t);
        shift[k].y.push_back(1e3 * y[k]);
      }
    }
    if (t >= forces_from) {
      const double Y[] = {realistic.Y_right[i], simplified.Y_right[i]};
      for (std::size_t k = 0; k < force.size(); ++k) {
        force[k].x.push_back(t);
        force[k].y.push_back(1e-3 * Y[k]);
      }
    }
    for (int k = 0; k < 10; ++k) equations.step(0.1 * time_step, s);
  }
  write_text_file(folder + "/hunting_flange.csv", csv);
  write_text_file(folder + "/hunting_flange.svg",
                  report::svg_figure("Hunting with flanges at 250 km/h",
                                     {{"Lateral shift of the wheelset", "time [s]", "y [mm]", shift, {}},
                                      {"Lateral force on the right rail", "time [s]", "Y [kN]", force, {}}},
                                     1));
  write_profiles(folder, realistic);
  write_starts(folder);
}

}  // namespace
}  // namespace railtab::hunting

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: flange_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    railtab::hunting::write(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "flange_figure: %s\n", e.what());
    return 1;
  }
}
