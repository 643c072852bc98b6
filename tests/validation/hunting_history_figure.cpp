// Histories of the suspended wheelset like Figs. 15 to 18a of [MontenegroCalcada2023], models A and B, beside its
// equations of motion (Eq. 18), and the wavelengths of both. Usage: hunting_history_figure FOLDER, which writes
// hunting_histories.csv, hunting_histories.svg, hunting_waves.csv and hunting_critical.csv there.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "../reference_table.hpp"
#include "hunting_model.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/report/svg_figure.hpp"
#include "runge_kutta.hpp"

namespace railtab::hunting {
namespace {

constexpr double G = 82e9, ab = 5.667e-3 * 4.284e-3;                  // Pa, m²
constexpr double fx = G * 4.523 * ab, fy = G * 4.121 * ab;            // N
constexpr double gamma0 = 0.025, kx = 135e3, ky = 250e3;              // -, N/m
constexpr double m = 1568.0, Iz = 656.0;                              // kg, kg m²
constexpr double impulse = 10.0;                                      // N s: 10 kN in one step of 1 ms
constexpr double critical_kmh = 234.956;                              // of Eq. 18
constexpr double resolved = 0.06, resolved_step = 2e-5, step = 1e-3;  // s: how creep stops the wheelset, and the rest
constexpr int shown_every = 5;                                        // steps between points of the figure

/// Eq. 18. State: y, y', yaw, yaw'.
class Equations {
 public:
  Equations(Suspension suspension, double speed) : V_(speed), sprung_(suspension == Suspension::primary ? 1.0 : 0.0) {}
  using State = std::array<double, 4>;
  void step(double dt, State& s) const {
    runge_kutta_step([this](const State& at) { return rate(at); }, dt, s);
  }

 private:
  [[nodiscard]] State rate(const State& s) const {
    return {
        s[1], (-2.0 / V_ * fy * s[1] - 2.0 * sprung_ * ky * s[0] + 2.0 * fy * s[2]) / m, s[3],
        (-2.0 / V_ * Lcp * Lcp * fx * s[3] - 2.0 * Lcp * gamma0 / R0 * fx * s[0] - 2.0 * sprung_ * kx * l * l * s[2]) /
            Iz};
  }
  double V_, sprung_;
};

/// Eq. 20; with stiffnesses of zero Klingel's wavelength, Eq. 17 [m].
double eq_20(Suspension suspension) {
  const double k = suspension == Suspension::primary ? 1.0 : 0.0;
  const double half = k * kx / (2.0 * fx) - k * ky / (2.0 * fy);
  return 2.0 * std::numbers::pi / std::sqrt(gamma0 / (Lcp * R0) - half * half);
}

/// Wavelength of Eq. 18 at a speed: zeros of the lateral shift after the first wave [m].
double wavelength_of_equations(Suspension suspension, double speed) {
  const Equations equations(suspension, speed);
  Equations::State s{0.0, impulse / m, 0.0, 0.0};
  constexpr double dt = 1e-4;  // s
  std::vector<double> zeros;
  for (long i = 0; zeros.size() < 7; ++i) {
    const double before = s[0];
    equations.step(dt, s);
    if (static_cast<double>(i) * dt * speed > 12.0 && before * s[0] < 0.0)
      zeros.push_back((static_cast<double>(i) + before / (before - s[0])) * dt);
  }
  return speed * (zeros.back() - zeros.front()) / 3.0;
}

struct Case {
  const char* figure;
  Suspension suspension;
  double kmh, duration;
  double paper_m, paper_theory_m;  ///< wavelength, Eq. 20 as the paper gives them; 0: none
};

const std::vector<Case> cases{{"15a", Suspension::none, 20.0, 12.0, 22.639, 22.745},
                              {"15b", Suspension::none, 100.0, 5.0, 22.639, 22.745},
                              {"16", Suspension::primary, 100.0, 5.0, 22.583, 22.754},
                              {"17", Suspension::primary, 250.0, 5.0, 22.708, 22.754},
                              {"18a", Suspension::primary, critical_kmh, 5.0, 0.0, 22.754}};

struct History {
  report::Series y{"railtab", {}, {}}, yaw{"railtab", {}, {}};  // mm, mrad
  report::Series y_eq{"Eq. 18", {}, {}}, yaw_eq{"Eq. 18", {}, {}};
  double y_difference = 0.0, yaw_difference = 0.0;  // largest, of the largest value [%]
};

Motion motion_of(const Case& c) {
  const VsiModel model = wheelset({.suspension = c.suspension}, c.kmh / 3.6);
  VsiState state(model);
  if (!static_equilibrium(model, state).converged) throw std::runtime_error("no equilibrium");
  LinearMotion& wheels = state.vehicle[0];
  const int y = model.vehicle.dof[1][1];
  wheels.velocity[y] = impulse / m;
  wheels.acceleration[y] = -2.0 * fy * wheels.velocity[y] / (c.kmh / 3.6) / m;  // that belongs to it by creep
  Motion motion;
  run(model, resolved_step, resolved, static_cast<int>(std::round(step / resolved_step)), state, motion);
  run(model, step, c.duration, 1, state, motion);
  return motion;
}

History history(const Case& c) {
  const Motion motion = motion_of(c);
  const Equations equations(c.suspension, c.kmh / 3.6);
  Equations::State s{0.0, impulse / m, 0.0, 0.0};
  History result;
  double y_peak = 0.0, yaw_peak = 0.0, time = 0.0;
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const auto parts = std::lround((motion.t[i] - time) / 2e-5);
    for (long k = 0; k < parts; ++k) equations.step((motion.t[i] - time) / static_cast<double>(parts), s);
    time = motion.t[i];
    y_peak = std::max(y_peak, std::abs(s[0]));
    yaw_peak = std::max(yaw_peak, std::abs(s[2]));
    result.y_difference = std::max(result.y_difference, std::abs(motion.y[i] - s[0]));
    result.yaw_difference = std::max(result.yaw_difference, std::abs(motion.yaw[i] - s[2]));
    if (i % shown_every != 0) continue;
    const std::array values{1e3 * motion.y[i], 1e3 * motion.yaw[i], 1e3 * s[0], 1e3 * s[2]};
    const std::array series{&result.y, &result.yaw, &result.y_eq, &result.yaw_eq};
    for (std::size_t k = 0; k < series.size(); ++k) {
      series[k]->x.push_back(time);
      series[k]->y.push_back(values[k]);
    }
  }
  result.y_difference *= 100.0 / y_peak;
  result.yaw_difference *= 100.0 / yaw_peak;
  return result;
}

/// Every n-th point, so that circles stay apart.
report::Series thinned(const report::Series& series) {
  report::Series result{series.label, {}, {}};
  const std::size_t n = std::max<std::size_t>(1, series.x.size() / 100);
  for (std::size_t i = 0; i < series.x.size(); i += n) {
    result.x.push_back(series.x[i]);
    result.y.push_back(series.y[i]);
  }
  return result;
}

/// Eq. 19 with the half distance of the suspensions in it [km/h].
/// @param sign of the last bracket: +1 as printed, -1 corrected
double eq_19(double sign) {
  const double A = m * l * l / fy, B = Iz / fx, p = ky / fy, q = kx / fx;
  const double last = A * q + sign * B * p;
  return 3.6 * std::sqrt(2.0 * l * l * (p + q) * (A + B) / ((A + B) * (A + B) * gamma0 / (Lcp * R0) - last * last));
}

/// Eq. 18's stability boundary by Routh's criterion [km/h].
double routh() {
  const double A = m * Lcp * Lcp / fy, B = Iz / fx, p = ky / fy, q = kx * l * l / (Lcp * Lcp * fx);
  const double last = A * q - B * p;
  return 3.6 * std::sqrt(2.0 * Lcp * Lcp * (p + q) * (A + B) / ((A + B) * (A + B) * gamma0 / (Lcp * R0) - last * last));
}

void write_critical(const std::string& folder) {
  constexpr Assumptions all{.roll = Roll::free,
                            .spin = Spin::included,
                            .gravitational_stiffness = GravitationalStiffness::included,
                            .gyroscopic_moments = GyroscopicMoments::included};
  const std::string csv = fmt::format(
      "# Critical speed of model B; made by tests/validation/hunting_history_figure\n"
      "by,V_kmh\n"
      "Eq. 19 as printed,{:.3f}\nEq. 19 with the sign corrected,{:.3f}\nRouth's criterion for Eq. 18,{:.3f}\n"
      "railtab under the assumptions of Eq. 18,{:.3f}\nrailtab with roll free,{:.3f}\nrailtab with all terms,{:.3f}\n",
      eq_19(1.0), eq_19(-1.0), routh(), critical_speed({}, 230.0), critical_speed({.roll = Roll::free}, 230.0),
      critical_speed(all, 240.0));
  write_text_file(folder + "/hunting_critical.csv", csv);
}

void write(const std::string& folder) {
  write_critical(folder);
  std::string waves =
      "# Hunting of the suspended wheelset under the assumptions of Eq. 18: wavelengths of railtab, with roll free "
      "too, of\n"
      "# Eq. 18 and Eq. 20 (G = 82 GPa), and the paper's; largest differences of the histories from Eq. 18, of their\n"
      "# peak; made by tests/validation/hunting_history_figure\n"
      "figure,model,V_kmh,wavelength_m,roll_free_m,eq_18_m,eq_20_m,paper_m,paper_eq_20_m,y_percent,yaw_percent\n";
  std::string csv =
      "# Lateral shift and yaw after an impulse of 10 N s; made by tests/validation/hunting_history_figure\n"
      "figure,t_s,y_mm,yaw_mrad,y_eq_18_mm,yaw_eq_18_mrad\n";
  std::vector<report::SvgPanel> panels;
  report::SvgPanel three{"Fig. 18a: lateral shift at three speeds, model B", "time [s]", "y [mm]", {}, {}};
  for (const Case& c : cases) {
    const History h = history(c);
    const bool sprung = c.suspension == Suspension::primary;
    const auto wave = [&](Roll roll) {
      return oscillation(wheelset({.suspension = c.suspension, .roll = roll}, c.kmh / 3.6), 3).wavelength;
    };
    waves += fmt::format(
        "{},{},{:.3f},{:.4f},{:.4f},{:.4f},{:.4f},{},{:.3f},{:.3f},{:.3f}\n", c.figure, sprung ? "B" : "A", c.kmh,
        wave(Roll::held), wave(Roll::free), wavelength_of_equations(c.suspension, c.kmh / 3.6), eq_20(c.suspension),
        c.paper_m > 0.0 ? fmt::format("{:.3f}", c.paper_m) : "", c.paper_theory_m, h.y_difference, h.yaw_difference);
    for (std::size_t i = 0; i < h.y.x.size(); i += 4) {
      csv += fmt::format("{},{:.3f},{:.6f},{:.6f},{:.6f},{:.6f}\n", c.figure, h.y.x[i], h.y.y[i], h.yaw.y[i],
                         h.y_eq.y[i], h.yaw_eq.y[i]);
    }
    const std::string at = fmt::format("model {}, {:.0f} km/h", sprung ? "B" : "A", c.kmh);
    const std::string figure = c.figure;
    if (figure == "16" || figure == "17") {
      panels.push_back(
          {fmt::format("Fig. {}a: lateral shift, {}", figure, at), "time [s]", "y [mm]", {h.y}, {thinned(h.y_eq)}});
      panels.push_back(
          {fmt::format("Fig. {}b: yaw, {}", figure, at), "time [s]", "yaw [mrad]", {h.yaw}, {thinned(h.yaw_eq)}});
    } else if (figure != "18a") {
      panels.push_back(
          {fmt::format("Fig. {}: lateral shift, {}", figure, at), "time [s]", "y [mm]", {h.y}, {thinned(h.y_eq)}});
    }
    if (sprung) {
      report::Series line = h.y;
      line.label = fmt::format("{:.0f} km/h", c.kmh);
      const double unit = *std::max_element(line.y.begin(), line.y.begin() + 20);  // the impulse shifts it by V
      for (double& y : line.y) y /= unit;
      three.lines.push_back(std::move(line));
    }
  }
  std::swap(three.lines[1], three.lines[2]);
  three.y_label = "y / first shift [-]";
  panels.push_back(three);
  write_text_file(folder + "/hunting_waves.csv", waves);
  write_text_file(folder + "/hunting_histories.csv", csv);
  write_text_file(folder + "/hunting_histories.svg",
                  report::svg_figure("Suspended wheelset after an impulse of 10 N s: railtab and Eq. 18", panels, 2));
}

}  // namespace
}  // namespace railtab::hunting

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: hunting_history_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    railtab::hunting::write(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "hunting_history_figure: %s\n", e.what());
    return 1;
  }
}
