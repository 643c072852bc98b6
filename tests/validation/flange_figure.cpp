// Hunting with flanges, like Figs. 19 and 20 of [MontenegroCalcada2023]: lateral shift and lateral force of model C
// with realistic and simplified wheels beside the equations of motion. Writes hunting_flange.csv and hunting_flange.svg
// into the folder given.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "flange_model.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "svg_figure.hpp"

namespace {

using namespace railtab;
using namespace railtab::hunting;

constexpr double time_step = 1e-3, duration = 3.6, forces_from = 2.4;  // s
constexpr std::size_t every = 2;                                       // steps between rows

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
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: flange_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    write(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "flange_figure: %s\n", e.what());
    return 1;
  }
}
